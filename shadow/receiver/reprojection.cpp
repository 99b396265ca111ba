// SPDX-License-Identifier: MIT
#include "shadow/receiver/reprojection.h"

#include "shadow/frame/history.h"

namespace gn {
namespace {

/// What a frame leaves to the next one.
struct FrameBefore {
    mat4 cs_from_ws{1};
    std::uint64_t version = 0;                          ///< of the geometry
    std::shared_ptr<const std::vector<dmat4>> objects;  ///< ws, from where each object's points were at first
};
constexpr const char* kept_as = "frame before";

/// Copies an image that belongs to a renderer: it draws the next frame's over it.
void add_copy(FrameGraph& graph, TextureHandle from, TextureHandle to) {
    graph.add_pass(
        "keep samples",
        [&](PassBuilder& pass) {
            pass.copy_from(from);
            pass.copy_to(to);
        },
        [from, to](Recorder& r) {
            r.blit(from, {0, 1, 0, 1}, to, {0, 1, 0, 1}, VK_FILTER_NEAREST);
        });
}

/// Lets an image of this frame's samples live on until the next has completed. What the frame before kept; invalid where
/// none did.
TextureHandle kept_image(const FrameInput& input, const char* kept_name, TextureHandle image) {
    FrameGraph& graph = input.graph;
    TextureHandle before;
    const auto pair_of = [&](const TextureDesc& like) -> Texture2D& {
        TextureDesc desc = like;
        desc.name = kept_name;
        const History::Pair pair = input.history->pair(desc);
        before = pair.before != nullptr ? graph.import(*pair.before) : TextureHandle{};
        return *pair.now;
    };
    if (!graph.imported(image)) {
        graph.place(image, pair_of);
    } else if (graph.desc(image).name == kept_name) {
        static_cast<void>(pair_of(graph.desc(image)));  // another light of the frame has asked
    } else {
        TextureDesc desc = graph.desc(image);
        desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        add_copy(graph, image, graph.import(pair_of(desc)));
    }
    return before;
}

std::shared_ptr<const std::vector<dmat4>> objects_of(const Scene& scene) {
    std::vector<dmat4> objects;
    for (std::size_t i = 0; !scene.positions_ws.empty() && i < scene.objects.size(); ++i) {
        objects.push_back(scene.objects[i].now_from_first);
    }
    return std::make_shared<const std::vector<dmat4>>(std::move(objects));
}

}  // namespace

std::optional<Reprojection> reprojection(const FrameInput& input) {
    const auto* before = input.history != nullptr ? input.history->before<FrameBefore>(kept_as) : nullptr;
    if (before == nullptr) {
        return {};
    }
    Reprojection found{.before_cs_from_ws = input.samples.before_cs_from_ws.value_or(before->cs_from_ws)};
    const std::vector<dmat4>& objects = *before->objects;
    const bool known = !input.scene.positions_ws.empty() && objects.size() == input.scene.objects.size();
    for (std::size_t i = 0; known && i < objects.size(); ++i) {
        const dmat4& now = input.scene.objects[i].now_from_first;
        found.before_from_now.push_back(now == objects[i] ? mat4(1) : mat4(objects[i] * glm::inverse(now)));
    }
    return found;
}

std::optional<SamplesBefore> samples_before(const FrameInput& input) {
    if (input.history == nullptr) {
        return {};
    }
    const SamplesBefore before{kept_image(input, "positions before", input.samples.position),
                               kept_image(input, "normals before", input.samples.normal)};
    return before.position.valid() && before.normal.valid() ? std::optional(before) : std::nullopt;
}

void leave_frame(History& history, const ViewSamples& samples, const Scene& scene, const SceneHandles& handles) {
    const auto* before = history.before<FrameBefore>(kept_as);
    const bool still = before != nullptr && before->version == handles.version;
    history.leave(kept_as, FrameBefore{samples.constants.cs_from_ws, handles.version,
                                       still ? before->objects : objects_of(scene)});
}

}  // namespace gn
