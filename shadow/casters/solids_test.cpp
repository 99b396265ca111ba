// SPDX-License-Identifier: MIT
// What may be left out of solids: never anything that V shows.
#include "shadow/casters/solids.h"

#include "tests/direct_scenes.h"
#include "tests/rig.h"

#include <gtest/gtest.h>

namespace gn::solids_test {
namespace {

/// A ground, which bounds nothing, and solids: two boxes, one of them wound inwards, and a ring.
Scene solids_on_a_ground(const GnLight& light) {
    by_hand::SceneBuilder builder;
    builder.ground(4)
        .box({-2, 0, -1}, {-1, 1, 1})
        .box({1, 0.5F, -1}, {2, 1.5F, 1}, true)
        .torus({0, 1, 0}, 0.6F, 0.2F, 12)
        .light(light)
        .camera({0, 6, 6}, {0, 0, 0});
    return builder.scene();
}

SolidFaces faces_under(const GnLight& light) {
    const Scene scene = solids_on_a_ground(light);
    FrameGraph graph(test::device());
    const ViewSamples samples;
    const SceneHandles handles;
    const FrameInput input{test::device(), graph, scene, handles, samples, scene.lights.data()};
    std::vector<std::uint32_t> all(scene.objects.size());
    std::iota(all.begin(), all.end(), 0U);
    return solid_faces(scene, *solids_of(input), all, light);
}

std::uint32_t triangles(const std::vector<DrawRange>& ranges) {
    std::uint32_t count = 0;
    for (const DrawRange& range : ranges) {
        count += range.index_count / 3;
    }
    return count;
}

TEST(Solids, AreDrawnByTheFacesThatTurnToALightOutside) {
    const std::uint32_t ground = 2, box = 12, ring = 2 * 12 * 12;
    for (const GnLight& light : {by_hand::sun({0.3F, -1, 0.2F}), by_hand::point({0, 5, 0})}) {
        const SolidFaces faces = faces_under(light);
        EXPECT_EQ(triangles(faces.both), ground);
        EXPECT_EQ(triangles(faces.front), box + ring);
        EXPECT_EQ(triangles(faces.back), box);
    }
}

TEST(Solids, AroundTheLightAreDrawnWhole) {
    // Within the first box, and within the ring's bounds but not the ring.
    EXPECT_EQ(triangles(faces_under(by_hand::point({-1.5F, 0.5F, 0})).both), 2U + 12U);
    EXPECT_EQ(triangles(faces_under(by_hand::point({0, 1, 0})).both), 2U + 2U * 12U * 12U);
}

std::vector<float> visibility(const Scene& scene, const std::string& recipe, int light) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame =
        render_frame(test::device(), gpu, scene.camera(""), load_recipe(recipe),
                     {.width = 96, .height = 64, .only_light = light, .samples = false, .picture = false});
    EXPECT_EQ(frame.refused.at(static_cast<std::size_t>(light)), "");
    return frame.visibility.at(static_cast<std::size_t>(light)).values;
}

TEST(SolidsRendered, GiveTheVisibilityOfAllFaces) {
    for (const GnLight& light : {by_hand::sun({0.3F, -1, 0.2F}), by_hand::spot({0, 5, 1}, {0, 0, 0}, 0.8F),
                                 by_hand::point({-1.5F, 0.5F, 0}), by_hand::point({0, 1, 0})}) {
        const Scene scene = solids_on_a_ground(light);
        EXPECT_EQ(visibility(scene, "hard,resolution=256,casters=auto", 0),
                  visibility(scene, "hard,resolution=256", 0));
    }
    // Masks and open bodies beside closed ones, under a sun, a lamp and a spot.
    const Scene& courtyard = test::built_in("courtyard");
    for (int light = 0; light < 3; ++light) {
        EXPECT_EQ(visibility(courtyard, "hard,resolution=512,casters=auto", light),
                  visibility(courtyard, "hard,resolution=512", light))
            << light;
    }
}

TEST(SolidsRendered, LeaveOutNothingOfASecondLayer) {
    GnLight light = by_hand::spot({0, 5, 1}, {0, 0, 0}, 0.8F);
    light.radius = 0.3F;
    const Scene scene = solids_on_a_ground(light);
    const std::string layers = "backprojection,backprojection.layers=2,backprojection.fusion=sum,resolution=128";
    EXPECT_EQ(visibility(scene, layers + ",casters=auto", 0), visibility(scene, layers, 0));
}

}  // namespace
}  // namespace gn::solids_test
