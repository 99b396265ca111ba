// SPDX-License-Identifier: MIT
// Silhouette maps: beside each depth, a point of the silhouette that passes between it and its neighbours.
//
// Based on: Sen, Cammarano, Hanrahan. Shadow Silhouette Maps. SIGGRAPH 2003. [SCH03]
// Departs from it: the vertex stage finds silhouettes from the edges' triangles, each edge drawn as a quad that covers
// every cell it touches; depth and point share one texture.
//
// Also here: silhouette_edges.cpp, silhouette_edges.h, silhouette_edges.glsl.
#include "shadow/map/prefilter.h"
#include "shadow/map/silhouette_map/silhouette_edges.h"

namespace gn::parts::silhouette_map {
namespace {

constexpr const char* join_text = R"(
layout(location = 0) out vec4 out_texel;
void main() {
    ivec3 texel = ivec3(ivec2(gl_FragCoord.xy), push_layer);
    out_texel = vec4(GN_SOURCE(texel).r, texelFetch(points, texel, 0).r, 0.0, 0.0);
}
)";

ShadowMap add_silhouette_map(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    // Rasterize depths.
    TextureDesc desc{.name = "map depth",
                     .format = VK_FORMAT_D32_SFLOAT,
                     .width = views.resolution,
                     .height = views.resolution,
                     .layers = views.layers};
    const TextureHandle depth = input.graph.create(desc);
    add_caster_passes(input, recipe, views, {.depth = depth});

    // Rasterize silhouettes, and store both in one texture.
    const TextureHandle points = add_silhouette_points(input, views, depth);
    desc.name = "map";
    desc.format = VK_FORMAT_R32G32_SFLOAT;
    const TextureHandle map = input.graph.create(desc);
    add_layer_passes(input, depth, map,
                     {.name = "silhouettes: join",
                      .text = join_text,
                      .inputs = ShaderInputs().texture("sampler2DArray", "points", points, nearest())});
    return {.offers = {{"silhouettes", map, nearest()}}};
}

std::string refuses(const Scene&, const Light&, const Recipe& recipe) {
    // Projected edges must be straight.
    return recipe.placement != nullptr && recipe.placement->bends
               ? fmt::format(
                     "map 'silhouette-map' draws straight edges and placement '{}' bends them; use auto or cube",
                     recipe.placement->id)
               : "";
}

}  // namespace
}  // namespace gn::parts::silhouette_map

namespace gn::parts {

const Part& map_silhouette_map() {
    using namespace silhouette_map;
    static const Part part = [] {
        Part p;
        p.id = "silhouette-map";
        p.stage = Stage::map;
        p.title = "Depth and silhouette points";
        p.citation = "SCH03";
        p.solid_only = true;
        p.gives = {"silhouettes"};
        p.needs_scene = true;
        p.add_map = add_silhouette_map;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
