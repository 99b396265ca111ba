// SPDX-License-Identifier: MIT
#include "apps/evaluation/sweep_file.h"

#include "base/error.h"
#include "base/param.h"
#include "base/toml_scalar.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

namespace gn {
namespace {

constexpr std::size_t most_values = 10'000;

/// A text, a whole number, a number or true and false, as it would be typed.
std::string text_of(const toml::node& node, const std::string& where) {
    if (std::optional<std::string> text = scalar_text(node)) {
        return *std::move(text);
    }
    fail("{}: is neither a text nor a number", where);
}

std::string text_at(const toml::table& table, std::string_view key, const std::string& where,
                    const std::string& otherwise = {}) {
    const toml::node* node = table.get(key);
    return node == nullptr ? otherwise : text_of(*node, fmt::format("{}: {}", where, key));
}

const toml::array& array_at(const toml::table& table, std::string_view key, const std::string& where) {
    const toml::node* node = table.get(key);
    if (node == nullptr || node->as_array() == nullptr || node->as_array()->empty()) {
        fail("{}: {} is missing, or is no list with something in it", where, key);
    }
    return *node->as_array();
}

const toml::table& table_of(const toml::node& node, const std::string& where) {
    if (node.as_table() == nullptr) {
        fail("{}: is no table", where);
    }
    return *node.as_table();
}

/// 25, "car", or { name = "PCF3", text = "pcf,pcf.kernel=3x3" }; further keys are further texts.
AxisValue read_value(const toml::node& node, const std::string& where) {
    if (const toml::table* table = node.as_table()) {
        AxisValue value{text_at(*table, "name", where), text_at(*table, "text", where), {}};
        if (value.name.empty() || value.text.empty()) {
            fail("{}: a value is a text, a number, or {{ name = \"...\", text = \"...\" }}", where);
        }
        for (const auto& [key, text] : *table) {
            if (key.str() != "name" && key.str() != "text") {
                value.more.emplace_back(std::string(key.str()), text_of(text, where));
            }
        }
        return value;
    }
    const std::string text = text_of(node, where);
    return {text, text, {}};
}

Axis read_axis(const toml::node& node, const std::string& where, bool quick) {
    constexpr std::array<std::string_view, 3> known{"name", "values", "quick"};
    const toml::table& table = table_of(node, where);
    check_toml_keys(table, known, where);
    Axis axis;
    axis.name = text_at(table, "name", where);
    if (axis.name.empty()) {
        fail("{}: an axis needs a name", where);
    }
    const std::string here = fmt::format("{}: axis '{}'", where, axis.name);
    // Values of both lists are read, so that a mistake in either is found at once.
    for (const std::string_view key : {"values", "quick"}) {
        if (key == "quick" && !table.contains("quick")) {
            continue;
        }
        const toml::array& list = array_at(table, key, here);
        if (list.size() > most_values) {
            fail("{}: {} values; at most {}", here, list.size(), most_values);
        }
        std::vector<AxisValue> values;
        for (const toml::node& value : list) {
            values.push_back(read_value(value, here));
            const auto same = [&](const AxisValue& other) { return other.name == values.back().name; };
            if (std::count_if(values.begin(), values.end(), same) > 1) {
                fail("{}: '{}' stands there twice", here, values.back().name);
            }
        }
        if (key == "values" || quick) {
            axis.values = std::move(values);
        }
    }
    return axis;
}

/// Settings of all grids, which each of them may replace; those under [quick] replace them where asked for.
struct Settings {
    std::string size = "640x360", view, light, samples = "256", repeat = "5", reference;
};

constexpr std::array<std::string_view, 6> setting_names{"size", "view", "light", "samples", "repeat", "reference"};

void read_settings(Settings& settings, const toml::table& table, const std::string& where) {
    settings.size = text_at(table, "size", where, settings.size);
    settings.view = text_at(table, "view", where, settings.view);
    settings.light = text_at(table, "light", where, settings.light);
    settings.samples = text_at(table, "samples", where, settings.samples);
    settings.repeat = text_at(table, "repeat", where, settings.repeat);
    settings.reference = text_at(table, "reference", where, settings.reference);
}

/// Every axis is named somewhere: one that changes nothing would measure the same again and again.
void check_axes(const Grid& grid, const std::string& where) {
    std::string all = fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", grid.scene, grid.recipe, grid.size, grid.view,
                                  grid.light, grid.samples, grid.repeat, grid.reference);
    for (const Axis& axis : grid.axes) {
        for (const AxisValue& value : axis.values) {
            all += "\n" + value.text;
        }
    }
    std::vector<std::string_view> names;
    for (const Axis& axis : grid.axes) {
        if (std::find(names.begin(), names.end(), axis.name) != names.end()) {
            fail("{}: axis '{}' stands there twice", where, axis.name);
        }
        names.push_back(axis.name);
        if (all.find("{" + axis.name + "}") == std::string::npos &&
            all.find("{" + axis.name + ".") == std::string::npos) {
            fail("{}: axis '{}' is used nowhere; scene, recipe or size would name it as {{{}}}", where, axis.name,
                 axis.name);
        }
    }
}

Grid read_grid(const toml::node& node, Settings settings, const std::string& where, bool quick) {
    constexpr std::array<std::string_view, 11> known{"name",  "scene",   "recipe", "axis",      "size", "view",
                                                     "light", "samples", "repeat", "reference", "quick"};
    const toml::table& table = table_of(node, where);
    check_toml_keys(table, known, where);
    read_settings(settings, table, where);
    if (const toml::node* shorter = table.get("quick")) {
        check_toml_keys(table_of(*shorter, where + ": quick"), setting_names, where + ": quick");
        if (quick) {
            read_settings(settings, *shorter->as_table(), where + ": quick");
        }
    }
    Grid grid{text_at(table, "name", where, "all"),
              text_at(table, "scene", where),
              text_at(table, "recipe", where),
              settings.size,
              settings.view,
              settings.light,
              settings.samples,
              settings.repeat,
              settings.reference,
              {}};
    if (grid.scene.empty() || grid.recipe.empty()) {
        fail("{}: a grid needs a scene and a recipe, which may name axes: recipe = \"{{technique}}\"", where);
    }
    if (table.contains("axis")) {
        for (const toml::node& axis : array_at(table, "axis", where)) {
            grid.axes.push_back(read_axis(axis, where, quick));
        }
    }
    check_axes(grid, where);
    return grid;
}

const Grid& grid_named(const SweepFile& file, const std::string& name, const std::string& where) {
    std::vector<std::string_view> names;
    for (const Grid& grid : file.grids) {
        if (grid.name == name || name.empty()) {
            return grid;
        }
        names.push_back(grid.name);
    }
    fail("{}: no grid is called '{}'; {}", where, name, suggest(name, names));
}

const Axis& axis_named(const Grid& grid, const std::string& name, const std::string& where) {
    std::vector<std::string_view> names;
    for (const Axis& axis : grid.axes) {
        if (axis.name == name) {
            return axis;
        }
        names.push_back(axis.name);
    }
    fail("{}: grid '{}' has no axis '{}'; {}", where, grid.name, name, suggest(name, names));
}

PlotRequest read_plot(const toml::node& node, const SweepFile& file, const std::string& where) {
    constexpr std::array<std::string_view, 6> known{"title", "grid", "x", "y", "by", "where"};
    const toml::table& table = table_of(node, where);
    check_toml_keys(table, known, where);
    PlotRequest plot{text_at(table, "title", where), text_at(table, "grid", where), text_at(table, "x", where),
                     text_at(table, "y", where),     text_at(table, "by", where),   {}};
    const Grid& grid = grid_named(file, plot.grid, where);
    plot.grid = grid.name;
    // A figure may stand where an axis does: then each run is a dot, and the front of the best is drawn.
    if (!plot.by.empty()) {
        axis_named(grid, plot.by, where);
    }
    if (const toml::node* fixed = table.get("where")) {
        for (const auto& [key, value] : table_of(*fixed, where + ": where")) {
            const Axis& axis = axis_named(grid, std::string(key.str()), where);
            const std::string name = text_of(value, where + ": where");
            const auto same = [&](const AxisValue& other) { return other.name == name; };
            // Shorter axes of the quick version may lack the value; then the page shows the first that is there.
            if (std::any_of(axis.values.begin(), axis.values.end(), same)) {
                plot.where.emplace_back(axis.name, name);
            }
        }
    }
    return plot;
}

LimitsRequest read_limits(const toml::node& node, const SweepFile& file, const std::string& where) {
    constexpr std::array<std::string_view, 4> known{"grid", "objects", "target", "budgets_ms"};
    const toml::table& table = table_of(node, where);
    check_toml_keys(table, known, where);
    LimitsRequest limits{
        text_at(table, "grid", where), text_at(table, "objects", where), text_at(table, "target", where), {}};
    const Grid& grid = grid_named(file, limits.grid, where);
    limits.grid = grid.name;
    for (const std::string& name : {limits.objects, limits.target}) {
        for (const AxisValue& value : axis_named(grid, name, where).values) {
            if (!value.number()) {
                fail("{}: axis '{}' counts something, but has the value '{}'", where, name, value.name);
            }
        }
    }
    for (const toml::node& budget : array_at(table, "budgets_ms", where)) {
        const auto value = budget.value<double>();
        if (!value || !(*value > 0)) {
            fail("{}: budgets_ms are milliseconds above 0", where);
        }
        limits.budgets_ms.push_back(*value);
    }
    return limits;
}

}  // namespace

std::optional<double> AxisValue::number() const {
    double value = 0;
    const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), value);
    return code == std::errc{} && end == name.data() + name.size() ? std::optional<double>(value) : std::nullopt;
}

SweepFile parse_sweep(std::string_view text, const std::string& where, bool quick) {
    toml::table table;
    try {
        table = toml::parse(text);
    } catch (const toml::parse_error& error) {
        fail("{}: line {}: {}", where, error.source().begin.line, error.description());
    }
    constexpr std::array<std::string_view, 13> known{"title",   "paragraph", "citation", "grid", "plot",
                                                     "limits",  "quick",     "size",     "view", "light",
                                                     "samples", "repeat",    "reference"};
    check_toml_keys(table, known, where);
    SweepFile file{text_at(table, "title", where),
                   text_at(table, "paragraph", where),
                   text_at(table, "citation", where),
                   {},
                   {},
                   {}};
    // Settings first, then grids, then what shows them.
    Settings settings;
    read_settings(settings, table, where);
    if (const toml::node* shorter = table.get("quick")) {
        check_toml_keys(table_of(*shorter, where + ": quick"), setting_names, where + ": quick");
        if (quick) {
            read_settings(settings, *shorter->as_table(), where + ": quick");
        }
    }
    for (const toml::node& node : array_at(table, "grid", where)) {
        file.grids.push_back(
            read_grid(node, settings, fmt::format("{}: grid {}", where, file.grids.size() + 1), quick));
        const auto same = [&](const Grid& other) { return other.name == file.grids.back().name; };
        if (std::count_if(file.grids.begin(), file.grids.end(), same) > 1) {
            fail("{}: two grids are called '{}'; each needs a name of its own", where, file.grids.back().name);
        }
    }
    if (table.contains("plot")) {
        for (const toml::node& node : array_at(table, "plot", where)) {
            file.plots.push_back(read_plot(node, file, fmt::format("{}: plot {}", where, file.plots.size() + 1)));
        }
    }
    if (const toml::node* node = table.get("limits")) {
        file.limits = read_limits(*node, file, where + ": limits");
    }
    return file;
}

}  // namespace gn
