// SPDX-License-Identifier: MIT
// What a frame would ask for: it is declared as record declares it, and only its plan is made.
#include "shadow/embed/twins.h"

namespace gn::embed {

Foreseen Shadows::State::foresee(const Frame& frame) const {
    check(frame);
    Twins twins(*device, casters);
    FrameGraph graph(*device);
    Foreseen foreseen = declare(graph, twins.lend(frame), frame, present());

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
