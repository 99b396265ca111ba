// SPDX-License-Identifier: MIT
// Maps that live over frames: far windows follow the camera late, and a window that moves shows its old texels again.
//
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
// Departs from it: the kept texture wraps around instead of being shifted, so that nothing is copied and every texel of
// the grid is always rasterized at the same place, to the same bits.
#include "gpu/hash.h"
#include "shadow/casters/kept_map.h"
#include "shadow/frame/history.h"
#include "shadow/placement/cascades/cascade_views.h"

#include <algorithm>
#include <limits>

namespace gn::cascades {
namespace {

/// What was drawn of one cascade.
struct Kept {
    GnLightView view;  ///< its axes and depth tell whether the grid is still the same
    ivec2 first{0};
    bool drawn = false;
    std::uint64_t frame = 0;
};
struct KeptState {
    std::vector<Kept> cascades;
    std::uint64_t version = 0;  ///< of the geometry that was drawn
    Fingerprint casting;        ///< of what the scene told of it
};

/// What the scene and the map part tell of what is drawn.
Fingerprint drawn_of(const Scene& scene, const Light& light, const Recipe& recipe) {
    const Fingerprint casting = casting_of(scene, light);
    Hasher hasher;
    hasher.value(casting.low).value(casting.high);
    if (recipe.map != nullptr) {
        const std::span<const std::byte> params = recipe.block(*recipe.map).bytes();
        hasher.bytes(params.data(), params.size());
    }
    return hasher.finish();
}

/// A rectangle of grid texels, end exclusive.
struct Texels {
    ivec2 low{0}, high{0};
    [[nodiscard]] bool empty() const { return low.x >= high.x || low.y >= high.y; }
};

Texels both(const Texels& a, const Texels& b) {
    return {glm::max(a.low, b.low), glm::min(a.high, b.high)};
}

/// What of `now` lies outside `before`: at most four rectangles that do not overlap.
std::vector<Texels> outside(const Texels& now, const Texels& before) {
    const Texels shared = both(now, before);
    if (shared.empty()) {
        return {now};
    }
    std::vector<Texels> strips{{now.low, {shared.low.x, now.high.y}},
                               {{shared.high.x, now.low.y}, now.high},
                               {{shared.low.x, now.low.y}, {shared.high.x, shared.low.y}},
                               {{shared.low.x, shared.high.y}, {shared.high.x, now.high.y}}};
    std::erase_if(strips, [](const Texels& t) { return t.empty(); });
    return strips;
}

int floor_div(int a, int b) {
    return a / b - ((a % b != 0 && (a < 0) != (b < 0)) ? 1 : 0);
}

/// Cuts rectangles at the borders of the grid's tiles, each the size of a map; every piece is drawn by its tile's view.
std::vector<KeptDraw> draws_of(const Scene& scene, const Grid& grid, int layer, std::span<const Texels> rectangles,
                               float least_caster) {
    const int n = grid.resolution;
    std::vector<KeptDraw> draws;
    for (const Texels& texels : rectangles) {
        for (int ty = floor_div(texels.low.y, n); ty <= floor_div(texels.high.y - 1, n); ++ty) {
            for (int tx = floor_div(texels.low.x, n); tx <= floor_div(texels.high.x - 1, n); ++tx) {
                const ivec2 corner(tx * n, ty * n);
                const Texels piece = both(texels, {corner, corner + n});
                KeptDraw draw{view_of(grid, corner), ivec4(piece.low - corner, piece.high - piece.low), {}};
                draw.view.layer = layer;
                draw.casters = casters_of(scene, draw.view, least_caster);
                draws.push_back(std::move(draw));
            }
        }
    }
    return draws;
}

/// The texels of a window that the shadows of what lies in a box fall on, with a texel around them for rounding.
Texels touched_by(const Grid& grid, const Box& box_ws, const Texels& window) {
    dvec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
    for (const vec3 corner_ws : box_ws.corners()) {
        low = glm::min(low, texel_of(grid, dvec3(corner_ws)));
        high = glm::max(high, texel_of(grid, dvec3(corner_ws)));
    }
    const dvec2 first(window.low), last(window.high);
    return {ivec2(glm::clamp(glm::floor(low) - 1.0, first, last)),
            ivec2(glm::clamp(glm::ceil(high) + 1.0, first, last))};
}

/// Adds what moved to what must be drawn; where that is most of the window, it is drawn as a whole.
void add_touched(const Grid& grid, std::span<const Box> touched_ws, const Texels& window, std::vector<Texels>& fresh) {
    const std::int64_t all = std::int64_t{grid.resolution} * grid.resolution;
    std::int64_t area = 0;
    for (const Box& box_ws : touched_ws) {
        const Texels touched = touched_by(grid, box_ws, window);
        if (!touched.empty()) {
            const ivec2 size = touched.high - touched.low;
            area += std::int64_t{size.x} * size.y;
            fresh.push_back(touched);
        }
    }
    if (2 * area > all) {
        fresh = {window};
    }
}

bool same_grid(const GnLightView& a, const GnLightView& b) {
    bool same = a.resolution == b.resolution && a.depth_from_ws == b.depth_from_ws && a.grid == b.grid;
    for (int column = 0; column < 3; ++column) {
        same = same && a.cs_from_ws[column] == b.cs_from_ws[column];
    }
    return same;
}

/// Frames between redraws of a cascade: the nearest every frame, each next half as often, the last at the given rate.
std::uint64_t period_of(int cascade, const GnCascadesParams& params) {
    const int halvings = std::min(params.count - 1 - cascade, 30);
    return static_cast<std::uint64_t>(std::max(1, cascade == 0 ? 1 : params.rate >> halvings));
}

}  // namespace

void keep_windows(const FrameInput& input, const Recipe& recipe, const GnCascadesParams& params,
                  std::span<const Window> windows, LightViews& views) {
    KeptViews kept;
    kept.history = input.history;
    kept.name = fmt::format("light {} {} {} {} {}", input.light_id, recipe.name,
                            recipe.map != nullptr ? recipe.map->id : "", name_of(recipe.casters), params.least_caster);
    const std::string name = "cascades of " + kept.name;
    const auto* before = input.history->before<KeptState>(name);
    KeptState state = before != nullptr ? *before : KeptState{};
    const Fingerprint casting = drawn_of(input.scene, input.light(), recipe);
    const std::optional<std::vector<Box>> touched_ws = input.handles.touched_since(state.version);
    if (!touched_ws || state.casting != casting || state.cascades.size() != windows.size()) {
        state = {std::vector<Kept>(windows.size()), 0, casting};
    }
    state.version = input.handles.version;
    for (std::size_t i = 0; i < windows.size(); ++i) {
        const Grid& grid = windows[i].grid;
        const int n = grid.resolution;
        const ivec2 wanted = window_around(grid, windows[i].centre_ws);
        Kept& last = state.cascades[i];
        const bool usable = last.drawn && same_grid(last.view, grid.view);

        // Stay where the window was while that is recent and still holds what is to be seen.
        const dvec2 off = glm::abs(dvec2(wanted) - dvec2(last.first));
        const bool holds = std::max(off.x, off.y) <= grid.margin - 1;
        const bool due = input.history->frame() - last.frame >= period_of(static_cast<int>(i), params);
        const bool stay = usable && holds && !due;
        const ivec2 first = stay ? last.first : wanted;
        const Texels window{first, first + n};

        // Draw what is new: everything, or what the old window did not show and where something moved.
        const std::vector<Texels> everything{window};
        std::vector<Texels> fresh = everything;
        if (stay) {
            fresh.clear();
        } else if (usable && params.scroll != 0) {
            fresh = outside(window, {last.first, last.first + n});
        }
        add_touched(grid, touched_ws.value_or(std::vector<Box>{}), window, fresh);
        const int layer = static_cast<int>(i);
        kept.layers.push_back({(first % n + n) % n, draws_of(input.scene, grid, layer, fresh, params.least_caster),
                               draws_of(input.scene, grid, layer, everything, params.least_caster)});
        views.views[i] = view_of(grid, first);
        views.views[i].layer = layer;
        last = {grid.view, first, true, stay ? last.frame : input.history->frame()};
    }
    input.history->leave(name, std::move(state));
    views.kept = std::move(kept);
}

}  // namespace gn::cascades
