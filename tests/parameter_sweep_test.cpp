// SPDX-License-Identifier: MIT
// Every parameter of every part that a shipped recipe uses, at both ends of its range (choices: every one), on one small
// picture: visibility stays a number within [0,1]. The thorough sweep adds every choice of the part's other rows; sanitizers
// see each recipe as it is shipped, since another value runs the same code.
#include "tests/rig.h"
#include "tests/thorough.h"

#include <algorithm>
#include <set>

namespace gn::parameter_sweep_test {
namespace {

/// The texts to try for a row: its ends, or all of its choices.
std::vector<std::string> ends_of(const ParamRow& row) {
    switch (row.type) {
        case ParamType::choice: return {row.choices.begin(), row.choices.end()};
        case ParamType::boolean: return {"false", "true"};
        case ParamType::integer:
            return {fmt::format("{}", static_cast<long>(row.min)), fmt::format("{}", static_cast<long>(row.max))};
        default: return {fmt::format("{}", row.min), fmt::format("{}", row.max)};
    }
}

/// The parts that take part in lighting the scene's first light.
std::vector<const Part*> parts_of(const Recipe& recipe, const Scene& scene) {
    std::vector<const Part*> parts;
    if (recipe.map != nullptr) {
        parts = {&recipe.placement_for(scene.lights.front().shape), recipe.map, recipe.lookup};
    }
    for (const Part* part : recipe.parts()) {
        if (part->stage == Stage::light || part->stage == Stage::direct || part->stage == Stage::visibility) {
            parts.push_back(part);
        }
    }
    return parts;
}

class ParameterSweep : public testing::TestWithParam<std::string> {};

/// A scene on the device; copies would leave the device's one pointing at the wrong scene.
struct LitScene {
    Scene scene;
    SceneGpu gpu;
    explicit LitScene(Scene s) : scene(std::move(s)), gpu(upload_scene(test::device(), scene)) {}
    LitScene(const LitScene&) = delete;
    LitScene& operator=(const LitScene&) = delete;
};

/// Three planes under the sun, and the same under a lamp for what does not serve the sun.
LitScene& under_sun() {
    static LitScene lit(load_scene("stack"));
    return lit;
}
LitScene& under_lamp() {
    static LitScene lit([] {
        Scene scene = load_scene("stack");
        scene.lights.front().shape.kind = GN_LIGHT_POINT;
        scene.lights.front().shape.position_ws = vec4(0.3F, 6, 0.2F, 1);
        return scene;
    }());
    return lit;
}

/// One frame's visibility must be sane; false where the recipe is refused.
bool expect_sane(LitScene& lit, const Recipe& recipe) {
    const FrameResult frame = render_frame(test::device(), lit.gpu, lit.scene.camera(""), recipe,
                                           {.width = 32, .height = 32, .only_light = 0, .picture = false});
    if (!frame.refused.front().empty()) {
        return false;
    }
    const std::vector<float>& values = frame.visibility.front().values;
    const auto insane = std::count_if(values.begin(), values.end(), [](float v) { return !(v >= 0 && v <= 1); });
    EXPECT_EQ(insane, 0) << "of " << values.size() << " values";
    return true;
}

using Settings = std::vector<std::pair<std::string_view, std::string>>;

/// What is tried of a part: every end of every row, and in the thorough sweep every end under every choice of another row,
/// which may be what makes the row count (the taps of a disc, the radius of a footprint).
std::vector<Settings> settings_of(const Part& part) {
    std::vector<Settings> list;
    for (const ParamRow& row : part.params.rows) {
        for (const std::string& end : ends_of(row)) {
            list.push_back({{row.name, end}});
            for (const ParamRow& other : part.params.rows) {
                for (const std::string_view choice : other.choices) {
                    if (test::thorough() && other.name != row.name) {
                        list.push_back({{other.name, std::string(choice)}, {row.name, end}});
                    }
                }
            }
        }
    }
    return list;
}

/// Whether no recipe has tried this yet. A placement's or a map's rows need trying once, whichever recipe uses them; a
/// lookup's with every map.
bool untried(const Recipe& recipe, const Part& part, const ParamBlock& block) {
    static std::set<std::string> tried;
    std::string key = fmt::format("{} {}", part.stage == Stage::lookup ? recipe.map->id : "", part.id);
    for (const ParamRow& row : part.params.rows) {
        key += fmt::format(" {}", block.get(row.name));
    }
    return tried.insert(key).second;
}

TEST(ParameterSweepCoverage, EveryFilterIsInAShippedRecipe) {
    std::set<std::string_view> used;
    for (const std::string& name : recipe_names()) {
        const Recipe recipe = load_recipe(name);
        for (const Part* part : recipe.parts()) {
            used.insert(part->id);
        }
    }
    for (const Part* part : all_parts()) {
        if (part->stage != Stage::placement && part->stage != Stage::direct) {
            EXPECT_TRUE(used.contains(part->id)) << part->id;
        }
    }
}

TEST_P(ParameterSweep, StaysInRangeAtBothEnds) {
    const test::ValidationGuard guard;
    Recipe shipped = load_recipe(GetParam());
    shipped.resolution = 64;
    LitScene& lit = expect_sane(under_sun(), shipped) ? under_sun() : under_lamp();
    ASSERT_TRUE(expect_sane(lit, shipped)) << "refused under the sun and under a lamp";
    if (test::sanitized && !test::thorough()) {
        return;
    }
    for (const Part* part : parts_of(shipped, lit.scene)) {
        for (const Settings& settings : settings_of(*part)) {
            Recipe recipe = shipped;
            std::string text = fmt::format("-r {},resolution=64", GetParam());
            ParamBlock& block = recipe.params.find(part->id)->second;
            for (const auto& [name, value] : settings) {
                block.set(name, value, "the sweep");
                text += fmt::format(",{}.{}={}", part->id, name, value);
            }
            if (untried(shipped, *part, block)) {
                SCOPED_TRACE(text);
                expect_sane(lit, recipe);
            }
        }
    }
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
    std::string name;
    for (const char letter : info.param) {
        name += letter == '-' ? '_' : letter;
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(Recipes, ParameterSweep, testing::ValuesIn(recipe_names()), test_name);

}  // namespace
}  // namespace gn::parameter_sweep_test
