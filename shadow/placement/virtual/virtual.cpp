// SPDX-License-Identifier: MIT
// Virtual shadow maps: a map so large that every pixel finds a texel of its own size, of which the pages that samples see stand in a
// pool and outlive frames: a clipmap around the viewer for a sun, mips of faces for lamps. The GPU finds, places, evicts and draws
// pages; nothing is read back.
//
// Based on: Karis, Stubbe, Wihlidal. A Deep Dive into Nanite Virtualized Geometry. SIGGRAPH Advances in Real-Time Rendering 2021.
// [KSW21]
// Departs from it: where the pool is too small all levels are coarsened alike, found in the same frame; a receiver's level follows the
// shape of its pixel on the map, not its distance.
// Stands on: shadow/placement/jittered (where in a texel the pages of a frame lie)
// Also here: virtual_grid.h, virtual_grid.cpp (the faces whose parts are pages), virtual_passes.h, virtual_passes.cpp (which pages there
// are)
#include "shadow/placement/virtual/virtual.h"

#include "shadow/casters/pages.h"
#include "shadow/frame/history.h"
#include "shadow/placement/jittered/jittered.glsl"
#include "shadow/placement/light_views.h"
#include "shadow/placement/virtual/virtual_passes.h"
#include "shadow/recipe/guard.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gn::virtual_pages {
namespace {

using virtual_pages::Grid;
using virtual_pages::PageJob;

constexpr int least_along = 8;  ///< pages along a side of the pool, where it has so many of the least side
constexpr int least_page = 16;

/// Texels along a page's side: as asked for, or what leaves 8 x 8 of them.
int page_side(const Recipe& recipe) {
    int side = recipe.of<GnVirtualParams>("virtual").page == GN_VIRTUAL_64 ? 64 : 128;
    while (side > least_page && recipe.resolution / side < least_along) {
        side /= 2;
    }
    return side;
}

/// Texels around a page that belong to its neighbours: what the bias moves a receiver by, and a kernel that is small against a page.
int border_of(const Recipe& recipe, const Guard& guard, int side) {
    const float jitter = recipe.of<GnVirtualParams>("virtual").jitter > 0 ? 1.0F : 0.0F;
    const float moved = 1 + jitter + std::abs(recipe.bias.normal) + std::abs(recipe.bias.view);
    const float kernel = guard.texels <= static_cast<float>(side) / 16 ? guard.texels : 0;
    return std::clamp(static_cast<int>(std::ceil(std::max(moved, kernel))), 2, side / 8);
}

std::string name_of_light(const FrameInput& input, const Recipe& recipe) {
    return fmt::format("of light {} {}{}", input.light_id, recipe.name, input.translucent ? " translucent" : "");
}

/// Lets pages outlive the frame, and finds those of the one before.
void keep_pages(PageJob& job, LightViews& views, const FrameInput& input, const Recipe& recipe) {
    const TextureDesc desc{.name = "pages " + name_of_light(input, recipe),
                           .format = VK_FORMAT_R32_UINT,
                           .width = static_cast<std::uint32_t>(job.pages()),
                           .height = 3,
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT};
    views.kept = KeptViews{.history = nullptr, .name = "pool " + name_of_light(input, recipe), .layers = {}};
    if (input.history == nullptr || input.parent != nullptr) {
        job.grid = virtual_pages::grid_of(input, recipe, nullptr);
        job.now = input.graph.create({.name = desc.name, .format = desc.format, .width = desc.width, .height = 3});
        return;
    }
    const Grid* const before = input.history->before<Grid>(desc.name);
    job.grid = virtual_pages::grid_of(input, recipe, before);
    const History::Pair pair = input.history->pair(desc);
    bool fresh_pool = false;
    static_cast<void>(input.history->texture(page_pool(views.kept->name, views.resolution), fresh_pool));
    job.now = input.graph.import(*pair.now);
    if (pair.before != nullptr) {
        job.before = input.graph.import(*pair.before);
    }
    const bool follows = before != nullptr && pair.before != nullptr && !fresh_pool && same_faces(*before, job.grid);
    const std::optional<std::vector<vec4>> touched =
        follows ? virtual_pages::touched_parts(input, *before) : std::nullopt;
    job.fresh = !touched.has_value() || job.params.jitter > 0;
    job.jitter = job.params.jitter * glsl::gn_jitter(static_cast<std::uint32_t>(input.history->frame()));
    job.touched = touched.value_or(std::vector<vec4>());
    job.frame = static_cast<std::uint32_t>(input.history->frame()) + 1;
    input.history->leave(desc.name, job.grid);
    views.kept->history = input.history;
}

/// Tells how many pages the frame drew.
void answer_drawn(const FrameInput& input, BufferHandle count) {
    if (input.history == nullptr || input.parent != nullptr) {
        return;
    }
    const std::shared_ptr<std::uint32_t> drawn =
        input.history->answered(fmt::format("pages drawn of light {}", input.light_id));
    input.graph.answer(count, [drawn](std::span<const std::byte> bytes) { std::memcpy(drawn.get(), bytes.data(), 4); });
}

LightViews place_virtual(const FrameInput& input, const Recipe& recipe) {
    const Guard guard = guard_of(input, recipe);
    PageJob job;
    job.params = recipe.of<GnVirtualParams>("virtual");
    job.page = page_side(recipe);
    job.border = border_of(recipe, guard, job.page);
    job.along = recipe.resolution / job.page;
    LightViews views;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    keep_pages(job, views, input, recipe);
    job.data.eye_ws = vec4(vec3(job.grid.shape.position_ws), job.grid.around ? 1 : 0);
    job.data.faces = static_cast<int>(job.grid.faces.size());
    job.data.levels = job.params.levels;
    job.data.page = static_cast<float>(job.page - 2 * job.border);
    job.data.texels = job.params.texels;
    job.data.stretch = job.params.stretch;
    job.reach = std::clamp(guard.texels - static_cast<float>(job.border), 0.0F, job.data.page);
    const virtual_pages::Pages pages = virtual_pages::add_page_search(input, job);

    // Tiles of one layer, found through the table; those of the frame's own list are drawn.
    GnLightView unknown;
    unknown.resolution = static_cast<float>(recipe.resolution);
    views.views.assign(static_cast<std::size_t>(job.pages()), unknown);
    views.kind = job.grid.shape.kind == GN_LIGHT_DIRECTIONAL ? ViewKind::affine : ViewKind::perspective;
    views.tiles = true;
    views.crosses = guard.texels > static_cast<float>(job.border) || guard.metres > 0 || guard.pixels > 0;
    views.buffer = pages.views;
    views.count = pages.count;
    views.set_data(job.data);
    views.tables = {
        {.name = "pages", .type = "uint", .buffer = pages.table, .bytes = {}},
        {.name = "rows", .type = "vec4", .buffer = {}, .bytes = bytes_of(clip_rows(job.grid.faces))},
        {.name = std::string(drawn_pages_table), .type = "GnLightView", .buffer = pages.drawn, .bytes = {}}};
    answer_drawn(input, pages.count);
    return views;
}

/// The lookups that work on pages although they ask what a region holds: 'a', 'b'.
std::string lookups_that_search_pages() {
    std::vector<std::string> ids;
    for (const Part* const part : all_parts()) {
        if (part->searches_pages) {
            ids.push_back(fmt::format("'{}'", part->id));
        }
    }
    return fmt::format("{}", fmt::join(ids, ", "));
}

std::string refuses(const Scene&, const Light&, const Recipe& recipe) {
    if (recipe.resolution < 4 * least_page) {
        return fmt::format("placement 'virtual' needs a pool of at least {} texels a side; resolution = {}",
                           4 * least_page, recipe.resolution);
    }
    if (recipe.map != nullptr && recipe.map->id != "depth") {
        return fmt::format(
            "placement 'virtual' keeps pages of depths, and map '{}' stores other things; map = depth does",
            recipe.map->id);
    }
    if (recipe.casters == Casters::midpoint || recipe.casters == Casters::dual || recipe.casters == Casters::ids) {
        return fmt::format(
            "placement 'virtual' keeps one depth a texel, and casters = {} draws more; casters = all, "
            "front or back",
            name_of(recipe.casters));
    }
    for (const std::string_view need : recipe.lookup != nullptr ? needs_of(recipe) : std::vector<std::string_view>()) {
        if (need != "depth" && !recipe.lookup->searches_pages) {
            return fmt::format(
                "lookup '{}' reads '{}' of one whole view, and placement 'virtual' spreads it over pages; 'hard' and "
                "'pcf' read depths alone, and the page that shows all is asked by {}",
                recipe.lookup->id, need, lookups_that_search_pages());
        }
    }
    return {};
}

std::string remark(const Scene&, const Recipe& recipe) {
    const int asked = recipe.of<GnVirtualParams>("virtual").page == GN_VIRTUAL_64 ? 64 : 128;
    const int side = page_side(recipe);
    return side == asked ? ""
                         : fmt::format(
                               "placement 'virtual' has pages of {} texels instead of {}, since resolution = "
                               "{} holds fewer than 64 of these",
                               side, asked, recipe.resolution);
}

ParamTable rows() {
    return param_table<GnVirtualParams>({
        GN_CHOICE(
            GnVirtualParams, page,
            "Texels along a page's side: small pages fit what is seen more closely, large ones spend less on their "
            "borders and cost less to find.",
            "64", "128"),
        GN_PARAM(GnVirtualParams, levels, integer, 1, GN_VIRTUAL_MOST_LEVELS, "",
                 "Levels of pages: the finest has 2^(levels - 1) pages along a side of what the light shines on."),
        GN_PARAM(GnVirtualParams, texels, real, 0.125, 8, "per pixel",
                 "Texels along a pixel's side that samples ask for: more are sharper, and fill the pool sooner."),
        GN_PARAM(GnVirtualParams, stretch, real, 1, 1000, "",
                 "How much longer than its mean side a texel counts where light grazes a surface: more is sharper "
                 "there and takes pages from everything else."),
        GN_PARAM(GnVirtualParams, drawn, integer, 0, 65536, "pages",
                 "Most pages that a frame draws; others are there later, and coarser ones serve till then. Pages that "
                 "show a whole face (one, or six around a lamp) come first and are drawn whatever the limit. 0: all."),
        GN_PARAM(
            GnVirtualParams, jitter, real, 0, 1, "texels",
            "Moves all pages from frame to frame of a sequence within so many of their texels: visibility=temporal "
            "gathers what lies between texels, without it edges tremble; no page is kept, all are drawn in every "
            "frame."),
    });
}

}  // namespace
}  // namespace gn::virtual_pages

namespace gn::parts {

const Part& placement_virtual() {
    using namespace gn::virtual_pages;
    static const Part part = [] {
        Part p;
        p.id = "virtual";
        p.stage = Stage::placement;
        p.title = "Pages of a virtual map that outlive frames";
        p.citation = "KSW21";
        p.data_type = "GnVirtualData";
        p.params = rows();
        p.params_type = "GnVirtualParams";
        p.glsl = "shadow/placement/virtual/virtual.glsl";
        p.place = place_virtual;
        p.refuses = refuses;
        p.remark = remark;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
