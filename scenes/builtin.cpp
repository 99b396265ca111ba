// SPDX-License-Identifier: MIT
// The table of built-in scenes, and the grammar NAME[:KEY=VALUE[,KEY=VALUE]...].
#include "scenes/registry.h"

#include <algorithm>
#include <array>

namespace gn {
namespace {

using GeneratorFunction = const scenes::Generator& (*)();

// One row a scene, in the order to show them.
constexpr std::array<GeneratorFunction, 17> generators{
    scenes::courtyard,
    scenes::half_plane,
    scenes::slab,
    scenes::stack,
    scenes::overlap,
    scenes::tilted,
    scenes::contact,
    scenes::fence,
    scenes::corridor,
    scenes::duel,
    scenes::car,
    scenes::boxes,
    scenes::disco_box,
    scenes::island,
    scenes::warehouse_inside,
    scenes::warehouse_outside,
    scenes::grid,
};

std::string range_text(const ParamRow& row) {
    switch (row.type) {
        case ParamType::choice: return fmt::format("{}", fmt::join(row.choices, "|"));
        case ParamType::boolean: return "true or false";
        default: return fmt::format("{:g} to {:g}{}{}", row.min, row.max, row.unit.empty() ? "" : " ", row.unit);
    }
}

std::string parameters_text(const ParamTable& table) {
    const ParamBlock defaults(table);
    std::string text;
    for (const ParamRow& row : table.rows) {
        text +=
            fmt::format("{}{}={} ({})", text.empty() ? "" : ", ", row.name, defaults.get(row.name), range_text(row));
    }
    return text;
}

const scenes::Generator& find_generator(std::string_view name) {
    std::vector<std::string_view> known;
    for (const GeneratorFunction generator : generators) {
        if (generator().name == name) {
            return generator();
        }
        known.push_back(generator().name);
    }
    fail("there is no built-in scene '{}': {}", name, suggest(name, known));
}

// Sets every KEY=VALUE of a comma-separated list.
void set_parameters(ParamBlock& block, std::string_view list, std::string_view scene) {
    const std::string where = fmt::format("scene {}", scene);
    while (!list.empty()) {
        const std::size_t comma = std::min(list.find(','), list.size());
        const std::string_view item = list.substr(0, comma);
        list.remove_prefix(std::min(comma + 1, list.size()));
        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos || equals == 0) {
            fail("{}: '{}' is no parameter; write KEY=VALUE with KEY one of: {}", where, item,
                 block.table()->rows.empty() ? "(this scene has none)" : block.table()->names());
        }
        block.set(item.substr(0, equals), item.substr(equals + 1), where);
    }
}

}  // namespace

const std::vector<BuiltinScene>& builtin_scenes() {
    static const std::vector<BuiltinScene> table = [] {
        std::vector<BuiltinScene> rows;
        for (const GeneratorFunction function : generators) {
            const scenes::Generator& generator = function();
            rows.push_back(
                {std::string(generator.name), std::string(generator.sentence), parameters_text(generator.params)});
        }
        return rows;
    }();
    return table;
}

Scene make_builtin_scene(const std::string& name_and_parameters) {
    // Split the name from its parameters and look it up.
    const std::string_view text = name_and_parameters;
    const std::size_t colon = std::min(text.find(':'), text.size());
    const scenes::Generator& generator = find_generator(text.substr(0, colon));
    ParamBlock block(generator.params);
    set_parameters(block, text.substr(std::min(colon + 1, text.size())), generator.name);

    // Build it under the name it was asked by, so that reports tell variants apart.
    Scene scene = generator.make(block);
    scene.name = name_and_parameters;
    return scene;
}

}  // namespace gn
