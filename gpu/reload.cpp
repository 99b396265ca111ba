// SPDX-License-Identifier: MIT
#include "gpu/reload.h"

#include "gpu/pipeline_cache.h"

namespace gn {

Reloaded reload_shaders(Device& device) {
    if (!device.shaders().has_sources()) {
        fail("there is nothing to reload: the shaders were baked, and no source of them is read");
    }
    const std::vector<Fingerprint> changed = device.shaders().reload();
    if (changed.empty()) {
        return {};
    }
    try {
        return {changed.size(), device.pipelines().remake({changed.begin(), changed.end()})};
    } catch (...) {
        device.shaders().undo_reload();
        throw;
    }
}

}  // namespace gn
