// SPDX-License-Identifier: MIT
// A shadow map, and beside it fins on the silhouettes that say how far off an edge a texel is.
//
// Based on: Chan, Durand. Rendering Fake Soft Shadows with Smoothies. EGSR 2003. [CD03]
// Departs from it: fins are as wide as the light, so that penumbrae have its width.
//
// Stands on: shadow/placement/place (its map is placed as those of lookups are)
#include "shadow/direct/smoothies/smoothies.h"

#include "shadow/casters/fins.h"
#include "shadow/casters/raster.h"
#include "shadow/frame/map_memory.h"
#include "shadow/placement/place.h"

namespace gn::parts::smoothies {
namespace {

// [CD03] section 3.3: the darkest fin counts, and the nearest edge of those that darken anything. An edge may stand before the near plane.
constexpr const char* fin_text = R"(
    bool lamp = u.light_ws.w > 0.0;
    float eye = lamp ? dot(views[index].depth_from_ws, u.light_ws) : 0.0;
    float surface = texelFetch(depth_map, texel, 0).r;
    float light = gn_smoothies_light(off, (edge_depth - eye) * views[index].metres_per_depth,
                                     (surface - eye) * views[index].metres_per_depth, lamp, u.params);
    result = vec2(light, light < 1.0 ? edge_depth : 1.0);
)";

/// Beside the hard shadow the fin in the texel decides, for what lies behind its edge.
constexpr const char* light_text = "dot(view.depth_from_ws, vec4(receiver.p_ws, 1.0)) > fin.g ? fin.r : 1.0";

Visibility add_smoothies(const FrameInput& input, const Recipe& recipe) {
    const LightViews views = place_views(input, recipe);
    if (views.tiles) {
        refuse("smoothies draws fins into whole views, and placement '{}' has tiles; use auto or cascades",
               views.part->id);
    }
    TextureDesc desc{.name = "map",
                     .format = VK_FORMAT_D32_SFLOAT,
                     .width = views.resolution,
                     .height = views.resolution,
                     .layers = views.layers};
    const TextureHandle depth = input.graph.create(desc);
    desc.name = "smoothies";
    desc.format = VK_FORMAT_R32G32_SFLOAT;
    const TextureHandle fins = input.graph.create(desc);
    check_map_memory(input, recipe, depth);
    add_caster_passes(input, recipe, views, {.depth = depth});
    ShaderInputs extra;
    extra.texture("sampler2DArray", "depth_map", depth)
        .constant("GnSmoothiesParams", "params", recipe.of<GnSmoothiesParams>("smoothies"));
    add_fins(input, add_all_silhouettes(input), views,
             {.name = "smoothies: fins",
              .includes = "#include \"shadow/direct/smoothies/smoothies.glsl\"\n",
              .fragment = fin_text,
              .result = "vec2",
              .extra = extra},
             fins, {.color = vec4(1, 1, 0, 0)});
    return add_fin_resolve(input, recipe, views, depth, fins, {"smoothies: resolve", light_text});
}

}  // namespace
}  // namespace gn::parts::smoothies

namespace gn::parts {

const Part& direct_smoothies() {
    using namespace smoothies;
    static const Part part = [] {
        Part p;
        p.id = "smoothies";
        p.stage = Stage::direct;
        p.title = "Smoothies";
        p.citation = "CD03";
        p.features = {Feature::float32_blend};
        p.needs_scene = true;
        p.params = param_table<GnSmoothiesParams>({
            GN_PARAM(GnSmoothiesParams, width, real, 0.01, 1, "of the light's penumbra",
                     "Wider penumbrae, up to the outer half of what the light has."),
        });
        p.params_type = "GnSmoothiesParams";
        p.glsl = "shadow/direct/smoothies/smoothies.glsl";
        p.reads = {"placement", "resolution"};
        p.add_direct = add_smoothies;
        p.refuses = [](const Scene&, const Light&, const Recipe& recipe) { return refuses_fins("smoothies", recipe); };
        return p;
    }();
    return part;
}

}  // namespace gn::parts
