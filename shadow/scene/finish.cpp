// SPDX-License-Identifier: MIT
// Completing a scene: what every later stage may rely on is established here.
#include "base/error.h"
#include "shadow/scene/clusters.h"
#include "shadow/scene/cookie.h"
#include "shadow/scene/ground.h"
#include "shadow/scene/main_mass.h"
#include "shadow/scene/model.h"

#include <algorithm>

namespace gn {

namespace {

// Coordinates beyond this overflow floats when distances are raised to the fourth power.
constexpr float farthest_coordinate = 1e9F;

enum class Flaw { none, index, not_finite, degenerate };

Flaw find_flaw(const Scene& scene, uvec3 t) {
    const std::size_t count = scene.positions_ws.size();
    if (t.x >= count || t.y >= count || t.z >= count) {
        return Flaw::index;
    }
    const std::array p{scene.positions_ws[t.x], scene.positions_ws[t.y], scene.positions_ws[t.z]};
    for (const vec3& corner : p) {
        if (!finite(corner) || glm::any(glm::greaterThan(glm::abs(corner), vec3(farthest_coordinate)))) {
            return Flaw::not_finite;
        }
    }

    // No area to a double's eye: no normal, and nothing that a ray could meet.
    const dvec3 ab = dvec3(p[1]) - dvec3(p[0]);
    const dvec3 ac = dvec3(p[2]) - dvec3(p[0]);
    const double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(ac - ab, ac - ab)});
    return glm::length(glm::cross(ab, ac)) > 1e-12 * longest ? Flaw::none : Flaw::degenerate;
}

void note_count(Scene& scene, std::size_t count, const char* what) {
    if (count > 0) {
        add_note(scene.notes, fmt::format("Dropped {} triangle{} {}.", count, count == 1 ? "" : "s", what));
    }
}

}  // namespace

void drop_bad_triangles(Scene& scene) {
    // Keep the good triangles of each object in order.
    std::array<std::size_t, 4> counts{};
    std::vector<Object> objects;
    std::uint32_t kept = 0;
    for (Object& object : scene.objects) {
        const std::uint32_t begin = object.first_triangle;
        const std::uint32_t end = begin + object.triangle_count;
        object.first_triangle = kept;
        object.bounds_ws = Box{};
        for (std::uint32_t i = begin; i < end; ++i) {
            const uvec3 t = scene.triangles[i];
            const Flaw flaw = find_flaw(scene, t);
            ++counts[static_cast<std::size_t>(flaw)];
            if (flaw == Flaw::none) {
                scene.triangles[kept++] = t;
                for (int corner = 0; corner < 3; ++corner) {
                    object.bounds_ws.grow(scene.positions_ws[t[corner]]);
                }
            }
        }
        object.triangle_count = kept - object.first_triangle;
        if (object.triangle_count > 0) {
            objects.push_back(std::move(object));
        }
    }
    scene.triangles.resize(kept);
    scene.objects = std::move(objects);

    note_count(scene, counts[1], "with vertices that are not there");
    note_count(scene, counts[2], "with corners that are not finite or beyond 1e9 m");
    note_count(scene, counts[3], "without area");
}

namespace {

// One object for everything where the maker gave none; every index within range.
void check_structure(Scene& scene) {
    scene.normals_ws.resize(scene.positions_ws.size(), vec3(0.0F));
    scene.uvs.resize(scene.positions_ws.size(), vec2(0.0F));
    if (!scene.colors.empty()) {
        scene.colors.resize(scene.positions_ws.size(), vec4(1.0F));
    }
    if (scene.materials.empty()) {
        scene.materials.push_back({.name = "default"});
    }
    if (scene.objects.empty() && !scene.triangles.empty()) {
        scene.objects.push_back(
            {.name = scene.name, .triangle_count = static_cast<std::uint32_t>(scene.triangles.size())});
    }
    std::size_t covered = 0;
    for (Object& object : scene.objects) {
        GN_CHECK_EQ(object.first_triangle, covered);
        covered += object.triangle_count;
        if (object.material < 0 || object.material >= static_cast<int>(scene.materials.size())) {
            object.material = 0;
        }
    }
    GN_CHECK_EQ(covered, scene.triangles.size());
    for (Material& material : scene.materials) {
        if (material.base_color_texture >= static_cast<int>(scene.textures.size())) {
            material.base_color_texture = -1;
        }
    }
    for (Light& light : scene.lights) {
        if (light.cookie >= static_cast<int>(scene.textures.size()) || !gn_takes_cookie(light.shape)) {
            light.cookie = -1;
        }
    }
}

// Vertices that no triangle uses may hold anything: let later stages see zeros.
void clean_vertices(Scene& scene) {
    for (std::size_t v = 0; v < scene.positions_ws.size(); ++v) {
        if (!finite(scene.positions_ws[v])) {
            scene.positions_ws[v] = vec3(0.0F);
        }
        const vec3 n = scene.normals_ws[v];
        const float length = glm::length(n);
        scene.normals_ws[v] = std::isfinite(length) && length > 1e-6F ? n / length : vec3(0.0F);
        const vec2 uv = scene.uvs[v];
        if (!(std::abs(uv.x) < 1e6F && std::abs(uv.y) < 1e6F)) {
            scene.uvs[v] = vec2(0.0F);
        }
    }
    for (vec4& color : scene.colors) {
        color = finite(vec3(color)) && std::isfinite(color.a) ? color : vec4(1.0F);
    }
}

// A sun's picture that has no size lies over the scene once.
void complete_cookies(Scene& scene) {
    for (Light& light : scene.lights) {
        GnLight& shape = light.shape;
        const bool sized = std::isfinite(shape.half_size.x) && std::isfinite(shape.half_size.y) &&
                           shape.half_size.x > 0.0F && shape.half_size.y > 0.0F;
        if (light.cookie < 0 || shape.kind != GN_LIGHT_DIRECTIONAL || sized) {
            continue;
        }
        const Box bounds = bounds_without_strays(scene);
        shape.half_size = vec2(bounds.empty() ? 0.5F : 0.5F * std::max(bounds.diagonal(), 1e-12F));
        shape.position_ws = vec4(bounds.empty() ? vec3(0) : bounds.centre(), 0.0F);
    }
}

// For scenes made in memory; loaders chose the origin before they rounded to float.
void recentre(Scene& scene) {
    const Box bounds = bounds_without_strays(scene);
    if (scene.closed_form || bounds.empty()) {
        return;
    }
    const dvec3 camera_ws = scene.cameras.empty() ? dvec3(0.0) : dvec3(scene.cameras.front().position_ws);
    const vec3 shift(choose_origin(triangle_samples(scene), dvec3(bounds.min), dvec3(bounds.max),
                                   scene.cameras.empty() ? nullptr : &camera_ws));
    if (shift == vec3(0.0F)) {
        return;
    }
    scene.origin += dvec3(shift);
    for (vec3& p_ws : scene.positions_ws) {
        p_ws -= shift;
    }
    for (Object& object : scene.objects) {
        object.bounds_ws.min -= shift;
        object.bounds_ws.max -= shift;
    }
    for (Light& light : scene.lights) {
        light.shape.position_ws -= vec4(shift, 0.0F);
    }
    for (Camera& camera : scene.cameras) {
        camera.position_ws -= shift;
    }
    for (CameraPath& path : scene.paths) {
        for (Camera& frame : path.frames) {
            frame.position_ws -= shift;
        }
    }
}

}  // namespace

bool is_wholly_transparent(const Material& material) {
    return (material.alpha_mode == AlphaMode::mask && material.base_color.a < material.alpha_cutoff) ||
           (material.alpha_mode == AlphaMode::blend && material.base_color.a <= 0.0F);
}

void note_transparent(Scene& scene) {
    std::vector<bool> worn(scene.materials.size(), false);
    for (const Object& object : scene.objects) {
        worn[static_cast<std::size_t>(object.material)] = true;
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        if (worn[i] && is_wholly_transparent(material)) {
            add_note(scene.notes,
                     fmt::format("Material '{}' is wholly transparent: nothing of it casts a shadow.", material.name));
        }
    }
}

void finish_host_scene(Scene& scene) {
    check_structure(scene);
    drop_bad_triangles(scene);
    clean_vertices(scene);
    complete_normals(scene);
    scene.bounds_ws = Box{};
    for (const Object& object : scene.objects) {
        scene.bounds_ws.grow(object.bounds_ws);
    }
    complete_lights(scene);
    complete_cookies(scene);
    complete_casting(scene);
}

void finish_scene(Scene& scene, const LoadOptions& options) {
    finish_and_copy(scene, options);
}

std::vector<std::uint32_t> finish_and_copy(Scene& scene, const LoadOptions& options) {
    // Geometry that can be trusted.
    check_structure(scene);
    drop_bad_triangles(scene);
    split_objects(scene);
    recentre(scene);
    clean_vertices(scene);
    std::vector<std::uint32_t> copies = complete_normals(scene);
    note_transparent(scene);

    // What surrounds it.
    scene.bounds_ws = Box{};
    for (const Object& object : scene.objects) {
        scene.bounds_ws.grow(object.bounds_ws);
    }
    if (scene.origin != dvec3(0.0)) {
        add_note(scene.notes,
                 fmt::format("The scene lies far from zero; coordinates are relative to ({:.10g}, {:.10g}, {:.10g}).",
                             scene.origin.x, scene.origin.y, scene.origin.z));
    }
    note_lost_precision(scene);
    std::vector<bool> automatic;
    for (const Camera& camera : scene.cameras) {
        automatic.push_back(camera.far == 0.0F);
    }
    complete_cameras(scene, options.aspect);
    automatic.resize(scene.cameras.size(), true);
    add_ground(scene, options.ground, automatic);
    add_default_sun(scene);
    complete_lights(scene);
    complete_cookies(scene);
    complete_casting(scene);
    return copies;
}

}  // namespace gn
