// SPDX-License-Identifier: MIT
// Whether a baked folder holds what a recipe's frames will bind: known when the recipe is chosen, and not in its first frame.
#include "shadow/embed/rehearsed_lights.h"
#include "shadow/embed/twins.h"

namespace gn::embed {
namespace {

constexpr uint side = 64;  ///< pixels; the picture's size decides no shader

/// A frame of images and buffers that are missing, with its lights and casters.
class StandIn {
  public:
    StandIn(const ReceiverForm& form, std::size_t situation, bool drawn) {
        for (const GnLight& shape : rehearsed_lights(situation)) {
            lights_.push_back({lights_.size(), shape, {.format = VK_FORMAT_R8_UNORM}});
        }
        frame_ = {.receivers = {.width = side,
                                .height = side,
                                .depth = {.format = VK_FORMAT_D32_SFLOAT},
                                .normals = {.format = VK_FORMAT_R16G16B16A16_SFLOAT},
                                .cs_from_ws = rehearsed_camera(false, form.reversed_depth)},
                  .casters = {.positions = {.bytes = 8 * 12},
                              .indices = {.bytes = 12 * 4},
                              .transforms = {.bytes = 2 * sizeof(mat4)},
                              .objects = objects_,
                              .bounds_ws = rehearsed_bounds_ws,
                              .topology = 1,
                              .poses = 1,
                              .draw = drawn ? [](const CasterView&) {} : CasterFunction()},
                  .lights = lights_};
    }
    StandIn(const StandIn&) = delete;
    StandIn& operator=(const StandIn&) = delete;

    /// The frame, with casters where they were or elsewhere.
    const Frame& at(std::uint64_t poses) {
        frame_.casters.poses = poses;
        return frame_;
    }

  private:
    std::array<CasterObject, 2> objects_{CasterObject{0, 6, 0, 4, true}, {6, 6, 4, 4, false}};
    std::vector<LentLight> lights_;
    Frame frame_;
};

}  // namespace

void Shadows::State::demand_shaders(const PreparedRecipe& with) const {
    const auto demand = [&](const ShaderSource& source) { baked->demand(baked_key(source), source.name); };
    try {
        for (std::size_t i = 0; i < 2 * rehearsed_situations; ++i) {
            StandIn stand_in(info.receivers, i / 2, i % 2 == 1);
            Twins twins(*device, casters);
            // A first frame, a still and a moving one; what they keep tells them apart, and not where a light is.
            const std::uint64_t most = i < 2 ? 3 : 1;
            for (std::uint64_t frame = 1; frame <= most; ++frame) {
                FrameGraph graph(*device);
                const Frame& asked = stand_in.at((frame + 1) / 2);
                static_cast<void>(declare(graph, twins.lend(asked), asked, with));
                graph.find_shaders(demand);
                twins.advance();
            }
        }
    } catch (const MissingShader& missing) {
        fail("{}", missing_from(with, missing));
    }
}

}  // namespace gn::embed
