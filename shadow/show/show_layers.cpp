// SPDX-License-Identifier: MIT
// A map's layers as one picture, and the picture that the light itself sees.
#include "shadow/casters/raster.h"
#include "shadow/show/show_passes.h"

#include <algorithm>

namespace gn {
namespace {

constexpr int gap = 2;             ///< pixels between tiles
constexpr int widest = 2048;       ///< pixels, of all tiles together
constexpr int tallest_tile = 512;  ///< pixels, where there are several

constexpr const char* tiles_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { int side; int gap; int columns; int count; } push;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(tiles)))) {
        return;
    }
    ivec2 tile = pixel / (push.side + push.gap);
    ivec2 inside = pixel - tile * (push.side + push.gap);
    int layer = tile.y * push.columns + tile.x;
    vec4 value = vec4(0.0);
    if (max(inside.x, inside.y) < push.side && tile.x < push.columns && layer < push.count) {
        ivec2 size = textureSize(layers, 0).xy;
        value = texelFetch(layers, ivec3(inside * size / push.side, layer), 0);
    }
    imageStore(tiles, pixel, value);
}
)";

struct TilesPush {
    int side, gap, columns, count;
};

// The point that a fragment at xy sees at a linear depth: in the world, or under a paraboloid in the light's frame.
constexpr const char* light_includes = R"(
#include "shadow/receiver/receiver.glsl"
layout(location = 0) out vec4 out_light;
vec3 point_at(GnLightView view, vec2 xy, float depth) {
    vec2 p_ndc = gn_ndc_at(view, xy / view.resolution);
    if (gn_bent(view)) {
        return gn_paraboloid_ray(p_ndc * view.paraboloid) * (depth * view.metres_per_depth);
    }
    vec4 near = view.ws_from_cs * vec4(p_ndc, 0.0, 1.0);
    vec4 far = view.ws_from_cs * vec4(p_ndc, 1.0, 1.0);
    vec3 start = near.xyz / near.w;
    vec3 along = far.xyz / far.w - start;
    return start + along * ((depth - dot(view.depth_from_ws, vec4(start, 1.0))) / dot(view.depth_from_ws.xyz, along));
}
)";

// The surface's slope against the ray: its points one texel further. Derivatives stand outside of any branch.
constexpr const char* light_body = R"(
    GnLightView view = views[caster_view];
    vec2 step = vec2(dFdx(in_depth), dFdy(in_depth));
    vec3 p = point_at(view, gl_FragCoord.xy, in_depth);
    vec3 right = point_at(view, gl_FragCoord.xy + vec2(1.0, 0.0), in_depth + step.x) - p;
    vec3 below = point_at(view, gl_FragCoord.xy + vec2(0.0, 1.0), in_depth + step.y) - p;
    vec3 to_eye = gn_bent(view) ? -normalize(p) : gn_to_eye(view, p);
    vec3 normal = cross(right, below);
    float size = length(normal);
    out_light = vec4(size > 0.0 ? abs(dot(normal, to_eye)) / size : 0.0, depth, 0.0, 1.0);
)";

}  // namespace

LayerTiles add_layer_tiles(const FrameInput& input, TextureHandle layers) {
    // As many columns as there is room for whole tiles.
    const TextureDesc& desc = input.graph.desc(layers);
    LayerTiles tiles;
    tiles.layers = static_cast<int>(desc.layers);
    tiles.columns = std::min(tiles.layers, widest / tallest_tile);
    const int room = tiles.layers == 1 ? 2 * tallest_tile : widest / tiles.columns;
    tiles.side = std::min({static_cast<int>(desc.width), room, tiles.layers == 1 ? room : tallest_tile});
    const int rows = (tiles.layers + tiles.columns - 1) / tiles.columns;
    tiles.image = input.graph.create({.name = "shown layers of " + desc.name,
                                      .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                      .width = static_cast<uint>(tiles.columns * (tiles.side + gap) - gap),
                                      .height = static_cast<uint>(rows * (tiles.side + gap) - gap)});
    const TextureDesc& target = input.graph.desc(tiles.image);
    ShaderInputs inputs;
    inputs.texture("sampler2DArray", "layers", layers).image("rgba32f", "writeonly", "image2D", "tiles", tiles.image);
    input.graph.add_pass(
        "show layers", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, tiles, width = target.width, height = target.height](Recorder& r) {
            r.bind(ComputeDesc{{ShaderKind::compute, "show layers", inputs.text() + tiles_text}, {}});
            inputs.set(r);
            r.push_value(TilesPush{tiles.side, gap, tiles.columns, tiles.layers});
            r.dispatch_pixels(width, height);
        });
    return tiles;
}

TextureHandle add_light_picture(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    TextureDesc desc{.name = "light picture",
                     .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                     .width = views.resolution,
                     .height = views.resolution,
                     .layers = views.layers};
    CasterPass pass;
    pass.name = "light picture";
    pass.color = input.graph.create(desc);
    desc.name = "light picture depth";
    desc.format = VK_FORMAT_D32_SFLOAT;
    pass.depth = input.graph.create(desc);
    pass.fragment.includes = light_includes;
    pass.fragment.body = light_body;

    // Maps that are kept over frames hold other contents.
    LightViews drawn = views;
    drawn.kept.reset();
    add_caster_passes(input, recipe, drawn, pass);
    return pass.color;
}

}  // namespace gn
