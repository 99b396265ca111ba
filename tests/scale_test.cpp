// SPDX-License-Identifier: MIT
// What a shadow is does not depend on the unit of length, nor on a triangle that strayed far away.
#include "tests/rescaled.h"

namespace gn {
namespace {

using test::count_differing, test::lit_scene, test::rescaled, test::visibility_of, test::with_stray;

constexpr uint size = 96;

const std::vector<std::string> kinds{"directional", "spot", "point", "rectangle"};

/// Every shipped recipe, and every placement besides.
std::vector<std::string> recipes() {
    std::vector<std::string> all = recipe_names();
    std::erase(all, "none");
    for (const char* placement : {"single", "cube", "cube,cube.resolution=coverage", "paraboloid", "psm", "tsm",
                                  "cascades,cascades.fit=plain", "cascades,cascades.fit=warped",
                                  "cascades,cascades.select=projection", "cascades,cascades.split=sdsm-histogram"}) {
        all.push_back(std::string("pcf,placement=") + placement);
    }
    for (std::string& recipe : all) {
        recipe += recipe == "volumes" || recipe == "planar" || recipe == "none" ? "" : ",resolution=256";
    }
    return all;
}

/// What differs between a scene and the same scene changed, in one line a recipe and kind of light.
template <class Change>
void expect_equal(const std::vector<std::string>& all, float slack, std::size_t most, const Change& change) {
    for (const std::string& kind : kinds) {
        const Scene scene = lit_scene(kind);
        const Scene changed = change(scene);
        for (const std::string& recipe : all) {
            const std::vector<float> before = visibility_of(scene, recipe, size);
            const std::vector<float> after = visibility_of(changed, recipe, size);
            EXPECT_LE(count_differing(before, after, slack), most) << recipe << " under a light: " << kind;
        }
    }
}

/// Powers of two near 1e-4 and 1e7: every product and sum of floats scales without any rounding, so that not a bit of V
/// may change. What does change is a length that someone wrote down in metres.
TEST(Scale, ByPowersOfTwoChangesNoBitOfV) {
    for (const float scale : {0x1p-13F, 0x1p23F}) {
        SCOPED_TRACE(scale);
        expect_equal(recipes(), 0, 0, [&](const Scene& scene) { return rescaled(scene, scale); });
    }
}

/// Decades round every vertex anew, by 2^-24 of its coordinates: 1/1000 of a texel here at most. Where an edge passes the
/// centre of a texel within that, one texel of the map changes, and the samples that read it: a handful of the 9216.
TEST(Scale, ByDecadesChangesSamplesAtRimsAlone) {
    const std::vector<std::string> some{"hard,resolution=256",  "pcf,resolution=256",      "vsm,resolution=256",
                                        "evsm4,resolution=256", "cascades,resolution=256", "volumes"};
    for (const float scale : {1e-4F, 1e7F}) {
        SCOPED_TRACE(scale);
        expect_equal(some, 0.02F, 24, [&](const Scene& scene) { return rescaled(scene, scale); });
    }
}

/// A triangle a hundred thousand times as far away as the scene is large, beside the light's way. Nothing that is seen has
/// moved, so that V is the same to the bit. A single map under a sun covers the whole scene by its definition.
TEST(Scale, AStrayTriangleChangesNothing) {
    std::vector<std::string> all = recipes();
    std::erase(all, "pcf,placement=single,resolution=256");
    for (const bool own_object : {true, false}) {
        SCOPED_TRACE(own_object ? "an object of its own" : "of the last object");
        expect_equal(all, 0, 0,
                     [&](const Scene& scene) { return with_stray(scene, vec3(3e6F, 10, 2e6F), own_object); });
    }
}

TEST(Scale, ASingleMapUnderASunSaysWhatAStrayCosts) {
    const Scene scene = with_stray(lit_scene("directional"), vec3(3e6F, 10, 2e6F), true);
    SceneGpu gpu = upload_scene(test::device(), scene);
    const auto remarks_of = [&](const char* recipe) {
        return render_frame(test::device(), gpu, scene.camera(""), load_recipe(recipe),
                            {.width = 32, .height = 32, .repeat = 0, .picture = false})
            .remarks;
    };
    const auto remarks = remarks_of("hard,placement=single,resolution=64");
    ASSERT_EQ(remarks.size(), 1U);
    EXPECT_NE(remarks[0].find("placement=fit"), std::string::npos) << remarks[0];
    EXPECT_TRUE(remarks_of("hard,placement=fit,resolution=64").empty());
}

}  // namespace
}  // namespace gn
