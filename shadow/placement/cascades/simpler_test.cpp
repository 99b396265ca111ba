// SPDX-License-Identifier: MIT
// Far maps draw meshes of fewer triangles, which are seen within their error of where those of the scene are; the first map does not.
#include "shadow/casters/simpler.h"
#include "shadow/frame/history.h"
#include "shadow/scene/move.h"
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

/// Counts how often anything is simplified while it lives.
class Counted {
  public:
    Counted() : own_(simplifier()) {
        behind() = own_;
        count() = 0;
        simplifier() = [](std::span<const vec3> positions, std::span<const std::uint32_t> indices, std::size_t wanted,
                          float most_error) {
            ++count();
            return behind()(positions, indices, wanted, most_error);
        };
    }
    Counted(const Counted&) = delete;
    Counted& operator=(const Counted&) = delete;
    ~Counted() { simplifier() = own_; }
    /// Since it was asked last.
    static int taken() { return std::exchange(count(), 0); }

  private:
    Simplifier own_;
    static Simplifier& behind() {
        static Simplifier kept = nullptr;
        return kept;
    }
    static int& count() {
        static int kept = 0;
        return kept;
    }
};

/// Two rings stand in one place until one of them leaves it: each has meshes of vertices of its own. Where a caster turns and
/// walks nothing is simplified and the maps are as good as those of a frame by itself; where it is stretched it alone is.
TEST(CascadesRendered, SimplerMeshesGoOnWithCastersThatMoveRigidly) {
    const ValidationGuard guard;
    by_hand::SceneBuilder b;
    b.ground(60).light(by_hand::sun({0.4F, -1, 0.3F}));
    b.box({20, 0, -40}, {22, 12, -38});  // what moves stays within the scene's bounds
    b.torus({-3, 3, -30}, 2, 0.8F, 24).torus({-3, 3, -30}, 2, 0.8F, 24).torus({4, 3, -12}, 2, 0.8F, 24);
    Scene scene = b.scene();
    scene.cameras = {{.position_ws = vec3(0, 6, 12), .forward_ws = glm::normalize(vec3(0, -0.35F, -1)), .far = 80}};
    std::size_t ring = 0;
    while (scene.objects[ring].triangle_count < 32) {
        ++ring;
    }
    ++ring;  // the second one, whose vertices the first has, too
    SceneGpu gpu = upload_scene(device(), scene);
    const PreparedRecipe prepared(device(), load_recipe(fmt::format("{}{}", recipe, texels)));
    const PreparedRecipe own(device(), load_recipe(recipe + "0"));
    const Counted counted;
    History history(device());
    const auto drawn = [&](const PreparedRecipe& text, History* kept) {
        refresh_scene(device(), gpu);
        FrameOptions options{.width = 96, .height = 64, .samples = false, .picture = false};
        options.history = kept;
        return render_frame(gpu, scene.cameras[0], text, options).visibility[0].values;
    };
    const auto wrong = [&](const std::vector<float>& v) {
        const auto truth = drawn(own, nullptr);
        int different = 0;
        for (std::size_t i = 0; i < v.size(); ++i) {
            different += v[i] != truth[i] ? 1 : 0;
        }
        return different;
    };
    const int at_rest = wrong(drawn(prepared, &history));
    EXPECT_GT(Counted::taken(), 0);
    const mat4 walk = glm::translate(mat4(1), vec3(0.4F, 0.1F, 1.3F));
    const vec3 middle(-3, 3, -30);
    for (int frame = 0; frame < 3; ++frame) {
        const mat4 turn = glm::translate(mat4(1), middle) *
                          glm::rotate(mat4(1), 0.3F, glm::normalize(vec3(1, 2, 0.5F))) *
                          glm::translate(mat4(1), -middle);
        move_object(scene, ring, frame == 0 ? turn : walk);
        const auto moved = drawn(prepared, &history);
        EXPECT_EQ(Counted::taken(), 0) << frame;
        // As many samples at rims, give or take what chance makes of them.
        EXPECT_LE(wrong(moved), 2 * at_rest + 20) << frame;
        EXPECT_EQ(Counted::taken(), 0);
    }
    move_object(scene, ring, glm::scale(mat4(1), vec3(1.2F, 1, 1)));
    static_cast<void>(drawn(prepared, &history));
    EXPECT_EQ(Counted::taken(), 2) << "one ring, two maps";
    static_cast<void>(drawn(prepared, nullptr));
    EXPECT_EQ(Counted::taken(), 0) << "made for this version";
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
