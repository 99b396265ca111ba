// SPDX-License-Identifier: MIT
// What a frame would ask for: it is declared as record declares it, and only its plan is made.
#include "shadow/embed/state.h"

namespace gn::embed {

Foreseen Shadows::State::foresee(const Frame& frame) const {
    check(frame);
    Frames none(*device, 1);
    LentImages missing(*device, none, true);
    LentCasters mesh = casters.twin();
    History first(*device);
    std::set<std::string> remarks;
    missing.begin(frame.receivers.width, frame.receivers.height);
    FrameGraph graph(*device);
    Foreseen foreseen = declare(graph, {none, missing, mesh, first, remarks}, frame);

    static_cast<void>(graph.plan());
    const GraphStatistics& planned = graph.statistics();
    foreseen.passes = planned.passes;
    foreseen.transient_bytes = planned.transient_bytes;
    for (const ResourceBytes& resource : planned.resources) {
        if (!resource.transient && !resource.name.starts_with(lent_mark)) {
            foreseen.persistent_bytes += resource.bytes;
        }
    }
    return foreseen;
}

Result<Foreseen> Shadows::foresee(const Frame& frame) const noexcept {
    return guarded<Foreseen>([&] { return state_->foresee(frame); });
}

}  // namespace gn::embed
