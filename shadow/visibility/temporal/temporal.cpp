// SPDX-License-Identifier: MIT
// Shadows gathered over frames: what the frame before knew of a sample, found again, and what this one adds, each by how near the
// map was sampled. What frames have not seen, or what moved casters may have changed, begins anew.
//
// Based on: Scherzer, Jeschke, Wimmer. Pixel-Correct Shadow Maps with Temporal Reprojection and Shadow Test Confidence. EGSR
// 2007. [SJW07]
// Departs from it: weights are summed, so that a still view has the mean of all frames; and samples between moved casters and the
// light begin anew, where the paper lets old shadows fade.
#include "shadow/visibility/temporal/temporal.h"

#include "shadow/casters/moved.h"
#include "shadow/frame/frame.h"
#include "shadow/frame/history.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/reprojection.h"
#include "shadow/receiver/sample_pass.h"

#include <array>

namespace gn::parts::temporal {
namespace {

constexpr std::size_t most_boxes = 64;

// Texels of the frame before around where it saw the sample, those alone that show the same surface. RGBA: V and the weight of
// the frames that it is the mean of; nothing where none does.
constexpr const char* before_text = R"(
bool same_surface(GnReceiver receiver, float pixel_ws, vec4 position, vec4 normal) {
    vec3 d_ws = position.xyz - receiver.p_ws;
    float steps = length(receiver.ddx_ws) + length(receiver.ddy_ws);
    return position.w > 0.5 && dot(normal.xyz, receiver.n_ws) > 0.9 && abs(dot(receiver.n_ws, d_ws)) < pixel_ws &&
           length(d_ws) < 1.5 * steps;
}

vec4 gathered_before(GnReceiver receiver, float pixel_ws) {
    vec3 place = gn_reproject(u.before_cs_from_ws, mat4(1.0), receiver.p_ws);
    ivec2 size = ivec2(u.view.size.xy);
    vec2 at = place.xy * vec2(size) - 0.5;
    // A view that stands still finds its own pixel, to the bit.
    at = mix(at, round(at), lessThan(abs(at - round(at)), vec2(1.0 / 64.0)));
    ivec2 first = ivec2(floor(at));
    vec2 part = at - vec2(first);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 4 && place.z > 0.0; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        ivec2 texel = first + step;
        vec2 shares = mix(1.0 - part, part, vec2(step));
        float share = shares.x * shares.y;
        if (share <= 0.0 || any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) {
            continue;
        }
        vec4 known = texelFetch(gathered, texel, 0);
        if (known.a > 0.0 && same_surface(receiver, pixel_ws, texelFetch(position_before, texel, 0), texelFetch(normal_before, texel, 0))) {
            sum += share * known;
            total += share;
        }
    }
    return total > 0.0 ? sum / total : vec4(0.0);
}

bool begins_anew(vec3 p_ws, float reach_ws) {
    for (int i = 0; i < u.boxes; ++i) {
        if (gn_temporal_touches(u.light, p_ws, touched[2 * i].xyz, touched[2 * i + 1].xyz, reach_ws)) {
            return true;
        }
    }
    return u.anew != 0;
}
)";

constexpr const char* main_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    GN_V v = GN_V_OF(texelFetch(seen, pixel, 0));
    float confidence = texelFetch(confidences, pixel, 0).r;
    float sum = 0.0;
    if (position.w > 0.5 && confidence > 0.0) {
        float weight = gn_temporal_weight(confidence, u.params);
        vec4 known = vec4(0.0);
#if GN_BEFORE
        GnReceiver receiver = gn_receiver(u.view, pixel, position, normal);
        float pixel_ws = gn_pixel_growth(u.view, normal.w) * length(u.view.right_ws.xyz);
        if (!begins_anew(receiver.p_ws, texelFetch(reaches, pixel, 0).r)) {
            known = gathered_before(receiver, pixel_ws);
        }
#endif
        if (known.a > 0.0) {
            v = mix(GN_V_OF(known), v, gn_temporal_share(known.a, weight));
        }
        sum = gn_temporal_sum(known.a, weight, u.params);
    }
    imageStore(visibility, pixel, GN_V_TEXEL(v));
    imageStore(kept, pixel, vec4(vec3(v), sum));
}
)";

/// What a frame leaves of itself beside its texture.
struct Gathered {
    std::uint64_t version = 0;  ///< of the geometry
    GnLight shape;
};

/// Where casters were and are that moved since; unset where everything begins anew.
std::optional<std::vector<Box>> touched_since(const FrameInput& input, const Gathered* before) {
    if (before == nullptr || !same_shape(before->shape, shadow_shape(input.light()))) {
        return {};
    }
    // More than the shader is given become one around all.
    return moved_since(input.handles, before->version, most_boxes);
}

/// What the frame before left, where it did.
struct Before {
    TextureHandle gathered;
    mat4 cs_from_ws{1};
    SamplesBefore samples;
};

std::optional<Before> before_of(const FrameInput& input, const History::Pair& pair) {
    const std::optional<SamplesBefore> samples = samples_before(input);
    const std::optional<Reprojection> way = reprojection(input);
    if (pair.before == nullptr || !samples || !way) {
        return {};
    }
    return Before{input.graph.import(*pair.before), way->before_cs_from_ws, *samples};
}

void add_before(ShaderInputs& inputs, const FrameInput& input, const Before& before, const Offer& reach,
                const std::optional<std::vector<Box>>& touched) {
    std::array<vec4, 2 * most_boxes> corners_ws{};
    for (std::size_t i = 0; touched && i < touched->size(); ++i) {
        corners_ws.at(2 * i) = vec4((*touched)[i].min, 0);
        corners_ws.at(2 * i + 1) = vec4((*touched)[i].max, 0);
    }
    inputs.texture("sampler2D", "gathered", before.gathered);
    inputs.texture("sampler2D", "position_before", before.samples.position);
    inputs.texture("sampler2D", "normal_before", before.samples.normal);
    inputs.texture("sampler2D", "reaches", reach.texture);
    inputs.block("uniform", "Touched", fmt::format("vec4 touched[{}];", corners_ws.size()),
                 std::as_bytes(std::span(corners_ws)));
    inputs.constant("mat4", "before_cs_from_ws", before.cs_from_ws)
        .constant("GnLight", "light", input.light().shape)
        .constant("int", "boxes", touched ? static_cast<int>(touched->size()) : 0)
        .constant("int", "anew", touched ? 0 : 1);
}

Visibility add_temporal(const FrameInput& input, const Recipe& recipe, const Visibility& v) {
    if (input.history == nullptr) {
        return {v.image};  // a single frame has nothing to gather
    }
    const ViewSamples& samples = input.samples;
    const std::string name = fmt::format("shadow of light {} {}", input.light_id, recipe.name);
    const std::optional<std::vector<Box>> touched = touched_since(input, input.history->before<Gathered>(name));
    input.history->leave(name, Gathered{input.handles.version, shadow_shape(input.light())});
    const History::Pair pair = input.history->pair({.name = name,
                                                    .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                    .width = samples.width,
                                                    .height = samples.height,
                                                    .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT});
    const std::optional<Before> before = before_of(input, pair);

    const uint channels = channels_of(input.graph, v.image);
    const TextureHandle gathered = create_visibility(input.graph, samples, channels);
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, samples);
    inputs.texture("sampler2D", "seen", v.image);
    inputs.texture("sampler2D", "confidences", v.find("confidence")->texture);
    inputs.image(image_format(visibility_format(channels)), "writeonly", "image2D", "visibility", gathered);
    inputs.image("rgba32f", "writeonly", "image2D", "kept", input.graph.import(*pair.now));
    inputs.constant("GnViewConstants", "view", samples.constants)
        .constant("GnTemporalParams", "params", recipe.of<GnTemporalParams>("temporal"));
    if (before) {
        add_before(inputs, input, *before, *v.find("kernel-reach"), touched);
    }
    const auto shader = compute_once(input.prepared, "temporal", hashed(inputs).value(channels), [&] {
        return channels_text(channels) + fmt::format("#define GN_BEFORE {:d}\n", before.has_value()) +
               include_line("shadow/view/view.glsl") + include_line("shadow/receiver/reprojection.glsl") +
               include_line("shadow/visibility/temporal/temporal.glsl") + inputs.text() + (before ? before_text : "") +
               main_text;
    });
    add_pixel_pass(input.graph, "temporal", inputs, shader, samples.width, samples.height);
    return {gathered};
}

}  // namespace
}  // namespace gn::parts::temporal

namespace gn::parts {

const Part& visibility_temporal() {
    using namespace temporal;
    static const Part part = [] {
        Part p;
        p.id = "temporal";
        p.stage = Stage::visibility;
        p.title = "Shadows gathered over frames";
        p.citation = "SJW07";
        p.needs = {"confidence", "kernel-reach"};
        p.params = param_table<GnTemporalParams>({
            GN_PARAM(
                GnTemporalParams, exponent, real, 0, 64, "",
                "Power of the confidence that a frame weighs: at 0 all weigh alike and edges blur over a texel; the "
                "higher, the fewer frames decide and the sharper they are."),
            GN_PARAM(
                GnTemporalParams, memory, real, 0, 1000, "frames",
                "How many frames that are certain are remembered at most: more makes still views smoother, and what "
                "reprojection blurs stays longer."),
        });
        p.params_type = "GnTemporalParams";
        p.glsl = "shadow/visibility/temporal/temporal.glsl";
        p.add_visibility = add_temporal;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
