// SPDX-License-Identifier: MIT
// An object that moves takes its points, normals and bounds along, and nothing else.
#include "shadow/scene/move.h"

#include "base/error.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gn::move_test {
namespace {

/// Two triangles, each an object with vertices of its own.
Scene two_triangles() {
    Scene scene;
    scene.materials.emplace_back();
    scene.positions_ws = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(5, 0, 0), vec3(6, 0, 0), vec3(5, 1, 0)};
    scene.normals_ws.assign(6, vec3(0, 0, 1));
    scene.triangles = {uvec3(0, 1, 2), uvec3(3, 4, 5)};
    scene.objects = {{.name = "left", .first_triangle = 0, .triangle_count = 1},
                     {.name = "right", .first_triangle = 1, .triangle_count = 1}};
    for (Object& object : scene.objects) {
        for (int corner = 0; corner < 3; ++corner) {
            object.bounds_ws.grow(scene.positions_ws[scene.triangles[object.first_triangle][corner]]);
        }
        scene.bounds_ws.grow(object.bounds_ws);
    }
    return scene;
}

std::string error_of(Scene scene, std::size_t object, const mat4& moved_from_ws) {
    try {
        move_object(scene, object, moved_from_ws);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(Move, TakesPointsNormalsAndBoundsAlongAndKnowsTheWay) {
    Scene scene = two_triangles();
    const Scene before = scene;
    // A quarter turn about y, then up.
    const mat4 moved = glm::rotate(glm::translate(mat4(1), vec3(0, 3, 0)), 0.5F * pi, vec3(0, 1, 0));
    move_object(scene, 1, moved);
    for (std::size_t v = 0; v < 3; ++v) {
        EXPECT_EQ(scene.positions_ws[v], before.positions_ws[v]);
        EXPECT_EQ(scene.normals_ws[v], before.normals_ws[v]);
    }
    const Object& object = scene.objects[1];
    EXPECT_LT(glm::distance(scene.positions_ws[3], vec3(0, 3, -5)), 1e-5F);
    EXPECT_LT(glm::distance(scene.normals_ws[3], vec3(1, 0, 0)), 1e-6F);
    EXPECT_TRUE(object.bounds_ws.contains(scene.positions_ws[4]));
    EXPECT_NE(object.version, before.objects[1].version);
    EXPECT_EQ(scene.objects[0].version, before.objects[0].version);
    EXPECT_NEAR(scene.bounds_ws.max.x, 1.0F, 1e-6F) << "nothing is left at the right";
    for (std::size_t v = 3; v < 6; ++v) {
        const vec3 there(object.now_from_first * dvec4(dvec3(before.positions_ws[v]), 1));
        EXPECT_LT(glm::distance(there, scene.positions_ws[v]), 1e-5F);
    }
    // Two moves are one after the other.
    move_object(scene, 1, glm::translate(mat4(1), vec3(1, 0, 0)));
    const vec3 there(scene.objects[1].now_from_first * dvec4(dvec3(before.positions_ws[3]), 1));
    EXPECT_LT(glm::distance(there, vec3(1, 3, -5)), 1e-5F);
}

TEST(Move, StretchedNormalsStayAcross) {
    Scene scene = two_triangles();
    scene.normals_ws[0] = glm::normalize(vec3(1, 1, 0));
    move_object(scene, 0, glm::scale(mat4(1), vec3(2, 1, 1)));
    EXPECT_LT(glm::distance(scene.normals_ws[0], glm::normalize(vec3(0.5F, 1, 0))), 1e-6F);
}

TEST(Move, RefusesInOneSentence) {
    EXPECT_EQ(error_of(two_triangles(), 2, mat4(1)), "object 2 cannot move: the scene has 2");
    Scene shared = two_triangles();
    shared.triangles[1].x = 2;
    EXPECT_EQ(error_of(shared, 0, mat4(1)),
              "object 'left' cannot move: it shares vertex 2 with 'right'; give it vertices of its own");
    EXPECT_EQ(error_of(two_triangles(), 0, glm::scale(mat4(1), vec3(-1, 1, 1))),
              "object 'left' cannot move by a transform of determinant -1: it must be affine, with a positive one");
}

}  // namespace
}  // namespace gn::move_test
