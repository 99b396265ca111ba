// SPDX-License-Identifier: MIT
// What maps keep of their casters: the surfaces between two known sheets, exactly, and the failure that each mode has.
#include "shadow/casters/caster_depth.glsl"
#include "shadow/placement/light_views.h"

#include "scenes/analytic.h"
#include "tests/warp_scene.h"

#include <cstring>

namespace gn::caster_depth_test {
namespace {

void add_square(Scene& scene, float y, float half) {
    const auto base = static_cast<uint>(scene.positions_ws.size());
    const auto first = static_cast<std::uint32_t>(scene.triangles.size());
    for (const vec2 corner : {vec2(-half, -half), vec2(half, -half), vec2(half, half), vec2(-half, half)}) {
        scene.positions_ws.emplace_back(corner.x, y, corner.y);
        scene.normals_ws.emplace_back(0, 1, 0);
        scene.uvs.emplace_back(0);
    }
    scene.triangles.emplace_back(base, base + 2, base + 1);
    scene.triangles.emplace_back(base, base + 3, base + 2);
    scene.objects.push_back({"square", first, 2, 0, Box{vec3(-half, y, -half), vec3(half, y, half)}});
}

/// A large square at y = 0 and a small one at y = 4, lit by a spot (or the sun) from y = 10 and above.
Scene two_sheets(bool sun) {
    Scene scene;
    scene.materials.emplace_back();
    add_square(scene, 0, 40);
    add_square(scene, 4, 1);
    Light light{"light", {}};
    light.shape.kind = sun ? GN_LIGHT_DIRECTIONAL : GN_LIGHT_SPOT;
    light.shape.position_ws = vec4(0, 10, 0, 1);
    light.shape.direction_ws = vec4(0, -1, 0, 0);
    light.shape.cos_outer = 0.7F;
    scene.lights.push_back(light);
    scene.cameras.push_back({.position_ws = vec3(0, 12, 14), .forward_ws = glm::normalize(vec3(0, -12, -14))});
    finish_scene(scene);
    return scene;
}

struct Maps {
    LightViews views;
    std::vector<float> depth, ids;
    std::size_t side = 64;
    [[nodiscard]] std::size_t texel(vec3 p_ws) const {
        glsl::GnReceiver receiver{};
        receiver.p_ws = p_ws;
        receiver.n_ws = vec3(0, 1, 0);
        const auto projected = glsl::gn_project(receiver, views.views[0], {.constant = 0, .normal = 0});
        EXPECT_TRUE(projected.inside);
        const uvec2 at(projected.uv_ts * static_cast<float>(side));
        return static_cast<std::size_t>(at.y) * side + at.x;
    }
    /// Where both sheets are, and where the lower one is alone.
    [[nodiscard]] std::size_t centre() const { return texel(vec3(0.1F, 4, 0.1F)); }
    [[nodiscard]] std::size_t beside() const { return texel(vec3(4, 0, -3)); }
};

Maps draw(const Scene& scene, const std::string& overrides) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    FrameGraph graph(test::device());
    const SceneHandles handles = import_scene(graph, gpu);
    const ViewSamples samples{.width = 64, .height = 64, .camera = scene.cameras[0]};
    const FrameInput input{test::device(), graph, scene, handles, samples, scene.lights.data()};
    const Recipe recipe = load_recipe("hard,placement=fit,resolution=64" + overrides);
    Maps maps{recipe.placement->place(input, recipe)};
    const ShadowMap map = recipe.map->add_map(input, recipe, maps.views);
    graph.keep(map.texture());
    if (const Offer* ids = map.find("ids"); ids != nullptr) {
        graph.keep(ids->texture);
    }
    graph.execute(false);
    const auto read = [&](TextureHandle texture) {
        const std::vector<std::byte> bytes = graph.download(texture);
        std::vector<float> values(bytes.size() / sizeof(float));
        std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    };
    maps.depth = read(map.texture());
    maps.ids = map.find("ids") != nullptr ? read(map.find("ids")->texture) : std::vector<float>{};
    return maps;
}

float depth_at_height(const GnLightView& view, float y) {
    return glm::dot(view.depth_from_ws, vec4(0, y, 0, 1));
}

class TwoSheets : public ::testing::TestWithParam<bool> {};

TEST_P(TwoSheets, MidpointLiesHalfWayBetweenTheTwoNearest) {
    const Maps maps = draw(two_sheets(GetParam()), ",casters=midpoint");
    const GnLightView& view = maps.views.views[0];
    const float upper = depth_at_height(view, 4);
    const float lower = depth_at_height(view, 0);
    EXPECT_NEAR(maps.depth[maps.centre()], 0.5F * (upper + lower), 1e-6F);
    // Behind the only surface of a ray there is nothing: the far plane is its second.
    EXPECT_NEAR(maps.depth[maps.beside()], 0.5F * (lower + 1), 1e-6F);
}

TEST_P(TwoSheets, DualStaysWithinItsLimitOfTheNearest) {
    for (const float limit : {0.25F, 1.0F, 30.0F}) {
        const Maps maps =
            draw(two_sheets(GetParam()), fmt::format(",casters=dual,bias.dual=0,bias.dual_world={}", limit));
        const GnLightView& view = maps.views.views[0];
        const float upper = depth_at_height(view, 4);
        const float lower = depth_at_height(view, 0);
        const float per_metre = (lower - upper) / 4;
        // The texel's ray leans: 0.2 m beside the axis 6 m away shorten at most 2 m by a millimetre.
        EXPECT_NEAR(maps.depth[maps.centre()], std::min(0.5F * (upper + lower), upper + limit * per_metre),
                    1.2e-3F * per_metre)
            << limit;
    }
}

TEST_P(TwoSheets, DualInTexelsIsMeasuredWhereTheSurfaceIs) {
    const Maps maps = draw(two_sheets(GetParam()), ",casters=dual,bias.dual=1");
    const GnLightView& view = maps.views.views[0];
    glsl::GnReceiver receiver{};
    receiver.p_ws = vec3(0, 4, 0);
    receiver.n_ws = vec3(0, 1, 0);
    const float texel_ws = glsl::gn_project(receiver, view, {.constant = 0, .normal = 0}).texel_ws;
    const float per_metre = (depth_at_height(view, 0) - depth_at_height(view, 4)) / 4;
    EXPECT_NEAR(maps.depth[maps.centre()],
                std::min(depth_at_height(view, 2), depth_at_height(view, 4) + texel_ws * per_metre), 2e-4F * per_metre);
}

TEST_P(TwoSheets, IdsNameTheNearestObject) {
    const Maps maps = draw(two_sheets(GetParam()), ",casters=ids");
    ASSERT_EQ(maps.ids.size(), maps.depth.size());
    EXPECT_NEAR(maps.depth[maps.centre()], depth_at_height(maps.views.views[0], 4), 1e-6F);
    EXPECT_EQ(maps.ids[maps.centre()], 1);
    EXPECT_EQ(maps.ids[maps.beside()], 0);
}

INSTANTIATE_TEST_SUITE_P(Lights, TwoSheets, ::testing::Bool(),
                         [](const auto& light) { return light.param ? "Sun" : "Spot"; });

TEST(Casters, PointAtIsOnTheRayAtItsDepth) {
    const GnLightView view = square_perspective(vec3(1, 9, 2), vec3(0, -1, 0), vec3(0, 0, 1), 1.2, 0.05, 30, 512);
    for (const vec3 p_ws : {vec3(0), vec3(3, 2, -1), vec3(-2, -5, 4)}) {
        glsl::GnReceiver receiver{};
        receiver.p_ws = p_ws;
        receiver.n_ws = vec3(0, 1, 0);
        const auto projected = glsl::gn_project(receiver, view, {.constant = 0, .normal = 0});
        EXPECT_LT(glm::distance(glsl::gn_point_at(view, projected.uv_ts, projected.depth), p_ws), 2e-3F);
    }
}

constexpr const char* bare = ",bias.constant=0,bias.normal=0,bias.receiver_plane=0,bias.cone=0";

test::Comparison contact(const std::string& recipe) {
    return test::compare("contact", recipe, {.width = 320, .height = 240, .samples = 1, .view = "foot"});
}

double gap(const test::Comparison& c) {
    return scenes::contact_scene::gap(c.scene.lights[0].shape, c.frame.samples.position_ws, c.visibility().values);
}

TEST(CastersRendered, ModesOtherThanTheNearestNeedNoBias) {
    EXPECT_GT(*contact(std::string("hard,resolution=512") + bare).errors.acne, 0.2);
    // What is left lies in texels that an edge runs through: the same samples in every mode, and a quarter at a quarter of the
    // texel (0.0072 and 0.0019; which samples a texel's edge meets is worth a third of that).
    const auto acne = [](const char* casters, int resolution) {
        return *contact(fmt::format("hard,resolution={},casters={}{}", resolution, casters, bare)).errors.acne;
    };
    const double edges = acne("midpoint", 512);
    EXPECT_LT(acne("midpoint", 2048), edges / 3);
    for (const char* casters : {"back", "dual", "ids"}) {
        EXPECT_EQ(acne(casters, 512), edges) << casters;
    }
}

TEST(CastersRendered, DualGrowsWithTheKernel) {
    // Eight texels cover 85 degrees for one comparison; the kernel reaches two texels further.
    const std::string recipe = std::string("pcf,casters=dual") + bare;
    EXPECT_LE(*test::compare("tilted:angle=85", recipe).errors.acne, 1e-3);
    EXPECT_GT(*test::compare("tilted:angle=85", recipe + ",bias.kernel=0").errors.acne, 0.02);
}

TEST(CastersRendered, SecondDepthLosesSheetsThatFaceTheLight) {
    // Of a row of samples, half of them dark, at most one lies in the texel that the edge runs through.
    const double edge = 1.0 / (192 / 2);
    EXPECT_LT(*test::compare("half-plane:hard=true", "hard").errors.leak, edge);
    EXPECT_GT(*test::compare("half-plane:hard=true", "hard,casters=back").errors.leak, 0.98);
    // Midpoint, dual and ids keep them.
    for (const char* casters : {"midpoint", "dual", "ids"}) {
        const auto c = test::compare("half-plane:hard=true", fmt::format("hard,casters={}", casters));
        EXPECT_LT(*c.errors.leak, edge) << casters;
    }
}

TEST(CastersRendered, SecondDepthLeaksAtContactsUnderAnyBias) {
    const std::string biased = ",resolution=512,bias.constant=3,bias.normal=0";
    const double nearest = gap(contact("hard" + biased));
    const double second = gap(contact("hard,casters=back" + biased));
    EXPECT_GT(second, nearest + 0.01);
}

TEST(CastersRendered, IdsMissWhatAnObjectCastsOnItself) {
    Scene one = load_scene("contact");
    while (one.objects.size() > 1) {
        one.objects.front().triangle_count += one.objects.back().triangle_count;
        one.objects.pop_back();
    }
    for (const char* recipe : {"hard,resolution=512", "pcf,resolution=512", "pcf,resolution=512,pcf.kernel=poisson"}) {
        // Without ids it does not matter what is one object, but that texels lie elsewhere: their phase is worth a few of a
        // hundred samples of the rim.
        const double several = *test::compare("contact", recipe).errors.leak;
        EXPECT_NEAR(*test::compare(one, recipe).errors.leak, several, several / 4) << recipe;
        EXPECT_GT(*test::compare(one, std::string(recipe) + ",casters=ids").errors.leak, 0.95) << recipe;
    }
}

TEST(CastersRendered, WorkWithEveryPlacementAndManyLayers) {
    // Where both surfaces of a texel hide the light, a mode says what the nearest does: all samples but a few along the edges of
    // a box, of 37,000.
    const double few = 3.0 / (192 * 192);
    for (const char* recipe : {"hard,placement=cascades", "hard,placement=lispsm", "pcf,placement=cascades"}) {
        const auto plain = test::compare("contact", recipe);
        for (const char* casters : {"midpoint", "dual", "ids"}) {
            const auto c = test::compare("contact", fmt::format("{},casters={}", recipe, casters));
            EXPECT_NEAR(*c.errors.mismatch, *plain.errors.mismatch, few) << recipe << " " << casters;
        }
    }
    for (const char* placement : {"cube", "paraboloid"}) {
        const std::string recipe = fmt::format("hard,resolution=512,placement={}", placement);
        const auto plain = test::compare("contact:light=point", recipe);
        for (const char* casters : {"midpoint", "dual", "ids"}) {
            const auto c = test::compare("contact:light=point", recipe + ",casters=" + casters);
            EXPECT_NEAR(*c.errors.mismatch, *plain.errors.mismatch, few) << placement << " " << casters;
        }
    }
}

TEST(CastersRefused, WhereAPartCannotServeThem) {
    const Scene scene = load_scene("contact");
    const auto refusal = [&](const std::string& recipe) -> std::string {
        try {
            check_recipe(load_recipe(recipe), scene, scene.lights[0], test::device());
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(refusal("vsm,casters=midpoint").find("maps that keep it: depth"), std::string::npos);
    EXPECT_NE(refusal("volumes,casters=back").find("casters would change nothing"), std::string::npos);
    EXPECT_EQ(refusal("pcf,casters=midpoint"), "");
    EXPECT_EQ(refusal("hard,casters=ids"), "");
    EXPECT_EQ(refusal("pcf,casters=ids"), "");
    EXPECT_EQ(refusal("vsm,casters=back"), "");
}

}  // namespace
}  // namespace gn::caster_depth_test
