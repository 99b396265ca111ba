// SPDX-License-Identifier: MIT
#include "shadow/map/prefilter.h"

#include "shadow/casters/tiles.h"
#include "shadow/map/derived.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <bit>
#include <cmath>

namespace gn {
namespace {

/// What `text` of a LayerPass reads beside its inputs. Where tiles are drawn one by one, a texel's own tile ends its source.
std::string layer_head(const ShaderInputs& inputs, bool tiles) {
    std::string text = tiles ? "layout(location = 7) flat in int tile_view;\n"
                               "#define GN_FIRST gn_tile_texels(views[tile_view]).xy\n"
                               "#define GN_LAST gn_tile_texels(views[tile_view]).zw\n"
                             : "#define GN_FIRST push_drawn.xy\n#define GN_LAST (push_drawn.xy + push_drawn.zw - 1)\n";
    text += "#define GN_SOURCE(texel) source_texel(texel)\n";
    return (tiles ? include_line("shadow/casters/tiles.glsl") : "") + inputs.text() + text +
           "layout(push_constant) uniform Push { ivec4 push_drawn; int push_map_layer; int push_layer; };\n";
}

/// A texture like `source` with one sample and `mips` levels.
TextureHandle create_like(const FrameInput& input, TextureHandle source, std::string name, std::uint32_t mips) {
    TextureDesc desc = input.graph.desc(source);
    desc.name = std::move(name);
    desc.samples = 1;
    desc.mips = mips;
    desc.usage = 0;
    return input.graph.create(desc);
}

/// The mean of the samples' stored values: moments average, depths would not.
TextureHandle add_resolve_samples(const FrameInput& input, TextureHandle source, const MomentMap& map) {
    static constexpr const char* text = R"(
layout(push_constant) uniform Push { int push_layer; };
layout(location = 0) out vec4 out_moments;
void main() {
    ivec3 texel = ivec3(ivec2(gl_FragCoord.xy), push_layer);
    out_moments = 0.25 * (texelFetch(multisampled, texel, 0) + texelFetch(multisampled, texel, 1) +
                          texelFetch(multisampled, texel, 2) + texelFetch(multisampled, texel, 3));
}
)";
    const TextureHandle target = create_like(input, source, map.name, map.mips);
    ShaderInputs inputs;
    inputs.texture("sampler2DMSArray", "multisampled", source);
    const auto shader = made_once(input.prepared, "resolve samples", 0, [&] {
        return sealed(fullscreen({ShaderKind::fragment, "resolve samples", inputs.text() + text}));
    });
    for (std::uint32_t layer = 0; layer < input.graph.desc(source).layers; ++layer) {
        input.graph.add_pass(
            "resolve samples",
            [&](PassBuilder& pass) {
                inputs.declare(pass);
                pass.color(target, Load::discard, {}, one_layer(layer));
            },
            [inputs, shader, layer](Recorder& r) {
                r.bind(*shader);
                inputs.set(r);
                r.push_value(static_cast<std::int32_t>(layer));
                r.draw(3);
            });
    }
    return target;
}

/// One direction of the blur; weights stand in the shader, so that its loop is unrolled.
std::string blur_text(const std::vector<float>& weights, const char* step) {
    std::string text = "layout(location = 0) out vec4 out_moments;\n";
    text += fmt::format("const float weights[{}] = float[](", weights.size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
        text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", weights[i]);
    }
    text += fmt::format(R"();
void main() {{
    ivec2 first = GN_FIRST;
    ivec2 last = GN_LAST;
    ivec2 texel = ivec2(gl_FragCoord.xy);
    out_moments = weights[0] * GN_SOURCE(ivec3(texel, push_layer));
    for (int i = 1; i < {}; ++i) {{
        ivec2 step = i * ivec2({});
        out_moments += weights[i] * (GN_SOURCE(ivec3(clamp(texel + step, first, last), push_layer)) +
                                     GN_SOURCE(ivec3(clamp(texel - step, first, last), push_layer)));
    }}
}}
)",
                        weights.size(), step);
    return text;
}

bool blurs(int kernel, int radius) {
    return kernel != GN_BLUR_NONE && radius > 0;
}

/// Levels of the texture that is read.
std::uint32_t all_mips(const GnPrefilterParams& params, std::uint32_t resolution) {
    return params.mipmaps != 0 ? static_cast<std::uint32_t>(std::bit_width(resolution)) : 1;
}

}  // namespace

TextureHandle create_depth(const FrameInput& input, const LightViews& views, const MomentMap& map) {
    return input.graph.create({.name = map.name + " depth",
                               .format = VK_FORMAT_D32_SFLOAT,
                               .width = views.resolution,
                               .height = views.resolution,
                               .layers = views.layers,
                               .samples = static_cast<std::uint32_t>(map.samples)});
}

TextureHandle add_moments(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                          const MomentMap& map) {
    TextureDesc color{.name = map.name,
                      .format = map.format,
                      .width = views.resolution,
                      .height = views.resolution,
                      .layers = views.layers,
                      .mips = map.samples > 1 ? 1 : map.mips,
                      .samples = static_cast<std::uint32_t>(map.samples)};
    if (map.samples > 1) {
        color.name += " samples";
    }
    const TextureHandle target = input.graph.create(color);
    add_caster_passes(input, recipe, views,
                      {.name = "map",
                       .color = target,
                       .clear_color = map.clear,
                       .depth = map.depth.valid() ? map.depth : create_depth(input, views, map),
                       .fragment = map.fragment});
    return map.samples > 1 ? add_resolve_samples(input, target, map) : target;
}

std::vector<float> blur_weights(int kernel, int radius) {
    std::vector<float> weights(static_cast<std::size_t>(radius) + 1, 1.0F);
    if (kernel == GN_BLUR_GAUSSIAN && radius > 0) {
        const float sigma = 0.5F * static_cast<float>(radius);
        for (std::size_t i = 0; i < weights.size(); ++i) {
            const float x = static_cast<float>(i) / sigma;
            weights[i] = std::exp(-0.5F * x * x);
        }
    }
    float sum = weights[0];
    for (std::size_t i = 1; i < weights.size(); ++i) {
        sum += 2 * weights[i];
    }
    for (float& weight : weights) {
        weight /= sum;
    }
    return weights;
}

TextureHandle add_blur(const FrameInput& input, const LightViews& views, TextureHandle source, int kernel, int radius,
                       std::uint32_t mips) {
    if (!blurs(kernel, radius)) {
        return source;
    }
    const auto text = [&](const char* step) {
        return *made_once(input.prepared, step, Hasher().value(kernel).value(radius).finish().low,
                          [&] { return blur_text(blur_weights(kernel, radius), step); });
    };
    const TextureHandle half = create_like(input, source, "map blurred in u", 1);
    const TextureHandle whole = create_like(input, source, "map blurred", mips);
    add_layer_passes(input, source, half, {.name = "blur u", .text = text("1, 0"), .tiles = &views});
    add_layer_passes(input, half, whole, {.name = "blur v", .text = text("0, 1"), .tiles = &views});
    return whole;
}

namespace {

/// Where the layer's views lie; which layer of the map a layer of the target belongs to, where a view has several; and the
/// target's own.
struct LayerPush {
    ivec4 drawn;
    std::int32_t map_layer, layer;
};

/// Where a layer's views lie, x, y, width and height in texels.
ivec4 drawn_texels(const LightViews& views, std::uint32_t layer) {
    vec2 first(static_cast<float>(views.resolution));
    vec2 end(0);
    for (const GnLightView& view : views.views) {
        if (view.layer == static_cast<int>(layer)) {
            const vec4 texels = view.rect_ts * static_cast<float>(views.resolution);
            first = glm::min(first, glm::round(vec2(texels)));
            end = glm::max(end, glm::round(vec2(texels.x + texels.z, texels.y + texels.w)));
        }
    }
    return {ivec2(first), glm::max(ivec2(end - first), ivec2(0))};
}

/// Fragments of whole layers, or of the tiles in them alone.
RasterDesc layer_pipeline(const LayerPass& pass, const ShaderInputs& inputs, bool tiles) {
    ShaderSource fragment{ShaderKind::fragment, pass.name, pass.includes + layer_head(inputs, tiles) + pass.text};
    return tiles ? tile_quads(std::move(fragment)) : fullscreen(std::move(fragment));
}

}  // namespace

void add_layer_passes(const FrameInput& input, TextureHandle source, TextureHandle target, const LayerPass& pass) {
    const LightViews* const tiles = pass.tiles != nullptr && pass.tiles->tiles ? pass.tiles : nullptr;
    const BufferHandle quads = tiles != nullptr ? add_tile_draw(input, *tiles, tile_quad_vertices) : BufferHandle{};
    ShaderInputs inputs = tiles != nullptr ? view_list(*tiles) : ShaderInputs();
    inputs.add(pass.inputs).texels(input.device, input.graph.desc(source).format, "2DArray", "source", source);
    const Hasher key = hashed(inputs).text(pass.includes).text(pass.text).value(tiles != nullptr);
    const auto shader = made_once(input.prepared, pass.name, key.finish().low,
                                  [&] { return sealed(layer_pipeline(pass, inputs, tiles != nullptr)); });
    const std::uint32_t layers = input.graph.desc(target).layers;
    const TextureDesc& from = input.graph.desc(source);
    const ivec4 whole(0, 0, static_cast<int>(from.width), static_cast<int>(from.height));
    for (std::uint32_t layer = 0; layer < layers; ++layer) {
        const std::uint32_t map_layer = tiles != nullptr ? layer / (layers / tiles->layers) : 0;
        const bool known = pass.tiles != nullptr && tiles == nullptr;
        const ivec4 drawn = known ? drawn_texels(*pass.tiles, layer / (layers / pass.tiles->layers)) : whole;
        const LayerPush push{drawn, static_cast<std::int32_t>(map_layer), static_cast<std::int32_t>(layer)};
        input.graph.add_pass(
            pass.name,
            [&](PassBuilder& builder) {
                inputs.declare(builder);
                if (quads.valid()) {
                    builder.indirect(quads);
                }
                builder.color(target, quads.valid() || known ? Load::clear : Load::discard, {}, one_layer(layer));
            },
            [shader, inputs, push, quads, known](Recorder& r) {
                const ivec4& texels = push.drawn;
                if (known && (texels.z == 0 || texels.w == 0)) {
                    return;
                }
                r.bind(*shader);
                inputs.set(r);
                r.push_value(push);
                if (known) {
                    r.scissor(texels.x, texels.y, static_cast<uint>(texels.z), static_cast<uint>(texels.w));
                }
                quads.valid() ? r.draw_indirect(quads) : r.draw(3);
            });
    }
}

std::uint32_t drawn_mips(const GnPrefilterParams& params, std::uint32_t resolution) {
    return blurs(params.blur, params.radius) ? 1 : all_mips(params, resolution);
}

ShadowMap filtered_map(const FrameInput& input, const LightViews& views, std::string_view name, TextureHandle source,
                       const GnPrefilterParams& params) {
    const TextureHandle blurred =
        add_blur(input, views, source, params.blur, params.radius, all_mips(params, input.graph.desc(source).width));
    add_mips(input.graph, blurred);
    SamplerDesc sampler = trilinear();
    sampler.anisotropy = static_cast<float>(params.anisotropy);
    return {.offers = {{std::string(name), blurred, sampler}}};
}

bool reads_ranges(const Recipe& recipe) {
    return holds(recipe.lookup->needs, "min-max");
}

void offer_ranges(const FrameInput& input, const Recipe& recipe, TextureHandle depth, ShadowMap& map) {
    if (!reads_ranges(recipe)) {
        return;
    }
    if (input.graph.desc(depth).samples > 1) {
        refuse("lookup '{}' reads the depths beside map '{}', which have {} samples a texel; valid is {}.samples = 1",
               recipe.lookup->id, recipe.map->id, input.graph.desc(depth).samples, recipe.map->id);
    }
    map.offers.push_back({"min-max", add_min_max_pyramid(input.graph, depth), nearest()});
}

Guard blur_guard(const GnPrefilterParams& params) {
    return {.texels = params.blur == GN_BLUR_NONE ? 0.0F : static_cast<float>(params.radius)};
}

std::vector<Feature> filtering_features(bool float32) {
    return float32 ? std::vector<Feature>{Feature::float32_filter} : std::vector<Feature>{};
}

std::string refuse_samples(std::string_view parameter, int samples) {
    return samples == 1 || samples == 4 ? ""
                                        : fmt::format("{} = {} is not offered; valid are 1 and 4", parameter, samples);
}

}  // namespace gn
