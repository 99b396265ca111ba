// SPDX-License-Identifier: MIT
// The shadows: the one file that knows Gnomon. It lends images, buffers and lights, and gets V of both lights.
#pragma once

#include "camera.h"
#include "caster_pass.h"
#include "scene_pass.h"
#include "targets.h"

#include "shadow/embed/embed.h"

#include <array>
#include <optional>
#include <stdexcept>

/// Gnomon refused the device or the recipe; what() is its sentence.
struct Refused : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class ShadowPass {
  public:
    /// `baked`: a folder of compiled shaders, or "". Throws Refused.
    ShadowPass(const HostDevice& host, const World& world, const std::string& recipe, const std::string& baked,
               VkExtent2D largest, bool draw_casters);

    /// Depth and normals are as the scene's pass left them; they and V are left in SHADER_READ_ONLY_OPTIMAL. `number` counts
    /// the frames: in every third the lights come in the other order, which must make no difference. Throws
    /// std::runtime_error.
    void record(VkCommandBuffer commands, std::uint32_t slot, std::uint64_t number, const Targets& targets,
                const ScenePass& scene, const HostBuffer& transforms, const glm::mat4& cs_from_ws);

    /// Before the images that it was lent go.
    void forget_images() { shadows_.forget_images(); }

    [[nodiscard]] const gn::embed::Shadows& gnomon() const { return shadows_; }

  private:
    using Lights = std::array<gn::embed::LentLight, light_count>;
    /// All but the images and the buffers.
    [[nodiscard]] gn::embed::Frame outline(VkExtent2D size, const glm::mat4& cs_from_ws, const Lights& lights) const;
    /// Asks what frames will want before the first of them. Throws Refused.
    void foresee(VkExtent2D size) const;

    const World& world_;
    gn::embed::Shadows shadows_;
    std::optional<CasterPass> casters_;  ///< where they are drawn
    std::vector<gn::embed::CasterObject> objects_;
};
