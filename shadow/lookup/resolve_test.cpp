// SPDX-License-Identifier: MIT
// The resolve pass clamps V; where the device validates, it first says what it clamps.
#include "tests/lookup_by_hand.h"
#include "tests/rig.h"

namespace gn::resolve_test {
namespace {

/// What a frame of the stack says whose lookup answers with the given expression.
std::vector<std::string> said_of(const char* expression) {
    const Part wrong = test::lookup_by_hand(fmt::format("    return {};", expression));
    Recipe recipe = load_recipe("hard,resolution=64");
    recipe.lookup = &wrong;

    const std::size_t before = test::device().messages().size();
    const Scene scene = load_scene("stack");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame = render_frame(test::device(), gpu, scene.camera(""), recipe,
                                           {.width = 32, .height = 32, .only_light = 0, .picture = false});
    EXPECT_EQ(frame.refused.front(), "");
    return {test::device().messages().begin() + static_cast<std::ptrdiff_t>(before), test::device().messages().end()};
}

TEST(ResolveRendered, SaysWhatItClampsWhereTheDeviceValidates) {
    // Not a number is made from what the compiler cannot know: the receiver's depth is never negative.
    for (const char* wrong :
         {"1.001", "-0.001", "sqrt(-1.0 - at.projected.depth)", "1.0 / (at.projected.depth * 0.0)"}) {
        const std::vector<std::string> said = said_of(wrong);
        ASSERT_EQ(said.size(), 1U) << wrong;
        EXPECT_NE(said.front().find("outside [0, 1] or not a number"), std::string::npos) << said.front();
        EXPECT_NE(said.front().find("hard"), std::string::npos) << said.front();
    }
}

TEST(ResolveRendered, GivesLookupsTheLightTheViewAndWhatTheyName) {
    // A lookup that needs a map's depth and what is derived of it, and would read ids where there were some.
    Part ranged;
    ranged.id = "ranged";
    ranged.stage = Stage::lookup;
    ranged.needs = {"depth", "min-max", "n-buffers"};
    ranged.optional = {"ids"};
    ranged.prologue = [](const Recipe&) {
        return std::string(R"(
float gn_ranged_visibility(GnLookup at, sampler2DArray depth, sampler2DArray ranges, sampler2DArray squares,
                           sampler2DArray ids) {
    ivec3 texel = ivec3(floor(at.projected.uv_ts / at.projected.texel_ts), at.projected.layer);
    float d = texelFetch(depth, texel, 0).r;
    vec2 least = texelFetch(ranges, ivec3(0, 0, 0), textureQueryLevels(ranges) - 1).xy;
    bool ranged = texelFetch(ranges, texel, 0).xy == vec2(d) && texelFetch(squares, texel, 0).xy == vec2(d);
    bool whole = least.x <= d && d <= least.y && least.x < least.y;
    bool told = at.light.kind == uint(GN_LIGHT_DIRECTIONAL) && at.light.intensity > 0.0 && at.view.resolution == 64.0;
    return ranged && whole && told && at.bias.constant == 0.5 ? 1.0 : 0.0;
}
)");
    };
    Recipe recipe = load_recipe("hard,resolution=64,placement=single");
    recipe.lookup = &ranged;
    const Scene scene = load_scene("contact");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const FrameResult frame = render_frame(test::device(), gpu, scene.camera(""), recipe,
                                           {.width = 32, .height = 32, .only_light = 0, .picture = false});
    EXPECT_EQ(frame.refused.front(), "");
    int counted = 0;
    for (std::size_t i = 0; i < frame.samples.position_ws.size(); ++i) {
        const vec4 p = frame.samples.position_ws[i];
        if (p.w > 0.5F && gn_counted(scene.lights[0].shape, vec3(p), vec3(frame.samples.normal_ws[i]))) {
            ++counted;
            EXPECT_EQ(frame.visibility.front().values[i], 1.0F) << i;
        }
    }
    EXPECT_GT(counted, 300);
}

/// V as a third of the cascade that served the sample.
std::vector<float> cascades_of(const std::string& transition) {
    static const Part layer = [] {
        Part part;
        part.id = "layer";
        part.stage = Stage::lookup;
        part.needs = {"depth"};
        part.prologue = [](const Recipe&) {
            return std::string(
                "float gn_layer_visibility(GnLookup at, sampler2DArray depth) { return float(at.projected.layer) / "
                "3.0; }\n");
        };
        return part;
    }();
    Recipe recipe = load_recipe("hard,resolution=64,placement=cascades,cascades.width=0.5," + transition);
    recipe.lookup = &layer;
    const Scene& scene = test::built_in("corridor");
    SceneGpu gpu = upload_scene(test::device(), scene);
    return render_frame(test::device(), gpu, scene.camera(""), recipe,
                        {.width = 64, .height = 64, .only_light = 0, .picture = false})
        .visibility.front()
        .values;
}

TEST(ResolveRendered, GoesOverFromOneViewToTheNextWhereBothServe) {
    const test::ValidationGuard guard;
    const std::vector<float> one = cascades_of("cascades.transition=none");
    const std::vector<float> both = cascades_of("cascades.transition=blend");
    int between = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_GE(both[i], one[i] - 1e-6F) << i;
        EXPECT_LE(both[i], one[i] + 1.0F / 3 + 1e-6F) << i;
        between += both[i] > one[i] + 0.01F ? 1 : 0;
    }
    EXPECT_GT(between, 200);
}

TEST(ResolveRendered, IsSilentAboutRounding) {
    for (const char* right : {"1.0", "0.0", "1.0 + 1.0e-5", "-1.0e-5"}) {
        EXPECT_EQ(said_of(right), std::vector<std::string>{}) << right;
    }
}

}  // namespace
}  // namespace gn::resolve_test
