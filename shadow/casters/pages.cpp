// SPDX-License-Identifier: MIT
#include "shadow/casters/pages.h"

#include "shadow/casters/caster_draw.h"
#include "shadow/casters/tiles.h"
#include "shadow/frame/history.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <algorithm>

namespace gn {
namespace {

const PlacementTable* drawn_pages(const LightViews& views) {
    const auto found = std::find_if(views.tables.begin(), views.tables.end(),
                                    [](const PlacementTable& table) { return table.name == drawn_pages_table; });
    return found != views.tables.end() ? &*found : nullptr;
}

/// Overwrites the pages with the far plane.
RasterDesc page_clear_pipeline() {
    RasterDesc desc = tile_quads({ShaderKind::fragment, "clear pages", "void main() { gl_FragDepth = 1.0; }\n"});
    desc.depth_test = desc.depth_write = true;
    desc.depth_compare = VK_COMPARE_OP_ALWAYS;
    return sealed(std::move(desc));
}

}  // namespace

bool are_pages(const LightViews& views) {
    return views.tiles && views.kept.has_value() && drawn_pages(views) != nullptr;
}

TextureDesc page_pool(std::string_view name, std::uint32_t resolution, std::uint32_t layers) {
    return {.name = std::string(name),
            .format = VK_FORMAT_D32_SFLOAT,
            .width = resolution,
            .height = resolution,
            .layers = layers,
            .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                     VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
}

void add_page_passes(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass) {
    GN_CHECK(!pass.color.valid());
    LightViews drawn = views;
    drawn.buffer = drawn_pages(views)->buffer;
    drawn.kept.reset();
    const BufferHandle quads = add_tile_draw(input, drawn, tile_quad_vertices);
    const ShaderInputs quad_inputs = view_list(drawn);
    const auto clear = made_once(input.prepared, "clear pages", 0, page_clear_pipeline);
    const std::shared_ptr<const CasterJob> job = caster_job(input, recipe, drawn, pass);
    const bool keeps = views.kept->history != nullptr;
    for (std::uint32_t layer = 0; layer < views.layers; ++layer) {
        const CasterDraw draw{job, layer};
        input.graph.add_pass(
            pass.name,
            [&](PassBuilder& builder) {
                builder.depth(pass.depth, keeps ? Load::keep : Load::clear, {.depth = 1.0F}, one_layer(layer));
                builder.indirect(quads);
                quad_inputs.declare(builder);
                draw.declare(builder);
            },
            [=](Recorder& r) {
                r.bind(*clear);
                quad_inputs.set(r);
                r.push_value(static_cast<std::int32_t>(layer));
                r.draw_indirect(quads);
                draw.record(r);
            });
    }
    if (keeps) {
        input.graph.place(pass.depth, [&](const TextureDesc& wanted) -> Texture2D& {
            const TextureDesc pool = page_pool(views.kept->name, views.resolution, views.layers);
            GN_CHECK((wanted.usage & ~pool.usage) == 0U);
            bool fresh = false;
            return views.kept->history->texture(pool, fresh);
        });
    }
}

}  // namespace gn
