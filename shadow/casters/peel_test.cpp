// SPDX-License-Identifier: MIT
// Peeled layers against every intersection of a texel's ray with the casters, sorted on the CPU.
#include "shadow/casters/peel.h"

#include "shadow/casters/caster_depth.glsl"
#include "shadow/map/derived.h"
#include "tests/rig.h"

#include <algorithm>
#include <random>

namespace gn::peel_test {
namespace {

constexpr int side = 48, layers = 4;

/// Triangles of all sizes and turns between the light and the ground, one object.
Scene soup(uint light_kind) {
    Scene scene;
    scene.materials.emplace_back();
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-4, 4);
    std::uniform_real_distribution<float> height(0, 5);
    for (uint i = 0; i < 40; ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            scene.positions_ws.emplace_back(place(random), height(random), place(random));
            scene.normals_ws.emplace_back(0, 1, 0);
            scene.uvs.emplace_back(0);
        }
        scene.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    scene.objects.push_back({"soup", 0, 40, 0, Box{vec3(-4, 0, -4), vec3(4, 5, 4)}});
    Light light{"light", {}};
    light.shape.kind = light_kind;
    light.shape.position_ws = vec4(0.1F, 12, 0.2F, 1);
    light.shape.direction_ws = vec4(glm::normalize(vec3(0.1F, -1, 0.05F)), 0);
    light.shape.cos_outer = 0.8F;
    scene.lights.push_back(light);
    scene.cameras.push_back({.position_ws = vec3(0, 12, 14), .forward_ws = glm::normalize(vec3(0, -12, -14))});
    finish_scene(scene);
    return scene;
}

struct Peeled {
    LightViews views;
    std::vector<std::vector<float>> depth;  ///< one a layer
};

Peeled peel(const Scene& scene, const std::string& recipe_text, bool by_name) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    FrameGraph graph(test::device());
    const SceneHandles handles = import_scene(graph, gpu);
    const ViewSamples samples{.width = 64, .height = 64, .camera = scene.cameras[0]};
    const FrameInput input{test::device(), graph, scene, handles, samples, scene.lights.data()};
    Recipe recipe = load_recipe(recipe_text);
    Peeled result{recipe.placement->place(input, recipe), {}};
    ShadowMap map = recipe.map->add_map(input, recipe, result.views);
    TextureHandle texture;
    if (by_name) {
        // A lookup that names them gets what it names, once.
        Part asking = *recipe.lookup;
        asking.needs = {"depth", "peeled-4", "peeled-4"};
        recipe.lookup = &asking;
        EXPECT_TRUE(map_gives(*recipe.map, "peeled-4"));
        add_derived(input, recipe, result.views, map);
        EXPECT_EQ(map.offers.size(), 2U);
        texture = map.find("peeled-4")->texture;
    } else {
        texture = add_peeled(input, recipe, result.views, layers);
    }
    graph.keep(texture);
    graph.execute(false);
    for (std::uint32_t layer = 0; layer < layers; ++layer) {
        const std::vector<std::byte> bytes = graph.download(texture, 0, layer);
        result.depth.emplace_back(bytes.size() / sizeof(float));
        std::memcpy(result.depth.back().data(), bytes.data(), bytes.size());
    }
    return result;
}

/// Depths at which the ray of a texel's centre meets the triangles, ascending; `clear` is false where one is met so near
/// its edge, or so near another surface, that rounding decides.
struct Hits {
    std::vector<float> depths;
    bool clear = true;
};

Hits hits(const Scene& scene, const GnLightView& view, int x, int y) {
    Hits found;
    const vec2 uv_ts = (vec2(x, y) + 0.5F) / static_cast<float>(side);
    const dvec3 a_ws = glsl::gn_point_at(view, uv_ts, 0);
    const dvec3 b_ws = glsl::gn_point_at(view, uv_ts, 1);
    for (const uvec3& t : scene.triangles) {
        const dvec3 p = scene.positions_ws[t.x];
        const dvec3 e1 = dvec3(scene.positions_ws[t.y]) - p;
        const dvec3 e2 = dvec3(scene.positions_ws[t.z]) - p;
        const dvec3 d = b_ws - a_ws;
        const double det = glm::dot(e1, glm::cross(d, e2));
        const double u = glm::dot(a_ws - p, glm::cross(d, e2)) / det;
        const double v = glm::dot(d, glm::cross(a_ws - p, e1)) / det;
        const double least = std::min({u, v, 1 - u - v});
        const double grazing = std::abs(det) / (glm::length(d) * glm::length(e1) * glm::length(e2));
        found.clear = found.clear && std::abs(least) > 0.02 && (least < 0 || grazing > 0.05);
        if (least >= 0) {
            found.depths.push_back(static_cast<float>(glm::dot(e2, glm::cross(a_ws - p, e1)) / det));
        }
    }
    std::sort(found.depths.begin(), found.depths.end());
    for (std::size_t i = 1; i < found.depths.size(); ++i) {
        found.clear = found.clear && found.depths[i] - found.depths[i - 1] > 1e-4F;
    }
    return found;
}

void expect_layers(const Scene& scene, const Peeled& peeled) {
    int compared = 0;
    int deep = 0;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const Hits expected = hits(scene, peeled.views.views[0], x, y);
            if (!expected.clear) {
                continue;
            }
            ++compared;
            deep += expected.depths.size() >= layers ? 1 : 0;
            for (std::size_t i = 0; i < layers; ++i) {
                const float wanted = i < expected.depths.size() ? expected.depths[i] : 1.0F;
                // The rasterizer's grid of 1/256 texel, on slopes that the test allows.
                ASSERT_NEAR(peeled.depth[i][static_cast<std::size_t>(y * side + x)], wanted, 2e-3F)
                    << "layer " << i << " of texel " << x << ", " << y;
            }
        }
    }
    EXPECT_GT(compared, side * side / 8);
    EXPECT_GT(deep, 30);
}

TEST(PeelRendered, HoldsTheNearestSurfacesInOrder) {
    for (const uint kind : {GN_LIGHT_DIRECTIONAL, GN_LIGHT_SPOT}) {
        const Scene scene = soup(kind);
        expect_layers(scene, peel(scene, "hard,placement=single,resolution=48", false));
        expect_layers(scene, peel(scene, "hard,placement=single,resolution=48", true));
    }
}

TEST(PeelRendered, TakesEveryCasterWhateverTheRecipeKeeps) {
    const Scene scene = soup(GN_LIGHT_DIRECTIONAL);
    const Peeled all = peel(scene, "hard,placement=single,resolution=48", false);
    for (const char* casters : {"back", "midpoint"}) {
        const Peeled kept = peel(scene, std::string("hard,placement=single,resolution=48,casters=") + casters, true);
        EXPECT_EQ(kept.depth, all.depth) << casters;
    }
}

TEST(Derived, NamesSayHowManyLayers) {
    const Part& depth = find_part(Stage::map, "depth");
    EXPECT_TRUE(map_gives(depth, "peeled-1"));
    EXPECT_TRUE(map_gives(depth, "peeled-16"));
    for (const char* name : {"peeled-", "peeled-0", "peeled-17", "peeled-4x", "peeled"}) {
        EXPECT_FALSE(map_gives(depth, name)) << name;
    }
}

}  // namespace
}  // namespace gn::peel_test
