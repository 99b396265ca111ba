// SPDX-License-Identifier: MIT
#include "shadow/embed/rehearsal.h"

#include "gpu/baked_shaders.h"
#include "gpu/memory.h"
#include "shadow/embed/embed.h"
#include "shadow/embed/rehearsed_lights.h"

#include <algorithm>
#include <array>

namespace gn::embed {
namespace {

constexpr uint side = 64;  ///< pixels; the picture's size decides no shader

/// How the stage's two objects are lent.
struct StageCasters {
    bool first_single = true, second_single = false;
    bool drawn = false;  ///< by the renderer itself
};

/// A wall of 2 x 2 metres that stands on a floor of 8 x 8, as a renderer lends them.
class LentStage {
  public:
    explicit LentStage(Device& device)
        : depth_(device, {.name = "depth",
                          .format = VK_FORMAT_D32_SFLOAT,
                          .width = side,
                          .height = side,
                          .usage = VK_IMAGE_USAGE_SAMPLED_BIT}),
          normals_(device, {.name = "normals",
                            .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                            .width = side,
                            .height = side,
                            .usage = VK_IMAGE_USAGE_SAMPLED_BIT}),
          // Nothing reads them: what counts is that they are there.
          buffer_(device, {.name = "casters", .bytes = 1024, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}) {
        // One for each light: what is drawn over by another is not drawn.
        for (std::size_t i = 0; i < light_kind_names.size(); ++i) {
            visibility_.emplace_back(device, TextureDesc{.name = "V",
                                                         .format = VK_FORMAT_R8_UNORM,
                                                         .width = side,
                                                         .height = side,
                                                         .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
        }
    }

    /// The first of two objects is one-sided as `casters` says, the second too, or the renderer draws both itself.
    [[nodiscard]] Frame frame(const mat4& cs_from_ws, std::span<const GnLight> lights, const StageCasters& casters) {
        objects_ = {CasterObject{0, 6, 0, 4, casters.first_single}, {6, 6, 4, 4, casters.second_single}};
        lights_.clear();
        for (const GnLight& light : lights) {
            lights_.push_back({lights_.size(), light, lend(visibility_.at(lights_.size()))});
        }
        const LentBuffer all{buffer_.vk(), 0, buffer_.desc().bytes};
        return {.receivers = {.width = side,
                              .height = side,
                              .depth = lend(depth_),
                              .normals = lend(normals_),
                              .cs_from_ws = cs_from_ws},
                .casters = {.positions = all,
                            .indices = all,
                            .transforms = all,
                            .objects = objects_,
                            .bounds_ws = rehearsed_bounds_ws,
                            .draw = casters.drawn ? [](const CasterView&) {} : CasterFunction()},
                .lights = lights_};
    }

  private:
    static LentImage lend(const Texture2D& texture) { return {.image = texture.vk(), .format = texture.desc().format}; }

    Texture2D depth_, normals_;
    std::vector<Texture2D> visibility_;
    Buffer buffer_;
    std::array<CasterObject, 2> objects_;
    std::vector<LentLight> lights_;
};

/// One description of a device, with all frames that are rehearsed on it.
class Run {
  public:
    Run(Device& device, LentStage& stage, const std::string& recipe, const std::set<DeviceTrait>& has,
        Rehearsal& rehearsal)
        : device_(device), stage_(stage), recipe_(recipe), rehearsal_(rehearsal), description_{has, {}} {}

    /// All lights under both cameras, with every kind of casters, and every form of receivers.
    void all() {
        Shadows shadows = create({});
        for (std::size_t situation = 0; situation < rehearsed_situations; ++situation) {
            frames(shadows, rehearsed_camera(false, true), situation, {});
            frames(shadows, rehearsed_camera(true, true), situation, {});
            frames(shadows, rehearsed_camera(false, true), situation, {.drawn = true});
        }
        frames(shadows, rehearsed_camera(false, true), 0, {.first_single = false});
        frames(shadows, rehearsed_camera(false, true), 0, {.second_single = true});
        for (const Normals normals : {Normals::none, Normals::signed_xyz, Normals::unsigned_xyz,
                                      Normals::signed_octahedral, Normals::unsigned_octahedral}) {
            for (const bool reversed : {false, true}) {
                Shadows formed = create({.reversed_depth = reversed, .normals = normals});
                for (const bool orthographic : {false, true}) {
                    frames(formed, rehearsed_camera(orthographic, reversed), 0, {});
                }
            }
        }
        rehearsal_.asked.insert(description_.asked.begin(), description_.asked.end());
    }

    /// Kinds of lights that had a shadow, and why others had none.
    [[nodiscard]] const std::set<uint>& served() const { return served_; }
    [[nodiscard]] const std::map<uint, std::string>& refused() const { return refused_; }

  private:
    Shadows create(const ReceiverForm& form) {
        Result<Shadows> made =
            Shadows::create({.recipe = recipe_, .limits = {.width = side, .height = side}, .receivers = form},
                            make_described_device(device_, description_));
        if (!made.ok()) {
            throw Error(made.why());
        }
        return std::move(made.value());
    }

    /// A first frame, one in which nothing moves, one in which casters do, and one after a cut.
    void frames(Shadows& shadows, const mat4& cs_from_ws, std::size_t situation, const StageCasters& casters) {
        const auto lights = rehearsed_lights(situation);
        Frame frame = stage_.frame(cs_from_ws, lights, casters);
        frame.casters.topology = ++topology_;
        frame.cut = true;
        for (const std::uint64_t poses : {1, 1, 2}) {
            frame.casters.poses = 3 * topology_ + poses;
            const auto rehearsed = shadows.rehearse(
                frame, [&](const ShaderSource& source) { rehearsal_.shaders.emplace(baked_key(source), source); });
            if (!rehearsed.ok()) {
                throw Error(rehearsed.why());
            }
            // What draws of a renderer's own do not serve, its buffers do.
            for (uint kind = 0; kind < rehearsed_kinds && !casters.drawn; ++kind) {
                const std::string& why = rehearsed.value()[kind];
                if (why.empty()) {
                    served_.insert(kind);
                } else if (kind != GN_LIGHT_ENVIRONMENT) {
                    refused_[kind] = why;  // of a sky nobody expects a shadow
                }
            }
            frame.cut = false;
        }
    }

    Device& device_;
    LentStage& stage_;
    const std::string& recipe_;
    Rehearsal& rehearsal_;
    DeviceDescription description_;
    std::set<uint> served_;
    std::map<uint, std::string> refused_;
    std::uint64_t topology_ = 0;
};

/// All sets of some traits.
std::vector<std::set<DeviceTrait>> subsets(const std::set<DeviceTrait>& traits) {
    std::vector<std::set<DeviceTrait>> all{{}};
    for (const DeviceTrait& trait : traits) {
        const std::size_t before = all.size();
        for (std::size_t i = 0; i < before; ++i) {
            std::set<DeviceTrait> with = all[i];
            with.insert(trait);
            all.push_back(std::move(with));
        }
    }
    return all;
}

}  // namespace

Rehearsal rehearse(Device& device, const std::string& recipe) {
    Rehearsal rehearsal;
    LentStage stage(device);
    std::set<std::set<DeviceTrait>> done;
    std::set<uint> served;
    std::map<uint, std::string> refused;
    // Answers may lead to further questions: go on until every set of answers to all of them was given.
    for (std::size_t known = ~std::size_t{0}; known != rehearsal.asked.size();) {
        known = rehearsal.asked.size();
        for (const std::set<DeviceTrait>& has : subsets(rehearsal.asked)) {
            if (!done.insert(has).second) {
                continue;
            }
            Run run(device, stage, recipe, has, rehearsal);
            run.all();
            served.insert(run.served().begin(), run.served().end());
            refused.insert(run.refused().begin(), run.refused().end());
        }
    }
    for (const auto& [kind, why] : refused) {
        if (!served.contains(kind)) {
            rehearsal.refused.push_back(why);
        }
    }
    if (served.empty()) {
        fail("recipe '{}' serves no light that a renderer can lend: {}", recipe, fmt::join(rehearsal.refused, "; "));
    }
    return rehearsal;
}

}  // namespace gn::embed
