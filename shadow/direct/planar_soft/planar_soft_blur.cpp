// SPDX-License-Identifier: MIT
// Based on: Akenine-Moller et al. Real-Time Rendering, 4th edition, section 7.1.2. 2018. [AHH18]
// Drop shadows: the hard shadow in a picture of the plane, blurred by one width.
#include "shadow/direct/planar_soft/planar_soft.glsl"

#include "base/disc.h"
#include "shadow/direct/planar_soft/planar_soft_passes.h"
#include "shadow/frame/frame.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"
#include "shadow/scene/clusters.h"

#include <cmath>

namespace gn {
namespace {

constexpr const char* blur_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec3 texel = ivec3(gl_GlobalInvocationID);
    int size = imageSize(blurred).x;
    if (any(greaterThanEqual(texel.xy, ivec2(size)))) {
        return;
    }
    float width = dot(widths[texel.z], vec2(u.along));
    int reach = gn_planar_soft_reach(width);
    float sum = 0.0;
    for (int i = -reach; i <= reach; ++i) {
        ivec2 at = clamp(texel.xy + i * u.along, ivec2(0), ivec2(size - 1));
        sum += gn_planar_soft_weight(i, width) * sharp_texel(ivec3(at, texel.z)).r;
    }
    imageStore(blurred, texel, vec4(sum));
}
)";

constexpr const char* resolve_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
float hidden_at(vec2 uv_ts, int layer) {
    int size = blurred_size().x;
    vec2 at = uv_ts * float(size) - 0.5;
    ivec2 low = ivec2(floor(at));
    vec2 w = at - vec2(low);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        ivec2 texel = clamp(low + step, ivec2(0), ivec2(size - 1));
        vec2 share = mix(1.0 - w, w, vec2(step));
        sum += share.x * share.y * blurred_texel(ivec3(texel, layer)).r;
    }
    return sum;
}
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(visibility)))) {
        return;
    }
    vec4 p_ws = gbuffer_position_texel(pixel);
    vec3 n_ws = gbuffer_normal_texel(pixel).xyz;
    bool counted = p_ws.w > 0.5 && gn_counted(u.light, p_ws.xyz, n_ws);
    float v = counted ? 1.0 : 0.0;
    for (int i = 0; counted && i < u.count; ++i) {
        if (gn_on_plane(pictures[i].plane_ws, u.tolerance, p_ws.xyz, n_ws)) {
            vec4 p = vec4(p_ws.xyz, 1.0);
            vec2 uv_ts = vec2(dot(pictures[i].u_from_ws, p), dot(pictures[i].v_from_ws, p));
            v = clamp(1.0 - hidden_at(uv_ts, i), 0.0, 1.0);  // the weights add up to one but for rounding
        }
    }
    imageStore(visibility, pixel, vec4(v));
}
)";

/// A plane's picture, as it is drawn and as it is read.
struct Picture {
    GnFlattening flattening;
    GnPlanarSoftPicture read;
    vec2 width{0};  ///< of the blur, texels
};

/// The light's widths along two axes of the plane, metres at a distance of one metre or altogether, as boxes of the same
/// variance: a disc of radius r has r^2 / 4 along an axis, a box of width w has w^2 / 12.
vec2 light_size(const GnLight& light) {
    const float box = std::sqrt(3.0F);
    switch (light.kind) {
        case GN_LIGHT_RECTANGLE: return 2.0F * light.half_size;
        case GN_LIGHT_DIRECTIONAL: return vec2(box * std::tan(light.angular_radius));
        default: return vec2(box * light.radius);
    }
}

/// Metres that the blur is wide along both axes: right for casters of this height.
vec2 blur_width(const GnLight& light, const GnFlattening& plane, float caster_height) {
    const float light_height = gn_plane_height(plane.plane_ws, plane.light_ws);
    if (light.kind == GN_LIGHT_DIRECTIONAL) {
        return light_size(light) *
               (caster_height / light_height);  // on the way to the sun, which climbs so much a metre
    }
    const float below = std::min(caster_height, 0.9F * light_height);
    return {glsl::gn_planar_soft_width(light_size(light).x, light_height, below),
            glsl::gn_planar_soft_width(light_size(light).y, light_height, below)};
}

/// The highest corner of what casts, over the plane and under the light.
float top_of(const Box& box_ws, const GnFlattening& plane) {
    float top = 0;
    for (const vec3 corner : box_ws.corners()) {
        top = std::max(top, gn_plane_height(plane.plane_ws, vec4(corner, 1)));
    }
    return plane.light_ws.w > 0.0F ? std::min(top, gn_plane_height(plane.plane_ws, plane.light_ws)) : top;
}

/// Two unit axes of the plane, u to the right and v down as the light sees it, u along a rectangle's own.
void plane_axes(const GnLight& light, vec3 n_ws, vec3& u_ws, vec3& v_ws) {
    complete_frame(n_ws, u_ws, v_ws);
    const vec3 along = vec3(light.right_ws) - n_ws * glm::dot(n_ws, vec3(light.right_ws));
    if (light.kind == GN_LIGHT_RECTANGLE && glm::length(along) > 0.01F) {
        u_ws = glm::normalize(along);
    }
    v_ws = glm::cross(u_ws, n_ws);
}

/// Of what is seen of the plane; unset where nothing is.
std::optional<Picture> picture_of(const FrameInput& input, const GnFlattening& plane,
                                  const GnPlanarSoftParams& params) {
    const GnLight& light = input.light().shape;
    const vec3 n_ws(plane.plane_ws);
    const dvec3 n(n_ws);
    const auto offset = static_cast<double>(plane.plane_ws.w), thickness = static_cast<double>(plane.tolerance);
    const ConvexBody seen = clip(clip(potential_receivers(input), {n, offset + thickness}), {-n, thickness - offset});
    if (seen.empty()) {
        return {};
    }
    vec3 u_ws;
    vec3 v_ws;
    plane_axes(light, n_ws, u_ws, v_ws);
    dvec2 low(1e300);
    dvec2 high(-1e300);
    for (const dvec3& p_ws : seen.vertices()) {
        const dvec2 at(glm::dot(dvec3(u_ws), p_ws), glm::dot(dvec3(v_ws), p_ws));
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    // What is blurred into the picture from beyond it is in the picture too.
    const vec2 width = blur_width(light, plane, params.height * top_of(largest_cluster(input.scene), plane));
    const dvec2 margin(0.5 * dvec2(width) + 1e-3 * (high - low) + thickness);
    low -= margin;
    high += margin;
    const vec2 size(high - low);
    const vec4 u(u_ws / size.x, -static_cast<float>(low.x) / size.x);
    const vec4 v(v_ws / size.y, -static_cast<float>(low.y) / size.y);
    Picture picture{plane, {plane.plane_ws, u, v}, static_cast<float>(params.texels) * width / size};
    const vec4 w(0, 0, 0, 1);
    picture.flattening.cs_from_ws = glm::transpose(mat4(2.0F * u - w, 2.0F * v - w, 0.5F * w, w));
    return picture;
}

void add_picture_passes(const FrameInput& input, const std::vector<Picture>& pictures, TextureHandle image) {
    const FlatCasters casters(input, {.fragment = "    result = 1.0;\n", .stencil = false});
    for (std::uint32_t i = 0; i < pictures.size(); ++i) {
        input.graph.add_pass(
            "planar-soft: picture",
            [&](PassBuilder& pass) {
                pass.color(image, Load::clear, {}, one_layer(i));
                casters.declare(pass);
            },
            [casters, inputs = casters.inputs(pictures[i].flattening, {})](Recorder& r) {
                casters.record(r, inputs, 0);
            });
    }
}

TextureHandle add_blur(const FrameInput& input, std::span<const vec2> widths, TextureHandle sharp, ivec2 along) {
    const TextureDesc desc = input.graph.desc(sharp);
    const TextureHandle blurred = input.graph.create(desc);
    ShaderInputs inputs;
    inputs.texels(input.device, VK_FORMAT_R32_SFLOAT, "2DArray", "sharp", sharp)
        .image("r32f", "writeonly", "image2DArray", "blurred", blurred)
        .block("readonly buffer", "Widths", "vec2 widths[];", std::as_bytes(widths))
        .constant("ivec2", "along", along);
    const auto shader = compute_once(input.prepared, "planar-soft-blur.comp", hashed(inputs), [&] {
        return include_line("shadow/direct/planar_soft/planar_soft.glsl") + inputs.text() + blur_text;
    });
    input.graph.add_pass(
        "planar-soft: blur", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, desc](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch((desc.width + 7) / 8, (desc.height + 7) / 8, desc.layers);
        });
    return blurred;
}

}  // namespace

Visibility add_blurred(const FrameInput& input, const ReceiverPlanes& found, const GnPlanarSoftParams& params) {
    std::vector<Picture> pictures;
    for (const GnFlattening& plane : lit_planes({}, found, light_point_ws(input.light().shape)).planes) {
        if (const std::optional<Picture> picture = picture_of(input, plane, params)) {
            pictures.push_back(*picture);
        }
    }
    const int count = static_cast<int>(pictures.size());
    pictures.resize(std::max<std::size_t>(pictures.size(), 1));
    std::vector<vec2> widths;
    std::vector<GnPlanarSoftPicture> read;
    for (const Picture& picture : pictures) {
        widths.push_back(picture.width);
        read.push_back(picture.read);
    }

    // Draw the shadows of the light's centre into pictures of the planes, and blur them along both axes.
    const TextureHandle sharp = input.graph.create(TextureDesc{.name = "planar-soft pictures",
                                                               .format = VK_FORMAT_R32_SFLOAT,
                                                               .width = static_cast<std::uint32_t>(params.texels),
                                                               .height = static_cast<std::uint32_t>(params.texels),
                                                               .layers = static_cast<std::uint32_t>(pictures.size())});
    add_picture_passes(input, pictures, sharp);
    const TextureHandle blurred = add_blur(input, widths, add_blur(input, widths, sharp, ivec2(1, 0)), ivec2(0, 1));

    // Look each sample up in its plane's picture.
    Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    inputs.texels(input.device, VK_FORMAT_R32_SFLOAT, "2DArray", "blurred", blurred)
        .image("r32f", "writeonly", "image2D", "visibility", result.image)
        .block("readonly buffer", "Pictures", "GnPlanarSoftPicture pictures[];", std::as_bytes(std::span(read)))
        .constant("GnLight", "light", input.whole_light().shape)
        .constant("float", "tolerance", found.tolerance)
        .constant("int", "count", count);
    const auto shader = compute_once(input.prepared, "planar-soft-resolve.comp", hashed(inputs), [&] {
        return include_line("shadow/geometry/flattened.glsl") + include_line("shadow/scene/light.h") +
               include_line("shadow/direct/planar_soft/planar_soft.h") + inputs.text() + resolve_text;
    });
    add_pixel_pass(input.graph, "planar-soft: resolve", inputs, shader, input.samples.width, input.samples.height);
    return result;
}

}  // namespace gn
