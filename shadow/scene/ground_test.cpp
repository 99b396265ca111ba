// SPDX-License-Identifier: MIT
// The ground under bare models: when there is one, where it lies, who sees it; and the framing of default cameras.
#include "shadow/scene/ground.h"

#include "shadow/scene/model.h"
#include "shadow/scene/testing.h"

namespace gn::ground_test {
namespace {

using namespace testing_scene;

/// A closed box between two corners, outward faces.
void add_box(Scene& scene, vec3 low, vec3 high) {
    const auto first = static_cast<std::uint32_t>(scene.positions_ws.size());
    for (std::uint32_t i = 0; i < 8; ++i) {
        scene.positions_ws.emplace_back((i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y,
                                        (i & 4U) != 0 ? high.z : low.z);
    }
    for (const uvec4 f : {uvec4(0, 2, 3, 1), uvec4(4, 5, 7, 6), uvec4(0, 4, 6, 2), uvec4(1, 3, 7, 5), uvec4(0, 1, 5, 4),
                          uvec4(2, 6, 7, 3)}) {
        scene.triangles.push_back(uvec3(f.x, f.y, f.z) + first);
        scene.triangles.push_back(uvec3(f.x, f.z, f.w) + first);
    }
}

void add_sheet(Scene& scene, float half, float y) {
    const auto first = static_cast<std::uint32_t>(scene.positions_ws.size());
    scene.positions_ws.insert(scene.positions_ws.end(),
                              {vec3(-half, y, -half), vec3(-half, y, half), vec3(half, y, half), vec3(half, y, -half)});
    scene.triangles.push_back(uvec3(0, 1, 2) + first);
    scene.triangles.push_back(uvec3(0, 2, 3) + first);
}

TEST(Ground, IsMissedWhereLittleLooksUpNearTheLowestPoint) {
    // The bottom of a closed box looks down, and its top is far above the lowest point.
    Scene box;
    add_box(box, vec3(-1, 2, -1), vec3(1, 4, 1));
    finish_scene(box);
    EXPECT_FALSE(has_floor(box));
    // A sheet of more than half the footprint is a floor, one of less is none.
    for (const float half : {0.6F, 0.8F}) {
        Scene scene;
        add_box(scene, vec3(-1, 2, -1), vec3(1, 4, 1));
        add_sheet(scene, half, 2);
        finish_scene(scene);
        EXPECT_EQ(has_floor(scene), half * half > 0.5F) << half;
    }
    // A hundredth of the size above the lowest point still is its height, three hundredths are not.
    for (const float above : {0.01F, 0.03F}) {
        Scene scene;
        add_box(scene, vec3(-1, 0, -1), vec3(1, 1, 1));
        add_sheet(scene, 1, above * std::sqrt(9.0F) * 0.99F);
        finish_scene(scene);
        EXPECT_EQ(has_floor(scene), above < 0.02F) << above;
    }
}

TEST(Ground, AVastPlaneIsAFloorThoughItIsNoPartOfTheMainMass) {
    // A hundred boxes as a town of 20 m in the middle of a plane of 2 km, sunk into it by a little.
    Scene scene;
    for (int i = 0; i < 100; ++i) {
        const vec3 at(2.0F * static_cast<float>(i % 10) - 10, -0.1F, 2.0F * static_cast<float>(i / 10) - 10);
        add_box(scene, at, at + vec3(1, 3, 1));
    }
    add_sheet(scene, 1000, 0);
    finish_scene(scene);
    ASSERT_LT(main_bounds(scene).extent().x, 100.0F);
    EXPECT_TRUE(has_floor(scene));
    // A plane beside the town is none, wide as it is.
    for (vec3& p_ws : scene.positions_ws) {
        p_ws.x += std::abs(p_ws.x) == 1000 ? 1100.0F : 0.0F;
    }
    EXPECT_FALSE(has_floor(scene));
}

TEST(Ground, LiesBelowTheMainMassAndIsSeenToItsEnd) {
    Scene scene;
    add_box(scene, vec3(-1, 2, -1), vec3(1, 4, 1));
    finish_scene(scene, {.ground = {Ground::automatic, 0}});
    ASSERT_EQ(scene.objects.back().name, "ground");
    EXPECT_EQ(scene.triangles.size(), 14U);
    EXPECT_TRUE(has_note(scene, "height 2;"));
    const Box ground = scene.objects.back().bounds_ws;
    EXPECT_LT(ground.max.y, 2.0F);
    EXPECT_GT(ground.max.y, 1.998F);
    EXPECT_GT(winding(scene, 12).y, 0.0F);
    EXPECT_GT(winding(scene, 13).y, 0.0F);
    // The shadow of a sun 20 degrees high falls on it: 2.75 heights beyond the box.
    EXPECT_GT(ground.max.x, 1 + 2 * 2.75F);
    const Camera& camera = scene.cameras.front();
    for (const vec3 corner : ground.corners()) {
        EXPECT_LT(glm::distance(corner, camera.position_ws), camera.far);
    }
    // The view is of the model: the ground moves no camera.
    Scene alone;
    add_box(alone, vec3(-1, 2, -1), vec3(1, 4, 1));
    finish_scene(alone);
    EXPECT_EQ(alone.cameras.front().position_ws, camera.position_ws);
    EXPECT_EQ(alone.triangles.size(), 12U);
}

TEST(Ground, AHeightIsInTheFilesCoordinates) {
    Scene scene;
    add_box(scene, vec3(-1, 5000, -1), vec3(1, 5002, 1));
    finish_scene(scene, {.ground = {Ground::at_height, 4999.5}});
    ASSERT_NE(scene.origin.y, 0.0);
    EXPECT_NEAR(static_cast<double>(scene.objects.back().bounds_ws.max.y) + scene.origin.y, 4999.5, 1e-3);
    // A file's own camera keeps its planes.
    Scene seen;
    add_box(seen, vec3(-1, 0, -1), vec3(1, 2, 1));
    seen.cameras.push_back({.name = "mine", .position_ws = vec3(0, 1, 5), .near = 0.5F, .far = 9.0F});
    finish_scene(seen, {.ground = {Ground::automatic, 0}});
    EXPECT_EQ(seen.cameras.front().far, 9.0F);
    EXPECT_EQ(seen.cameras.front().near, 0.5F);
}

TEST(Ground, ABareModelIsLitByASunOfTheRealSize) {
    Scene scene;
    add_box(scene, vec3(-1), vec3(1));
    finish_scene(scene, {.ground = {Ground::automatic, 0}});
    ASSERT_EQ(scene.lights.size(), 1U);
    EXPECT_NEAR(scene.lights[0].shape.angular_radius, glm::radians(0.2665F), 1e-5F);
}

TEST(Framing, DefaultCamerasShowTheWholeAtAnyAspect) {
    for (const vec3 half : {vec3(5, 0.2F, 0.5F), vec3(0.5F, 5, 0.5F), vec3(1)}) {
        for (const float aspect : {0.25F, 1.0F, 16.0F / 9, 4.0F}) {
            Scene scene;
            add_box(scene, -half, half);
            finish_scene(scene, {.aspect = aspect});
            const mat4 cs_from_ws = cs_from_vs(scene.cameras[0], aspect) * vs_from_ws(scene.cameras[0]);
            float widest = 0;
            for (const vec3 corner : scene.bounds_ws.corners()) {
                const vec4 p_cs = cs_from_ws * vec4(corner, 1);
                widest = std::max({widest, std::abs(p_cs.x / p_cs.w), std::abs(p_cs.y / p_cs.w)});
            }
            // Nothing is cut off, and no more room is left than the margin of a twentieth and perspective ask for.
            EXPECT_LT(widest, 1.0F) << aspect;
            EXPECT_GT(widest, 0.8F) << aspect;
        }
    }
}

TEST(Camera, AShiftMovesThePictureByThatMuchOfClipSpace) {
    Camera camera;
    Camera moved;
    moved.shift_cs = vec2(0.25F, -0.125F);
    for (const vec4 p_ws : {vec4(1, 2, -3, 1), vec4(-4, 0.5F, -90, 1)}) {
        const vec4 still_cs = cs_from_vs(camera, 1.5F) * vs_from_ws(camera) * p_ws;
        const vec4 moved_cs = cs_from_vs(moved, 1.5F) * vs_from_ws(moved) * p_ws;
        EXPECT_NEAR(moved_cs.x / moved_cs.w - still_cs.x / still_cs.w, 0.25F, 1e-6F);
        EXPECT_NEAR(moved_cs.y / moved_cs.w - still_cs.y / still_cs.w, -0.125F, 1e-6F);
        EXPECT_EQ(moved_cs.z, still_cs.z);
    }
}

}  // namespace
}  // namespace gn::ground_test
