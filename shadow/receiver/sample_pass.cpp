// SPDX-License-Identifier: MIT
#include "shadow/receiver/sample_pass.h"

#include "shadow/geometry/potential_receivers.h"
#include "shadow/receiver/known.h"
#include "shadow/receiver/parallel_views.h"
#include "shadow/recipe/guard.h"

#include <algorithm>

namespace gn {
namespace {

constexpr const char* read_text = R"(
bool read_sample(ivec2 pixel, out GnReceiver receiver) {
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    if (position.w < 0.5 || !gn_counted(known_whole(), position.xyz, normal.xyz)) {
        return false;
    }
    receiver = gn_receiver(u.view, pixel, position, normal);
    return true;
}
)";

bool as_uniform(const LightViews& views) {
    // Uniform blocks of this many views fit every device; what is uniform is read once for many pixels.
    constexpr std::size_t most_uniform = 16384 / sizeof(GnLightView);
    return views.views.size() <= most_uniform;
}

void add_view_block(ShaderInputs& inputs, const LightViews& views, std::string_view kind, std::string_view members) {
    if (views.buffer.valid()) {
        inputs.buffer(kind, "Views", members, views.buffer);
    } else {
        inputs.block(kind, "Views", members, std::as_bytes(std::span(views.views)));
    }
}

std::string lent_name(std::string_view name) {
    return "placement_" + identifier(name);
}

/// What the placement's choice is given.
void add_placement_data(ShaderInputs& inputs, const LightViews& views) {
    const std::string member = fmt::format("{} placement;", views.part->data_type);
    if (views.data_buffer.valid()) {
        inputs.buffer("uniform", "Placement", member, views.data_buffer);
    } else {
        inputs.block("uniform", "Placement", member, views.data);
    }
}

/// What the placement offers, and its tables.
void add_lent(ShaderInputs& inputs, const LightViews& views) {
    for (const Offer& offer : views.offers) {
        inputs.texture("sampler2DArray", lent_name(offer.name), offer.texture, offer.sampler);
    }
    for (const PlacementTable& table : views.tables) {
        const std::string block = "Placement_" + identifier(table.name);
        const std::string members = fmt::format("{} {}[];", table.type, lent_name(table.name));
        if (table.buffer.valid()) {
            inputs.buffer("readonly buffer", block, members, table.buffer);
        } else {
            inputs.block("readonly buffer", block, members, table.bytes);
        }
    }
}

}  // namespace

std::string include_line(std::string_view path) {
    return path.empty() ? "" : fmt::format("#include \"{}\"\n", path);
}

std::string receiver_defines(const Recipe& recipe, const LightViews& views) {
    return fmt::format("#define GN_BIAS_CONE {:d}\n#define GN_BIAS_PLANE {}\n#define GN_VIEW_KIND {}\n",
                       recipe.bias.cone > 0, recipe.bias.receiver_plane != 0, static_cast<int>(views.kind)) +
           (as_uniform(views) ? fmt::format("#define GN_VIEW_COUNT {}\n", views.views.size()) : "");
}

GnBias applied_bias(const Recipe& recipe, const Light& light, const Box& bounds_ws) {
    // A guard holds two texels beyond the kernel: the receiver's own, and the one that a tap falls into.
    const Guard guard = guard_of(recipe, light, bounds_ws);
    GnBias bias = recipe.bias;
    bias.reach = std::max(0.0F, guard.texels - 2);
    bias.reach_world = guard.metres;
    bias.reach_pixels = guard.pixels;
    return bias;
}

GnBias applied_bias(const FrameInput& input, const Recipe& recipe) {
    return applied_bias(recipe, input.light(), main_bounds(input));
}

void add_views(ShaderInputs& inputs, const LightViews& views) {
    add_view_block(inputs, views, as_uniform(views) ? "uniform" : "readonly buffer",
                   as_uniform(views) ? "GnLightView views[GN_VIEW_COUNT];" : "GnLightView views[];");
}

ShaderInputs view_list(const LightViews& views) {
    ShaderInputs inputs;
    add_view_block(inputs, views, "readonly buffer", "GnLightView views[];");
    return inputs;
}

namespace {

/// The views; for software also what it takes one by where all look one way (known_text), in the same block: Mesa 22.3.6 crashes
/// where five blocks are read, and choices depend on the last.
void add_known_views(ShaderInputs& inputs, const Device& device, const LightViews& views) {
    const auto parallel = device.info().cpu ? parallel_views(views) : std::nullopt;
    if (!parallel) {
        add_views(inputs, views);
        return;
    }
    std::vector<std::byte> bytes;
    const auto put = [&](auto list) {
        const auto more = std::as_bytes(std::span(list));
        bytes.insert(bytes.end(), more.begin(), more.end());
    };
    put(views.views);
    put(std::array{parallel->axes});
    put(parallel->places);
    inputs.block("uniform", "Views",
                 "GnLightView views[GN_VIEW_COUNT]; GnViewAxes view_axes; GnViewPlace view_places[GN_VIEW_COUNT];",
                 bytes);
}

}  // namespace

ShaderInputs sample_inputs(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    add_known_views(inputs, input.device, views);
    add_placement_data(inputs, views);
    add_lent(inputs, views);
    inputs.constant("GnViewConstants", "view", input.samples.constants);
    inputs.constant("GnLight", "light", input.light().shape);
    inputs.constant("GnLight", "whole", input.whole_light().shape);
    inputs.constant("GnBias", "bias", applied_bias(input, recipe));
    return inputs;
}

std::string choose_call(const LightViews& views) {
    std::string call = fmt::format("gn_{}_choose(receiver, placement", identifier(views.part->id));
    for (const Offer& offer : views.offers) {
        call += ", " + lent_name(offer.name);
    }
    return call + ")";
}

std::string placement_text(const Part& placement, const Recipe& recipe) {
    return (placement.prologue != nullptr ? placement.prologue(recipe) : "") + include_line(placement.glsl);
}

std::string sample_functions(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    std::string text = known_text(input, recipe, views);
    text += fmt::format("#define GN_CHOOSE(receiver, placement) {}\n", choose_call(views));
    for (const PlacementTable& table : views.tables) {
        text += fmt::format("{} gn_{}_{}(int i) {{ return {}[i]; }}\n", table.type, identifier(views.part->id),
                            identifier(table.name), lent_name(table.name));
    }
    return text + read_text;
}

void add_gbuffer(ShaderInputs& inputs, const Device& device, const ViewSamples& samples) {
    inputs.texels(device, VK_FORMAT_R32G32B32A32_SFLOAT, "2D", "gbuffer_position", samples.position);
    inputs.texels(device, VK_FORMAT_R32G32B32A32_SFLOAT, "2D", "gbuffer_normal", samples.normal);
}

TextureHandle lent(TextureHandle texture, std::string_view what) {
    if (!texture.valid()) {
        refuse(
            "the recipe reads the {} of the receivers, and the host lends none; positions and normals alone serve "
            "other recipes",
            what);
    }
    return texture;
}

ivec4 lit_pixels(const FrameInput& input) {
    const ivec2 size(static_cast<int>(input.samples.width), static_cast<int>(input.samples.height));
    if (input.whole_light().shape.kind == GN_LIGHT_DIRECTIONAL) {
        return {0, 0, size.x, size.y};
    }
    dvec2 low(1e300);
    dvec2 high(-1e300);
    for (const dvec3& p_ws : potential_receivers(input).vertices()) {
        const dvec4 p_cs = dmat4(input.samples.constants.cs_from_ws) * dvec4(p_ws, 1);
        if (p_cs.w <= 0) {
            return {0, 0, size.x, size.y};
        }
        const dvec2 p_ss = (dvec2(p_cs) / p_cs.w * 0.5 + 0.5) * dvec2(size);
        low = glm::min(low, p_ss);
        high = glm::max(high, p_ss);
    }
    // A pixel more on every side covers the rounding of both ways to the picture.
    const ivec2 first(glm::clamp(glm::floor(low) - 1.0, dvec2(0), dvec2(size)));
    const ivec2 last(glm::clamp(glm::ceil(high) + 1.0, dvec2(0), dvec2(size)));
    return {first, glm::max(last - first, ivec2(0))};
}

}  // namespace gn
