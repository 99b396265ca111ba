// SPDX-License-Identifier: MIT
// Based on: Akenine-Möller, Haines, Hoffman et al. Real-Time Rendering, Fourth Edition. 2018. [AHH18] section 7.4.1
#include "shadow/casters/simpler.h"

#include "gpu/upload.h"
#include "shadow/casters/caster_draw.h"
#include "shadow/casters/caster_pipeline.h"
#include "shadow/frame/history.h"
#include "shadow/geometry/edges.h"
#include "shadow/scene/casting.h"
#include "shadow/scene/simplifier.h"

#include <algorithm>
#include <unordered_map>

namespace gn {
namespace {

constexpr std::uint32_t least_simplified = 32;  ///< triangles
/// The error that collapses tell is a mean over what an edge stood for: the farthest place may lie twice as far.
constexpr float told_of_error = 0.5F;
constexpr std::size_t least_indices = 12;
/// What of the least error vertices may be off the motion of their object, which rounding takes them off by.
constexpr float rounded_of_error = 1.0F / 64;
constexpr double most_stretched = 1e-3;  ///< squares of lengths

/// An object by itself, its vertices welded: of those in one place its own first one stands for all.
OwnMesh object_mesh(const Scene& scene, const Object& object, std::span<const std::uint32_t> welded) {
    std::unordered_map<std::uint32_t, std::uint32_t> own;
    const auto joined = [&](std::uint32_t vertex) { return own.try_emplace(welded[vertex], vertex).first->second; };
    std::vector<std::uint32_t> indices;
    for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t) {
        const uvec3 corners = scene.triangles[t];
        const uvec3 of_own(joined(corners.x), joined(corners.y), joined(corners.z));
        if (of_own.x != of_own.y && of_own.y != of_own.z && of_own.z != of_own.x) {
            indices.insert(indices.end(), {of_own.x, of_own.y, of_own.z});
        }
    }
    return own_mesh(scene.positions_ws, std::move(indices));
}

bool is_simplified(const Scene& scene, std::size_t object) {
    return scene.objects[object].triangle_count >= least_simplified &&
           caster_class(scene, object, nullptr) == CasterClass::opaque;
}

/// Whether all vertices are where one motion without stretching takes them, within metres.
bool moved_rigidly(const Scene& scene, const Object& object, const SimplerSource& was, double within) {
    const dmat4 now_from_was = object.now_from_first * glm::inverse(was.now_from_first);
    const glm::dmat3 turn(now_from_was);
    const glm::dmat3 stretch = glm::transpose(turn) * turn - glm::dmat3(1);
    for (int column = 0; column < 3; ++column) {
        if (glm::any(glm::greaterThan(glm::abs(stretch[column]), dvec3(most_stretched)))) {
            return false;
        }
    }
    for (std::size_t i = 0; i < was.mesh.vertices.size(); ++i) {
        const dvec3 there(now_from_was * dvec4(dvec3(was.mesh.positions_ws[i]), 1));
        if (glm::distance(there, dvec3(scene.positions_ws[was.mesh.vertices[i]])) > within) {
            return false;
        }
    }
    return true;
}

/// Whether an object's meshes serve on: triangles are of the vertices that moved with it.
bool serves_on(const SimplerCasters& before, const Scene& scene, std::size_t index) {
    const SimplerSource& was = before.sources[index];
    const Object& object = scene.objects[index];
    return was.asked == is_simplified(scene, index) &&
           (!was.asked || was.version == object.version ||
            moved_rigidly(scene, object, was, static_cast<double>(rounded_of_error * before.errors.front())));
}

/// Its simpler mesh, of the scene's vertices; empty where hardly anything would be saved.
std::vector<std::uint32_t> simplified(const OwnMesh& mesh, const Box& bounds_ws, std::uint32_t triangles, float error) {
    const vec3 extent = bounds_ws.extent();
    const float size = std::max({extent.x, extent.y, extent.z});
    if (mesh.indices.empty() || !(size > 0)) {
        return {};
    }
    const float share = std::min(told_of_error * error / size, 1.0F);
    std::vector<std::uint32_t> left = simplifier()(mesh.positions_ws, mesh.indices, least_indices, share).indices;
    if (left.empty() || left.size() / 3 > triangles - triangles / 8) {
        return {};
    }
    for (std::uint32_t& index : left) {
        index = mesh.vertices[index];
    }
    return left;
}

/// `before`: whose objects' meshes serve on where they can; null: none do.
SimplerCasters make_simpler(Device& device, const Scene& scene, std::span<const float> errors,
                            const SimplerCasters* before) {
    SimplerCasters made;
    made.errors.assign(errors.begin(), errors.end());
    made.ranges.assign(errors.size(), std::vector<DrawRange>(scene.objects.size()));
    made.sources.resize(scene.objects.size());
    const std::vector<std::uint32_t> welded = weld(scene.positions_ws);
    std::vector<std::uint32_t>& indices = made.list;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        if (!is_simplified(scene, i)) {
            continue;
        }
        const bool kept = before != nullptr && serves_on(*before, scene, i);
        SimplerSource& source = made.sources[i];
        source = kept ? before->sources[i]
                      : SimplerSource{true, object_mesh(scene, object, welded), object.version, object.now_from_first};
        for (std::size_t level = 0; level < errors.size(); ++level) {
            std::vector<std::uint32_t> left;
            if (kept) {
                const DrawRange& range = before->ranges[level][i];
                const auto first = before->list.begin() + range.first_index;
                left.assign(first, first + range.index_count);
            } else {
                left = simplified(source.mesh, object.bounds_ws, object.triangle_count, errors[level]);
            }
            made.ranges[level][i] = {static_cast<std::uint32_t>(indices.size()),
                                     static_cast<std::uint32_t>(left.size())};
            indices.insert(indices.end(), left.begin(), left.end());
        }
        const std::uint32_t last = made.ranges.back()[i].index_count;
        made.objects += last > 0 ? 1 : 0;
        made.triangles_before += last > 0 ? object.triangle_count : 0;
        made.triangles_after += last / 3;
    }
    indices.resize(std::max<std::size_t>(indices.size(), 3), 0);
    made.indices = upload(device, "simpler casters", indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    return made;
}

using Shared = std::shared_ptr<const SimplerCasters>;

/// Those of an older version of the same geometry where all of them serve on, else new ones.
Shared simpler_since(const FrameInput& input, std::span<const float> errors, const Shared& older) {
    const bool comparable = older != nullptr && input.handles.derived != nullptr &&
                            older->geometry.lock() == input.handles.derived &&
                            std::equal(errors.begin(), errors.end(), older->errors.begin(), older->errors.end()) &&
                            older->sources.size() == input.scene.objects.size();
    bool all = comparable;
    for (std::size_t i = 0; all && i < input.scene.objects.size(); ++i) {
        all = serves_on(*older, input.scene, i);
    }
    if (all) {
        return older;
    }
    SimplerCasters made = make_simpler(input.device, input.scene, errors, comparable ? older.get() : nullptr);
    made.geometry = input.handles.derived;
    return std::make_shared<const SimplerCasters>(std::move(made));
}

}  // namespace

const DrawRange* SimplerCasters::find(float error, std::uint32_t object) const {
    const auto level = std::find(errors.begin(), errors.end(), error);
    if (level == errors.end()) {
        return nullptr;
    }
    const DrawRange& range = ranges[static_cast<std::size_t>(level - errors.begin())][object];
    return range.index_count > 0 ? &range : nullptr;
}

std::shared_ptr<const SimplerCasters> simpler_casters(const FrameInput& input, std::span<const float> errors) {
    std::vector<float> levels;
    std::copy_if(errors.begin(), errors.end(), std::back_inserter(levels), [](float error) { return error > 0; });
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    if (levels.empty() || simplifier() == nullptr) {
        return nullptr;
    }
    Hasher key;
    for (const float error : levels) {
        key.value(error);
    }
    // What a history's last frame drew.
    const std::string name = fmt::format("simpler casters of light {}", input.light_id);
    const bool follows = input.history != nullptr && input.parent == nullptr;
    const Shared* const older = follows ? input.history->before<Shared>(name) : nullptr;
    Shared simpler = *input.derive("simpler casters", key.finish().low,
                                   [&] { return simpler_since(input, levels, older != nullptr ? *older : nullptr); });
    if (follows) {
        input.history->leave(name, simpler);
    }
    return simpler;
}

GnLightView set_back(GnLightView view, float metres) {
    const float depth = metres / view.metres_per_depth;
    view.cs_from_ws[3].z += depth;
    view.depth_from_ws.w += depth;
    view.ws_from_cs = glm::inverse(view.cs_from_ws);
    return view;
}

std::vector<std::uint32_t> CasterDraw::draw_simpler(Recorder& r, std::vector<std::uint32_t> objects) const {
    if (job->simpler == nullptr) {
        return objects;
    }
    const float error = job->views.simpler[view];
    std::vector<std::uint32_t> others;
    for (const std::uint32_t index : objects) {
        const DrawRange* const range = job->simpler->find(error, index);
        if (range == nullptr) {
            others.push_back(index);
            continue;
        }
        const bool fronts = job->kept == Casters::front || is_single_sided(*job->scene, job->scene->objects[index]);
        begin(r,
              {.culled = static_cast<VkCullModeFlags>(job->kept == Casters::back ? VK_CULL_MODE_FRONT_BIT
                                                      : fronts                   ? VK_CULL_MODE_BACK_BIT
                                                                                 : VK_CULL_MODE_NONE)},
              false);
        r.index_buffer(job->simpler_indices);
        // The view that stands behind all others sees them farther away by as much as they may lie nearer to the light.
        r.push_value(
            CasterPush{static_cast<int>(view + job->views.views.size() / 2), 1.0F, 0.0F, static_cast<int>(index), 0});
        r.draw_indexed(range->index_count, 1, range->first_index);
    }
    return others;
}

}  // namespace gn
