// SPDX-License-Identifier: MIT
// sweeps/NAME.toml: grids of scenes, recipes, parameters and sizes to be measured. See docs/sweep.md.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gn {

/// A place along an axis: what stands in for {axis} in the grid's texts, and what figures call it.
struct AxisValue {
    std::string name, text;
    std::vector<std::pair<std::string, std::string>> more;  ///< further texts of the value: {axis.key}
    [[nodiscard]] std::optional<double> number() const;     ///< where the name is one
};

struct Axis {
    std::string name;
    std::vector<AxisValue> values;
};

/// Every combination of the axes' values is a run. The texts may name axes in braces: "{side}x{side}"; so may those of values.
struct Grid {
    std::string name;
    std::string scene, recipe, size, view, light, samples, repeat, reference;
    std::vector<Axis> axes;
};

/// Curves that the page shows first.
struct PlotRequest {
    std::string title, grid, x, y, by;
    std::vector<std::pair<std::string, std::string>> where;  ///< axis and the one value of it
};

/// [Sam07] section 4.2.1: the most objects whose frame keeps within a budget.
struct LimitsRequest {
    std::string grid, objects, target;  ///< axes: how many objects, and pixels along the target's side
    std::vector<double> budgets_ms;
};

struct SweepFile {
    std::string title, paragraph, citation;
    std::vector<Grid> grids;
    std::vector<PlotRequest> plots;
    std::optional<LimitsRequest> limits;
};

/// Reads the text of a sweep; `where` names it in sentences. `quick` takes the file's shorter axes and settings. Throws Error:
/// file, key, what would be valid.
SweepFile parse_sweep(std::string_view text, const std::string& where, bool quick);

}  // namespace gn
