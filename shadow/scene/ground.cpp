// SPDX-License-Identifier: MIT
#include "shadow/scene/ground.h"

#include "base/error.h"
#include "shadow/scene/model.h"

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

/// Of the scene's size: how far above the lowest point a floor may lie, and how far below it the ground does. The latter is
/// more than a depth buffer confuses at the distance that shows the whole, and less than a texel of the whole in a map.
constexpr float floor_share = 0.01F, gap_share = 1.0F / 4096;
/// Half a side of the ground, in sizes and heights of the scene: half a size reaches past the model from its middle, and a
/// sun 20 degrees high throws a shadow 2.75 times as long as a thing is high.
constexpr float sides_of_size = 0.75F, sides_of_height = 2.75F;

/// The main mass from its lowest point on.
Box standing_box(const Scene& scene) {
    Box main = main_bounds(scene), box;
    for (const uvec3 t : scene.triangles) {
        Box triangle;
        for (int corner = 0; corner < 3; ++corner) {
            triangle.grow(scene.positions_ws[t[corner]]);
        }
        if (glm::all(glm::greaterThanEqual(triangle.min, main.min)) &&
            glm::all(glm::lessThanEqual(triangle.max, main.max))) {
            box.grow(triangle);
        }
    }
    return box.empty() ? main : box;
}

/// Twice the area of the footprint that the triangle covers where it looks up, by its winding or its shading normals. Of a
/// triangle that reaches beyond the footprint, what its own rectangle shares with it is the most that counts.
double upward_area(const Scene& scene, uvec3 t, const Box& box) {
    const dvec3 a(scene.positions_ws[t.x]);
    const double up = glm::cross(dvec3(scene.positions_ws[t.y]) - a, dvec3(scene.positions_ws[t.z]) - a).y;
    const float shading = scene.normals_ws[t.x].y + scene.normals_ws[t.y].y + scene.normals_ws[t.z].y;
    if (!(up > 0 || shading > 0)) {
        return 0;
    }
    Box triangle;
    for (int corner = 0; corner < 3; ++corner) {
        triangle.grow(scene.positions_ws[t[corner]]);
    }
    const vec3 shared = glm::max(glm::min(triangle.max, box.max) - glm::max(triangle.min, box.min), vec3(0.0F));
    return std::min(std::abs(up), 2.0 * static_cast<double>(shared.x) * static_cast<double>(shared.z));
}

void append_plane(Scene& scene, vec3 centre_ws, float half_side) {
    const auto first = static_cast<std::uint32_t>(scene.positions_ws.size());
    Object object{.name = "ground",
                  .first_triangle = static_cast<std::uint32_t>(scene.triangles.size()),
                  .triangle_count = 2,
                  .material = static_cast<int>(scene.materials.size())};
    scene.materials.push_back({.name = "ground", .base_color = vec4(0.5F, 0.5F, 0.5F, 1.0F), .roughness = 0.9F});
    for (const vec2 corner : {vec2(-1, -1), vec2(-1, 1), vec2(1, 1), vec2(1, -1)}) {
        scene.positions_ws.push_back(centre_ws + half_side * vec3(corner.x, 0.0F, corner.y));
        scene.normals_ws.emplace_back(0, 1, 0);
        scene.uvs.emplace_back(0.0F);
        if (!scene.colors.empty()) {
            scene.colors.emplace_back(1.0F);
        }
        object.bounds_ws.grow(scene.positions_ws.back());
    }
    scene.triangles.emplace_back(first, first + 1, first + 2);
    scene.triangles.emplace_back(first, first + 2, first + 3);
    scene.bounds_ws.grow(object.bounds_ws);
    scene.objects.push_back(std::move(object));
}

/// Whatever of the ground lies before the camera lies between its planes.
void see_ground(Camera& camera, const Box& ground) {
    for (const vec3 corner : ground.corners()) {
        camera.far = std::max(camera.far, 1.05F * glm::distance(corner, camera.position_ws));
    }
    const float above = camera.position_ws.y - ground.max.y;
    camera.near = above > 0 ? std::min(camera.near, 0.5F * above) : camera.near;
}

}  // namespace

bool has_floor(const Scene& scene) {
    const Box box = standing_box(scene);
    const double footprint = static_cast<double>(box.extent().x) * static_cast<double>(box.extent().z);
    const float reach = floor_share * box.diagonal();
    double twice = 0;
    for (const uvec3 t : scene.triangles) {
        const vec3 heights(scene.positions_ws[t.x].y, scene.positions_ws[t.y].y, scene.positions_ws[t.z].y);
        if (std::min({heights.x, heights.y, heights.z}) >= box.min.y - reach &&
            std::max({heights.x, heights.y, heights.z}) <= box.min.y + reach) {
            twice += upward_area(scene, t, box);
        }
    }
    return twice > footprint;
}

void add_ground(Scene& scene, const Ground& ground, const std::vector<bool>& automatic) {
    if (ground.kind == Ground::none || scene.bounds_ws.empty() ||
        (ground.kind == Ground::automatic && has_floor(scene))) {
        return;
    }
    const Box box = standing_box(scene);
    const float size = box.diagonal();
    const bool asked = ground.kind == Ground::at_height;
    const float height = asked ? static_cast<float>(ground.height - scene.origin.y) : box.min.y - gap_share * size;
    append_plane(scene, vec3(box.centre().x, height, box.centre().z),
                 sides_of_size * size + sides_of_height * box.extent().y);
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (automatic[i]) {
            see_ground(scene.cameras[i], scene.objects.back().bounds_ws);
        }
    }
    const double said = asked ? ground.height : static_cast<double>(box.min.y) + scene.origin.y;
    add_note(scene.notes,
             asked ? fmt::format("A ground plane lies at height {:.6g}, as --ground asks.", said)
                   : fmt::format(
                         "No floor of the file's own covers half its footprint at its lowest point, so that a ground "
                         "plane is set there, at height {:.4g}; --ground none leaves it out, --ground HEIGHT "
                         "moves it.",
                         said));
}

}  // namespace gn
