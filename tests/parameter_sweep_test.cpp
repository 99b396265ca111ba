// SPDX-License-Identifier: MIT
// Every parameter of every part that a shipped recipe uses, at both ends of its range (choices: every one), on one small
// picture: visibility stays a number within [0,1], and what is refused says why.
#include "tests/rig.h"

#include <algorithm>
#include <set>

namespace gn {
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
    for (const Part* part : {recipe.direct, recipe.visibility}) {
        if (part != nullptr) {
            parts.push_back(part);
        }
    }
    return parts;
}

class ParameterSweep : public testing::TestWithParam<std::string> {};

/// One frame's visibility must be sane, or its refusal a sentence.
void expect_sane(const Scene& scene, SceneGpu& gpu, const Recipe& recipe) {
    const FrameResult frame = render_frame(test::device(), gpu, scene.camera(""), recipe,
                                           {.width = 32, .height = 32, .only_light = 0, .picture = false});
    if (!frame.refused.front().empty()) {
        return;
    }
    const std::vector<float>& values = frame.visibility.front().values;
    const auto insane = std::count_if(values.begin(), values.end(), [](float v) { return !(v >= 0 && v <= 1); });
    EXPECT_EQ(insane, 0) << "of " << values.size() << " values";
}

TEST_P(ParameterSweep, StaysInRangeAtBothEnds) {
    const test::ValidationGuard guard;
    static const Scene scene = load_scene("stack");
    static SceneGpu gpu = upload_scene(test::device(), scene);
    Recipe shipped = load_recipe(GetParam());
    shipped.resolution = 64;
    expect_sane(scene, gpu, shipped);

    // A placement's or a map's rows need trying once, whichever recipe uses them; a lookup's with every map.
    static std::set<std::string> tried;
    for (const Part* part : parts_of(shipped, scene)) {
        for (const ParamRow& row : part->params.rows) {
            for (const std::string& value : ends_of(row)) {
                const std::string map = part->stage == Stage::lookup ? std::string(shipped.map->id) : "";
                if (!tried.insert(fmt::format("{} {} {} {}", map, part->id, row.name, value)).second) {
                    continue;
                }
                SCOPED_TRACE(fmt::format("-r {},resolution=64,{}.{}={}", GetParam(), part->id, row.name, value));
                Recipe recipe = shipped;
                recipe.params.find(part->id)->second.set(row.name, value, "the sweep");
                expect_sane(scene, gpu, recipe);
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
}  // namespace gn
