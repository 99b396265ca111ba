// SPDX-License-Identifier: MIT
// Based on: Akenine-Möller, Haines, Hoffman et al. Real-Time Rendering, Fourth Edition. 2018. [AHH18] section 7.4.1
#include "shadow/casters/simpler.h"

#include "gpu/upload.h"
#include "shadow/casters/caster_draw.h"
#include "shadow/casters/caster_pipeline.h"
#include "shadow/geometry/edges.h"
#include "shadow/scene/casting.h"
#include "shadow/scene/simplifier.h"

#include <algorithm>

namespace gn {
namespace {

constexpr std::uint32_t least_simplified = 32;  ///< triangles
/// The error that collapses tell is a mean over what an edge stood for: the farthest place may lie twice as far.
constexpr float told_of_error = 0.5F;
constexpr std::size_t least_indices = 12;

/// An object by itself, its vertices welded.
OwnMesh object_mesh(const Scene& scene, const Object& object, std::span<const std::uint32_t> welded) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t) {
        const uvec3 corners = scene.triangles[t];
        const uvec3 joined(welded[corners.x], welded[corners.y], welded[corners.z]);
        if (joined.x != joined.y && joined.y != joined.z && joined.z != joined.x) {
            indices.insert(indices.end(), {joined.x, joined.y, joined.z});
        }
    }
    return own_mesh(scene.positions_ws, std::move(indices));
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

SimplerCasters make_simpler(Device& device, const Scene& scene, std::span<const float> errors) {
    SimplerCasters made;
    made.errors.assign(errors.begin(), errors.end());
    made.ranges.assign(errors.size(), std::vector<DrawRange>(scene.objects.size()));
    const std::vector<std::uint32_t> welded = weld(scene.positions_ws);
    std::vector<std::uint32_t> indices;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        if (object.triangle_count < least_simplified || caster_class(scene, i, nullptr) != CasterClass::opaque) {
            continue;
        }
        const OwnMesh mesh = object_mesh(scene, object, welded);
        for (std::size_t level = 0; level < errors.size(); ++level) {
            const std::vector<std::uint32_t> left =
                simplified(mesh, object.bounds_ws, object.triangle_count, errors[level]);
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
    return input.derive("simpler casters", key.finish().low,
                        [&] { return make_simpler(input.device, input.scene, levels); });
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
