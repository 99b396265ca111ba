// SPDX-License-Identifier: MIT
#include "apps/evaluation/grid.h"

#include "base/error.h"
#include "base/param.h"
#include "gpu/hash.h"

#include <algorithm>
#include <charconv>

namespace gn {
namespace {

constexpr std::size_t most_runs = 1'000'000;
constexpr int max_side = 8192;

/// What {axis} or {axis.key} stands for at a place of the grid. Throws Error.
const std::string& value_of(std::string_view mark, const Grid& grid, const std::vector<std::size_t>& index,
                            const std::string& where) {
    const std::size_t dot = mark.find('.');
    std::vector<std::string_view> names;
    for (std::size_t a = 0; a < grid.axes.size(); ++a) {
        const AxisValue& value = grid.axes[a].values[index[a]];
        if (mark == grid.axes[a].name) {
            return value.text;
        }
        for (const auto& [key, text] : value.more) {
            if (mark.substr(0, dot) == grid.axes[a].name && dot != std::string_view::npos &&
                mark.substr(dot + 1) == key) {
                return text;
            }
        }
        names.push_back(grid.axes[a].name);
    }
    fail("{}: {{{}}} names no axis, or nothing that its value '{}' has; {}", where, mark,
         dot == std::string_view::npos ? "" : std::string(mark.substr(dot + 1)), suggest(mark.substr(0, dot), names));
}

/// Puts the values where the text names their axes; values may name further ones.
std::string filled(std::string text, const Grid& grid, const std::vector<std::size_t>& index,
                   const std::string& where) {
    constexpr int most_marks = 64;
    for (int marks = 0;; ++marks) {
        const std::size_t at = text.find('{'), end = text.find('}', at);
        if (at == std::string::npos || end == std::string::npos) {
            return text;
        }
        if (marks == most_marks) {
            fail("{}: values of axes name each other without end in '{}'", where, text);
        }
        const std::string mark = text.substr(at + 1, end - at - 1);
        text.replace(at, end - at + 1, value_of(mark, grid, index, where));
    }
}

/// A whole number from 1 to `high`, or 0.
int whole(std::string_view text, int high) {
    int value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool valid = code == std::errc{} && end == text.data() + text.size() && value >= 1 && value <= high;
    return valid ? value : 0;
}

int count_of(const std::string& text, std::string_view key, int high, const std::string& where) {
    const int value = whole(text, high);
    if (value == 0) {
        fail("{}: {} = '{}'; valid is a whole number, 1 to {}", where, key, text, high);
    }
    return value;
}

void read_size(SweepRun& run, const std::string& text, const std::string& where) {
    const std::size_t x = text.find('x');
    run.width = whole(text.substr(0, x), max_side);
    run.height = x == std::string::npos ? 0 : whole(text.substr(x + 1), max_side);
    if (run.width == 0 || run.height == 0) {
        fail("{}: size = '{}'; it is written WIDTHxHEIGHT in pixels, 1x1 to {}x{}", where, text, max_side, max_side);
    }
}

SweepRun run_at(const Grid& grid, const std::vector<std::size_t>& index, const std::string& where) {
    SweepRun run;
    run.grid = grid.name;
    run.scene = filled(grid.scene, grid, index, where);
    run.recipe = filled(grid.recipe, grid, index, where);
    run.view = filled(grid.view, grid, index, where);
    run.light = filled(grid.light, grid, index, where);
    read_size(run, filled(grid.size, grid, index, where), where);
    run.samples = count_of(filled(grid.samples, grid, index, where), "samples", 1 << 20, where);
    run.repeat = count_of(filled(grid.repeat, grid, index, where), "repeat", 1000, where);
    const std::string reference = filled(grid.reference, grid, index, where);
    if (!reference.empty() && reference != "shaded" && reference != "visibility") {
        fail("{}: reference = '{}'; valid are visibility, shaded", where, reference);
    }
    run.shaded = reference == "shaded";
    for (std::size_t a = 0; a < grid.axes.size(); ++a) {
        run.at.emplace_back(grid.axes[a].name, grid.axes[a].values[index[a]].name);
    }
    run.key = Hasher().text(run.view_text()).text(run.recipe).finish().hex();
    return run;
}

/// Counts the places of a grid up, the last axis fastest; false after the last one.
bool next(std::vector<std::size_t>& index, const Grid& grid) {
    for (std::size_t a = index.size(); a-- > 0;) {
        if (++index[a] < grid.axes[a].values.size()) {
            return true;
        }
        index[a] = 0;
    }
    return false;
}

}  // namespace

std::string SweepRun::view_text() const {
    return fmt::format("{}\n{}x{}\n{}\n{}\n{}\n{}\n{}", scene, width, height, view, light, samples, repeat,
                       shaded ? "shaded" : "");
}

std::vector<SweepRun> expand(const SweepFile& file, const std::string& where) {
    std::vector<std::pair<std::string, SweepRun>> ordered;
    for (const Grid& grid : file.grids) {
        std::vector<std::size_t> index(grid.axes.size(), 0);
        do {
            SweepRun run = run_at(grid, index, fmt::format("{}: grid '{}'", where, grid.name));
            ordered.emplace_back(Hasher().text(run.view_text()).finish().hex(), std::move(run));
            if (ordered.size() > most_runs) {
                fail("{}: more than {} runs; fewer values, or several files", where, most_runs);
            }
        } while (next(index, grid));
    }
    std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<SweepRun> runs;
    for (auto& [order, run] : ordered) {
        runs.push_back(std::move(run));
    }
    return runs;
}

Shard parse_shard(const std::string& text) {
    const std::size_t slash = text.find('/');
    const int index = whole(text.substr(0, slash), 1'000'000);
    const int count = slash == std::string::npos ? 0 : whole(text.substr(slash + 1), 1'000'000);
    if (index == 0 || index > count) {
        fail("--shard: '{}' is no part; 2/4 is the second of four", text);
    }
    return {index, count};
}

std::vector<SweepRun> share_of(const std::vector<SweepRun>& runs, const Shard& shard) {
    // Number the views, which lie side by side.
    std::vector<int> view_of(runs.size(), 0);
    for (std::size_t i = 1; i < runs.size(); ++i) {
        view_of[i] = view_of[i - 1] + (runs[i].view_text() != runs[i - 1].view_text() ? 1 : 0);
    }
    const bool by_view = !runs.empty() && view_of.back() + 1 >= shard.count;
    std::vector<SweepRun> share;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        // Without enough views runs are dealt out by their keys, so that the same run of two grids stays in one part.
        const int part = by_view ? view_of[i] % shard.count
                                 : static_cast<int>(std::stoull(runs[i].key.substr(0, 8), nullptr, 16) %
                                                    static_cast<unsigned>(shard.count));
        if (part == shard.index - 1) {
            share.push_back(runs[i]);
        }
    }
    return share;
}

}  // namespace gn
