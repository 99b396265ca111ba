// SPDX-License-Identifier: MIT
// Maps that live over frames: textures in a history that wrap around, of which each frame draws what is new and copies the
// window that it shows.
#include "shadow/casters/caster_draw.h"
#include "shadow/frame/history.h"
#include "shadow/receiver/sample_pass.h"

#include <array>

namespace gn {
namespace {

/// The kept counterparts of a pass's attachments.
struct KeptTextures {
    TextureHandle color, depth;
    bool fresh = false;  ///< without contents
};

KeptTextures import_kept(const FrameInput& input, const KeptViews& kept, const CasterPass& pass) {
    KeptTextures textures;
    const auto import = [&](TextureHandle like, std::string_view what, VkImageUsageFlags attachment) {
        TextureDesc desc = input.graph.desc(like);
        desc.name = fmt::format("kept {} of {} {}", what, pass.name, kept.name);
        desc.usage = attachment | VK_IMAGE_USAGE_SAMPLED_BIT;
        bool fresh = false;
        const TextureHandle handle = input.graph.import(kept.history->texture(desc, fresh));
        textures.fresh = textures.fresh || fresh;
        return handle;
    };
    textures.depth = import(pass.depth, "depth", VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    if (pass.color.valid()) {
        textures.color = import(pass.color, "color", VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    }
    return textures;
}

/// A full-screen pipeline that overwrites depth, and colour where there is one.
RasterDesc overwrite(const std::string& name, bool color, const std::string& declarations, const std::string& body) {
    const std::string text = std::string(color ? "layout(location = 0) out vec4 out_color;\n" : "") + declarations +
                             "void main() {\n" + body + "}\n";
    RasterDesc desc = fullscreen({ShaderKind::fragment, name, text});
    desc.depth_test = desc.depth_write = true;
    desc.depth_compare = VK_COMPARE_OP_ALWAYS;
    return sealed(std::move(desc));
}

RasterDesc clear_pipeline(bool color) {
    return overwrite("clear kept", color, "layout(push_constant, scalar) uniform Push { vec4 color; } push;\n",
                     std::string(color ? "    out_color = push.color;\n" : "") + "    gl_FragDepth = 1.0;\n");
}

ShaderInputs kept_inputs(const KeptTextures& textures) {
    ShaderInputs inputs;
    inputs.texture("sampler2DArray", "kept_depth", textures.depth);
    if (textures.color.valid()) {
        inputs.texture("sampler2DArray", "kept_color", textures.color);
    }
    return inputs;
}

RasterDesc unwrap_pipeline(bool color) {
    const std::string texel = "ivec3((ivec2(gl_FragCoord.xy) + push.shift) % push.size, push.layer), 0)";
    const std::string push = "layout(push_constant, scalar) uniform Push { ivec2 shift; int size; int layer; } push;\n";
    return overwrite("unwrap kept", color, kept_inputs({.color = {color ? 0U : ~0U}}).text() + push,
                     std::string(color ? "    out_color = texelFetch(kept_color, " + texel + ";\n" : "") +
                         "    gl_FragDepth = texelFetch(kept_depth, " + texel + ".r;\n");
}

/// Both, without a colour and with one, composed once.
const RasterDesc& clear_shader(bool color) {
    static const std::array<RasterDesc, 2> shaders{clear_pipeline(false), clear_pipeline(true)};
    return shaders[color ? 1 : 0];
}
const RasterDesc& unwrap_shader(bool color) {
    static const std::array<RasterDesc, 2> shaders{unwrap_pipeline(false), unwrap_pipeline(true)};
    return shaders[color ? 1 : 0];
}

/// Draws rectangles of one kept layer anew. The pass is there in every frame, so that all frames have one plan.
void add_draws(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass,
               const KeptTextures& textures, std::uint32_t layer, const std::vector<KeptDraw>& draws) {
    LightViews tiles = views;
    tiles.layered = false;
    tiles.kept.reset();
    tiles.views.clear();
    tiles.casters.clear();
    for (const KeptDraw& draw : draws) {
        tiles.views.push_back(draw.view);
        tiles.casters.push_back(draw.casters);
    }
    const CasterDraw drawn{caster_job(input, recipe, std::move(tiles), pass)};
    input.graph.add_pass(
        pass.name,
        [&](PassBuilder& builder) {
            if (textures.color.valid()) {
                builder.color(textures.color, Load::keep, {}, one_layer(layer));
            }
            builder.depth(textures.depth, Load::keep, {}, one_layer(layer));
            drawn.declare(builder);
        },
        [drawn, draws](Recorder& r) {
            CasterDraw tile = drawn;
            for (tile.view = 0; tile.view < draws.size(); ++tile.view) {
                const ivec4 rect = draws[tile.view].rect;
                r.scissor(rect.x, rect.y, static_cast<std::uint32_t>(rect.z), static_cast<std::uint32_t>(rect.w));
                r.bind(clear_shader(tile.job->pass.color.valid()));
                r.push_value(tile.job->pass.clear_color.color);
                r.draw(3);
                tile.record(r);
            }
        });
}

struct UnwrapPush {
    ivec2 shift;
    int size, layer;
};

/// Copies the window of one layer out of the kept textures.
void add_unwrap(const FrameInput& input, const LightViews& views, const CasterPass& pass, const KeptTextures& textures,
                std::uint32_t layer, ivec2 shift) {
    const ShaderInputs inputs = kept_inputs(textures);
    const UnwrapPush push{shift, static_cast<int>(views.resolution), static_cast<int>(layer)};
    input.graph.add_pass(
        pass.name + " unwrap",
        [&](PassBuilder& builder) {
            if (pass.color.valid()) {
                builder.color(pass.color, Load::discard, {}, one_layer(layer));
            }
            builder.depth(pass.depth, Load::discard, {}, one_layer(layer));
            inputs.declare(builder);
        },
        [push, inputs, color = pass.color.valid()](Recorder& r) {
            r.bind(unwrap_shader(color));
            inputs.set(r);
            r.push_value(push);
            r.draw(3);
        });
}

}  // namespace

bool can_keep(const FrameInput& input, const LightViews& views, const CasterPass& pass) {
    const auto simple = [&](TextureHandle texture) {
        const TextureDesc& desc = input.graph.desc(texture);
        return desc.samples == 1 && desc.mips == 1 && desc.width == views.resolution && desc.layers == views.layers;
    };
    return views.kept.has_value() && !views.tiles && simple(pass.depth) && (!pass.color.valid() || simple(pass.color));
}

void add_kept_passes(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass) {
    const KeptViews& kept = *views.kept;
    const KeptTextures textures = import_kept(input, kept, pass);
    for (std::size_t i = 0; i < kept.layers.size(); ++i) {
        const std::vector<KeptDraw>& draws = textures.fresh ? kept.layers[i].whole : kept.layers[i].revealed;
        add_draws(input, recipe, views, pass, textures, static_cast<std::uint32_t>(i), draws);
    }
    for (std::size_t i = 0; i < kept.layers.size(); ++i) {
        add_unwrap(input, views, pass, textures, static_cast<std::uint32_t>(i), kept.layers[i].shift);
    }
}

}  // namespace gn
