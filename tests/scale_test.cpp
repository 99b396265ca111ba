// SPDX-License-Identifier: MIT
// What a shadow is does not depend on the unit of length, nor on a triangle that strayed far away.
#include "tests/rescaled.h"
#include "tests/thorough.h"

namespace gn::scale_test {
namespace {

using test::count_differing, test::lit_scene, test::rescaled, test::visibility_of, test::with_stray;

constexpr uint size = 64;

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
        recipe = test::with_small_maps(recipe, 256);
    }
    return all;
}

struct Change {
    std::string name;
    std::function<Scene(const Scene&)> apply;
};

/// Whether a recipe meets a kind of light: in a thorough sweep every one, else one in turn, and `hard` every one.
bool met(std::size_t recipe, std::size_t kind, const std::string& name) {
    return test::thorough() || recipe % kinds.size() == kind || name.starts_with("hard,");
}

/// V of every recipe under the kinds of light that it meets, before and after each change.
void expect_equal(const std::vector<std::string>& all, float slack, std::size_t most,
                  const std::vector<Change>& changes) {
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        const std::string& kind = kinds[k];
        const Scene scene = lit_scene(kind);
        std::vector<Scene> changed;
        for (const Change& change : changes) {
            changed.push_back(change.apply(scene));
        }
        for (std::size_t r = 0; r < all.size(); ++r) {
            const std::string& recipe = all[r];
            if (!met(r, k, recipe)) {
                continue;
            }
            const std::vector<float> before = visibility_of(scene, recipe, size);
            for (std::size_t i = 0; i < changes.size(); ++i) {
                if (changes[i].name == "a stray triangle" && kind == "directional" &&
                    recipe.find("placement=single") != std::string::npos) {
                    continue;  // a single map under a sun covers the whole scene by its definition
                }
                EXPECT_LE(count_differing(before, visibility_of(changed[i], recipe, size), slack), most)
                    << recipe << ", " << kind << " light, " << changes[i].name;
            }
        }
    }
}

constexpr vec3 far_away{3e6F, 10, 2e6F};

/// Powers of two near 1e-4 and 1e7: every product and sum of floats scales without any rounding, so that not a bit of V
/// may change. What does change is a length that someone wrote down in metres. And a triangle a hundred thousand times as
/// far away as the scene is large, beside the light's way: nothing that is seen has moved.
TEST(Scale, PowersOfTwoAndStraysChangeNoBitOfV) {
    expect_equal(recipes(), 0, 0,
                 {{"scaled by 2^-13", [](const Scene& scene) { return rescaled(scene, 0x1p-13F); }},
                  {"scaled by 2^23", [](const Scene& scene) { return rescaled(scene, 0x1p23F); }},
                  {"a stray triangle", [](const Scene& scene) { return with_stray(scene, far_away, true); }}});
}

/// Built-in scenes too, with their cameras inside of rooms, their lamps and textures. The warehouse's yard ends 150 m away: times 2^22 it
/// stays within 1e9 m, beyond which a scene leaves triangles out and says so.
TEST(Scale, BuiltInScenesKeepEveryBit) {
    for (const char* name : {"warehouse-inside", "courtyard"}) {
        const Scene scene = load_scene(name);
        const std::vector<float> before = visibility_of(scene, "hard,resolution=256", size);
        for (const float scale : {0x1p-13F, 0x1p22F}) {
            EXPECT_EQ(count_differing(before, visibility_of(rescaled(scene, scale), "hard,resolution=256", size), 0),
                      0U)
                << name << " times " << scale;
        }
    }
}

TEST(Scale, AStrayTriangleOfAnotherObjectChangesNoBitEither) {
    expect_equal({"hard,resolution=256", "cascades,resolution=256"}, 0, 0,
                 {{"a stray triangle", [](const Scene& scene) { return with_stray(scene, far_away, false); }}});
}

/// Decades round every vertex anew, by 2^-24 of its coordinates: 1/1000 of a texel here at most. Where an edge passes the
/// centre of a texel within that, one texel of the map changes, and the samples that read it: a handful of the 4096.
TEST(Scale, DecadesChangeSamplesAtRimsAlone) {
    expect_equal(
        {"hard,resolution=256", "pcf,resolution=256", "vsm,resolution=256", "cascades,resolution=256", "volumes"},
        0.02F, 16,
        {{"scaled by 1e-4", [](const Scene& scene) { return rescaled(scene, 1e-4F); }},
         {"scaled by 1e7", [](const Scene& scene) { return rescaled(scene, 1e7F); }}});
}

TEST(Scale, ASingleMapUnderASunSaysWhatAStrayCosts) {
    const Scene scene = with_stray(lit_scene("directional"), far_away, true);
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
}  // namespace gn::scale_test
