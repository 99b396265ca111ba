// SPDX-License-Identifier: MIT
// Based on: Wang, Molnar. Second-Depth Shadow Mapping. UNC TR94-019 1994. [WM94]
// Based on: Woo. The Shadow Depth Map Revisited. Graphics Gems III 1992. [Woo92]
// Based on: Weiskopf, Ertl. Shadow Mapping Based on Dual Depth Layers. Eurographics 2003. [WE03]
// Based on: Hourcade, Nicolas. Algorithms for Antialiased Cast Shadows. Computers and Graphics 1985. [HN85]
// Departs from them: the second layer is peeled, for open meshes too; ids are of objects and stand beside depth, so that
// objects at each other's silhouettes do not darken each other.
#include "shadow/casters/caster_depth.h"

#include "shadow/casters/caster_draw.h"
#include "shadow/casters/peel.h"
#include "shadow/casters/tiles.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

TextureHandle create_map(const FrameInput& input, const LightViews& views, const char* name, VkFormat format) {
    return input.graph.create({.name = name,
                               .format = format,
                               .width = views.resolution,
                               .height = views.resolution,
                               .layers = views.layers});
}

/// Views that are drawn one by one, so that a fragment knows its own.
LightViews one_by_one(LightViews views) {
    views.layered = false;
    return views;
}

RasterDesc between_pipeline(const ShaderInputs& inputs, bool limited, bool tiles) {
    const std::string text = std::string(limited ? "#define GN_LIMITED\n" : "") + (tiles ? "#define GN_TILES\n" : "") +
                             include_line("shadow/casters/caster_depth.glsl") + inputs.text() + R"(
layout(push_constant, scalar) uniform Push { int view; } push;
#ifdef GN_TILES
layout(location = 7) flat in int tile_view;
#else
#define tile_view push.view
#endif
void main() {
    ivec3 texel = ivec3(gl_FragCoord.xy, views[tile_view].layer);
    float nearest = texelFetch(nearest_depth, texel, 0).r;
    float second = texelFetch(second_depth, texel, 0).r;
#ifdef GN_LIMITED
    vec2 uv_ts = gl_FragCoord.xy / views[tile_view].resolution;
    float limit = gn_dual_limit(views[tile_view], uv_ts, nearest, u.bias);
#else
    float limit = 1.0;
#endif
    gl_FragDepth = gn_between(nearest, second, limit);
}
)";
    const ShaderSource fragment{ShaderKind::fragment, "map between", text};
    RasterDesc desc = tiles ? tile_quads(fragment) : fullscreen(fragment);
    desc.depth_test = desc.depth_write = true;
    desc.depth_compare = VK_COMPARE_OP_ALWAYS;
    return sealed(std::move(desc));
}

/// The surface between both layers, view by view.
TextureHandle add_between(const FrameInput& input, const Recipe& recipe, const LightViews& views, TextureHandle nearest,
                          TextureHandle second) {
    const TextureHandle map = create_map(input, views, "map", VK_FORMAT_D32_SFLOAT);
    const BufferHandle quads = views.tiles ? add_tile_draw(input, views, tile_quad_vertices) : BufferHandle{};
    ShaderInputs inputs = view_list(views);
    inputs.texture("sampler2DArray", "nearest_depth", nearest)
        .texture("sampler2DArray", "second_depth", second)
        .constant("GnBias", "bias", applied_bias(input, recipe));
    const bool limited = recipe.casters == Casters::dual;
    const auto shader = made_once(input.prepared, "map between", (limited ? 1U : 0U) + (views.tiles ? 2U : 0U),
                                  [&] { return between_pipeline(inputs, limited, views.tiles); });
    for (const ViewPass& view : view_passes(views)) {
        input.graph.add_pass(
            "map between",
            [&](PassBuilder& pass) {
                pass.depth(map, view.first_of_layer ? Load::clear : Load::keep, {.depth = 1.0F}, one_layer(view.layer));
                if (views.tiles) {
                    pass.indirect(quads);
                }
                inputs.declare(pass);
            },
            [=](Recorder& r) {
                if (!views.tiles) {
                    set_viewport(r, views.views[view.index]);
                }
                r.bind(*shader);
                inputs.set(r);
                r.push_value(static_cast<int>(view.index));
                views.tiles ? r.draw_indirect(quads) : r.draw(3);
            });
    }
    return map;
}

}  // namespace

ShadowMap add_caster_depth(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    TextureHandle depth = create_map(input, views, "map", VK_FORMAT_D32_SFLOAT);
    TextureHandle ids;
    CasterPass pass{.depth = depth};
    if (recipe.casters == Casters::ids) {
        ids = create_map(input, views, "map ids", VK_FORMAT_R32_SFLOAT);
        pass.color = ids;
        pass.clear_color = {.color = vec4(-1)};
        pass.fragment = {"layout(location = 0) out float out_id;\n", "out_id = float(push.object);", {}};
        pass.by_object = true;
    }
    add_caster_passes(input, recipe, views, pass);
    if (recipe.casters == Casters::midpoint || recipe.casters == Casters::dual) {
        const TextureHandle second = add_next_layer(input, recipe, views, depth);
        depth = add_between(input, recipe, one_by_one(views), depth, second);
    }
    ShadowMap map{.offers = {{"depth", depth, nearest()}}};
    if (ids.valid()) {
        map.offers.push_back({"ids", ids, nearest()});
    }
    return map;
}

}  // namespace gn
