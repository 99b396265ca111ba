// SPDX-License-Identifier: MIT
// Far maps draw meshes of fewer triangles, which are seen within their error of where those of the scene are; the first map does not.
#include "shadow/casters/simpler.h"
#include "tests/cascade_frame.h"
#include "tests/direct_scenes.h"

namespace gn::simpler_test {
namespace {

using namespace test;

/// Rings of many triangles from the camera's feet to far away, and boxes that no collapse makes simpler.
Scene rings() {
    by_hand::SceneBuilder b;
    b.ground(60).light(by_hand::sun({0.4F, -1, 0.3F}));
    for (const float z : {2.0F, -12.0F, -30.0F, -45.0F}) {
        b.torus({-3, 3, z}, 2, 0.8F, 48).box({3, 0.5F, z}, {5, 3, z + 2});
    }
    Scene scene = b.scene();
    scene.cameras = {{.position_ws = vec3(0, 6, 12), .forward_ws = glm::normalize(vec3(0, -0.35F, -1)), .far = 80}};
    return scene;
}

constexpr int side = 256;
constexpr float texels = 1.5F;
const std::string recipe = fmt::format(
    "hard,resolution={},placement=cascades,cascades.count=3,cascades.transition=none,cascades.simpler=", side);

/// What a map holds within some texels around one.
struct Around {
    float nearest = 1;
    bool bare = false;
};
Around around(std::span<const float> map, int x, int y, int reach) {
    Around found;
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, side - 1); ++v) {
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, side - 1); ++u) {
            const float depth = map[static_cast<std::size_t>(v * side + u)];
            found.nearest = std::min(found.nearest, depth);
            found.bare = found.bare || depth == 1;
        }
    }
    return found;
}

/// The first map is the same to the bit. In the others what a texel shows lies within the error, and a texel for where rays meet it,
/// of what the scene's own mesh shows: no silhouette is farther off, and nothing is nearer to the light than anything there was.
TEST(CascadesRendered, FarMapsDifferByTheErrorOfTheirMeshes) {
    const Scene scene = rings();
    SceneGpu gpu = upload_scene(device(), scene);
    const Rendered own = render(gpu, scene.cameras[0], scene.cameras[0], recipe + "0");
    const Rendered simpler = render(gpu, scene.cameras[0], scene.cameras[0], fmt::format("{}{}", recipe, texels));
    constexpr std::size_t layer = static_cast<std::size_t>(side) * side;
    const auto map_of = [&](const Rendered& frame, std::size_t i) {
        return std::span(frame.map).subspan(i * layer, layer);
    };
    ASSERT_EQ(own.map.size(), 3 * layer);
    EXPECT_TRUE(std::equal(own.map.begin(), own.map.begin() + layer, simpler.map.begin()));
    const int reach = static_cast<int>(std::ceil(texels)) + 1;
    for (std::size_t i = 1; i < 3; ++i) {
        const auto before = map_of(own, i), after = map_of(simpler, i);
        std::size_t changed = 0;
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const auto at = static_cast<std::size_t>(y * side + x);
                changed += before[at] != after[at] ? 1 : 0;
                const Around was = around(before, x, y, reach), is = around(after, x, y, reach);
                ASSERT_TRUE(after[at] == 1 || was.nearest < 1) << "map " << i << " at " << x << ", " << y;
                ASSERT_TRUE(after[at] < 1 || was.bare) << "map " << i << " at " << x << ", " << y;
                ASSERT_TRUE(before[at] == 1 || is.nearest < 1) << "map " << i << " at " << x << ", " << y;
                ASSERT_GE(after[at], was.nearest - 1e-5F) << "map " << i << " at " << x << ", " << y;
            }
        }
        EXPECT_GT(changed, 20U) << "map " << i;
    }
}

/// A ring of 4,608 triangles needs few where its texels hide the others; a box keeps its own.
TEST(CascadesRendered, FarMapsDrawFewTriangles) {
    const Scene scene = rings();
    SceneGpu gpu = upload_scene(device(), scene);
    FrameGraph graph(device());
    const SceneHandles handles = import_scene(graph, gpu);
    const ViewSamples samples = add_view_samples(graph, gpu, handles, scene.cameras[0], 16, 16);
    const FrameInput input{device(), graph, scene, handles, samples, scene.lights.data()};
    const Recipe cascades = load_recipe(fmt::format("{}{}", recipe, texels));
    const LightViews views = cascades.placement->place(input, cascades);
    ASSERT_EQ(views.simpler.size(), 3U);
    EXPECT_EQ(views.simpler[0], 0);
    EXPECT_GT(views.simpler[2], views.simpler[1]);
    const auto simpler = simpler_casters(input, views.simpler);
    EXPECT_EQ(simpler->objects, 4U);
    EXPECT_EQ(simpler->triangles_before, 4U * 2 * 48 * 48);
    EXPECT_LT(simpler->triangles_after, simpler->triangles_before / 8);
    for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
        const bool ring = scene.objects[object].triangle_count > 12;
        EXPECT_EQ(simpler->find(views.simpler[2], object) != nullptr, ring) << object;
        EXPECT_EQ(simpler->find(0, object), nullptr);
        if (ring) {
            EXPECT_LT(simpler->find(views.simpler[2], object)->index_count,
                      simpler->find(views.simpler[1], object)->index_count);
        }
    }
    EXPECT_EQ(simpler_casters(input, views.simpler), simpler) << "made once";
    graph.execute(false);
}

/// Each map has a refusal of its own where sizes of texels change, or where one pass draws all.
TEST(CascadesRendered, SimplerMeshesAskForStableWindows) {
    const Scene scene = rings();
    for (const char* other :
         {"cascades.fit=fitted", "cascades.split=sdsm-minmax", "cascades.scroll=1", "cascades.passes=layered"}) {
        const Recipe cascades = load_recipe(recipe + "1," + other);
        EXPECT_NE(cascades.placement->refuses(scene, scene.lights[0], cascades), "") << other;
    }
    const Recipe stable = load_recipe(recipe + "1");
    EXPECT_EQ(stable.placement->refuses(scene, scene.lights[0], stable), "");
}

}  // namespace
}  // namespace gn::simpler_test
