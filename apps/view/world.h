// SPDX-License-Identifier: MIT
// The scene that is looked at: as it was loaded, as its lights stand now, and on the device.
#pragma once

#include "apps/view/setup.h"
#include "shadow/frame/refresh.h"
#include "shadow/scene/rig.h"

#include <array>

namespace gn {

struct World {
    /// Loads and uploads. Throws Error.
    World(Device& device, const std::string& name, const FileOptions& file, const Size& window);
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    std::string name;  ///< as asked for
    FileOptions file;  ///< its animation and time: where all stands now
    AnimatedScene loaded;
    Scene& scene = loaded.scene;   ///< its lights may be moved; all else moves by pose alone
    std::vector<Light> as_loaded;  ///< its lights, as nothing but the animation moved them
    SceneGpu gpu;
    std::uint64_t lights_version = 1;  ///< another one whenever a light was changed

    /// "NAME,key=value,...". Throws Error.
    void move_light(const std::string& words);
    /// Moves all to a time of an animation, "" to where it is at rest; lights that a hand moved keep what it did. bring() takes
    /// it to the device. What must be said of it, one sentence each. Throws Error.
    std::vector<std::string> pose(const std::string& animation, double seconds);
    /// Records, before a frame in flight (0 or 1, whose last commands have completed), what moved since it was brought before.
    void bring(VkCommandBuffer commands, std::uint32_t slot);
    /// Such words of all lights that stand otherwise than as loaded.
    [[nodiscard]] std::vector<std::string> moved_lights() const;
    /// Metres from one end of the scene to the other.
    [[nodiscard]] float size() const;

  private:
    std::array<UploadArena, 2> staging_;  ///< of the frames in flight
};

}  // namespace gn
