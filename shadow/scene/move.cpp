// SPDX-License-Identifier: MIT
#include "shadow/scene/move.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

/// The object's vertices, each once, ascending.
std::vector<std::uint32_t> vertices_of(const Scene& scene, const Object& object) {
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            vertices.push_back(scene.triangles[t][corner]);
        }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

void check_alone(const Scene& scene, std::size_t index, const std::vector<std::uint32_t>& vertices) {
    for (std::size_t other = 0; other < scene.objects.size(); ++other) {
        const Object& object = scene.objects[other];
        for (std::uint32_t t = object.first_triangle;
             other != index && t < object.first_triangle + object.triangle_count; ++t) {
            for (int corner = 0; corner < 3; ++corner) {
                if (std::binary_search(vertices.begin(), vertices.end(), scene.triangles[t][corner])) {
                    fail("object '{}' cannot move: it shares vertex {} with '{}'; give it vertices of its own",
                         scene.objects[index].name, scene.triangles[t][corner], object.name);
                }
            }
        }
    }
}

}  // namespace

void move_object(Scene& scene, std::size_t index, const mat4& moved_from_ws) {
    if (index >= scene.objects.size()) {
        fail("object {} cannot move: the scene has {}", index, scene.objects.size());
    }
    const dmat4 exact(moved_from_ws);
    const double volume = glm::determinant(glm::dmat3(exact));
    if (!(volume > 0.0) || !std::isfinite(volume) || glm::transpose(moved_from_ws)[3] != vec4(0, 0, 0, 1)) {
        fail("object '{}' cannot move by a transform of determinant {}: it must be affine, with a positive one",
             scene.objects[index].name, volume);
    }
    Object& object = scene.objects[index];
    const std::vector<std::uint32_t> vertices = vertices_of(scene, object);
    check_alone(scene, index, vertices);

    // Points by the transform, normals by its inverse's transpose.
    const glm::dmat3 normals = glm::transpose(glm::inverse(glm::dmat3(exact)));
    object.bounds_ws = {};
    for (const std::uint32_t v : vertices) {
        scene.positions_ws[v] = vec3(exact * dvec4(dvec3(scene.positions_ws[v]), 1));
        const dvec3 n_ws = normals * dvec3(scene.normals_ws[v]);
        const double length = glm::length(n_ws);
        scene.normals_ws[v] = length > 0.0 ? vec3(n_ws / length) : vec3(0);  // none was given, none is made up
        object.bounds_ws.grow(scene.positions_ws[v]);
    }
    object.now_from_first = exact * object.now_from_first;
    ++object.version;
    scene.bounds_ws = {};
    for (const Object& any : scene.objects) {
        scene.bounds_ws.grow(any.bounds_ws);
    }
}

}  // namespace gn
