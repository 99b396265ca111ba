// SPDX-License-Identifier: MIT
// The scene that is looked at: as it was loaded, as its lights stand now, and on the device.
#pragma once

#include "apps/view/setup.h"
#include "shadow/stages.h"

namespace gn {

struct World {
    /// Loads and uploads. Throws Error.
    World(Device& device, const std::string& name, const FileOptions& file, const Size& window);
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    std::string name;  ///< as asked for
    FileOptions file;
    Scene scene;                   ///< its lights may be moved; all else stays
    std::vector<Light> as_loaded;  ///< its lights
    SceneGpu gpu;
    std::uint64_t lights_version = 1;  ///< another one whenever a light was changed

    /// "NAME,key=value,...". Throws Error.
    void move_light(const std::string& words);
    /// Such words of all lights that stand otherwise than as loaded.
    [[nodiscard]] std::vector<std::string> moved_lights() const;
    /// Metres from one end of the scene to the other.
    [[nodiscard]] float size() const;
};

}  // namespace gn
