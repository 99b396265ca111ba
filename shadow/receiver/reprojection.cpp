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
constexpr const char* name = "frame before";

std::shared_ptr<const std::vector<dmat4>> objects_of(const Scene& scene) {
    std::vector<dmat4> objects;
    for (std::size_t i = 0; !scene.positions_ws.empty() && i < scene.objects.size(); ++i) {
        objects.push_back(scene.objects[i].now_from_first);
    }
    return std::make_shared<const std::vector<dmat4>>(std::move(objects));
}

}  // namespace

std::optional<Reprojection> reprojection(const FrameInput& input) {
    const auto* before = input.history != nullptr ? input.history->before<FrameBefore>(name) : nullptr;
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

void leave_frame(History& history, const ViewSamples& samples, const Scene& scene, const SceneHandles& handles) {
    const auto* before = history.before<FrameBefore>(name);
    const bool still = before != nullptr && before->version == handles.version;
    history.leave(
        name, FrameBefore{samples.constants.cs_from_ws, handles.version, still ? before->objects : objects_of(scene)});
}

}  // namespace gn
