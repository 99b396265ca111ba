// SPDX-License-Identifier: MIT
// A soft disc under each caster, as large as its bounds.
//
// Based on: Akenine-Moller et al. Real-Time Rendering, 4th edition, chapter 7. 2018. [AHH18]
// Departs from it: discs lie across the light's rays and keep the area of the bounds' shadow, so that they follow the light.
#include "shadow/direct/blob/blob.glsl"

#include "shadow/frame/frame.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn::parts::blob {
namespace {

constexpr const char* text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(visibility)))) {
        return;
    }
    vec4 p_ws = gbuffer_position_texel(pixel);
    bool counted = p_ws.w > 0.5 && gn_counted(u.light, p_ws.xyz, gbuffer_normal_texel(pixel).xyz);
    // Discs multiply, as they are painted over each other.
    float v = u.first != 0 ? (counted ? 1.0 : 0.0) : imageLoad(visibility, pixel).r;
    for (int i = 0; counted && i < u.count; ++i) {
        v *= 1.0 - gn_blob_hidden(blobs[i], p_ws.xyz, u.params);
    }
    imageStore(visibility, pixel, vec4(v));
}
)";

/// The disc of each object that casts; a lamp within its bounds has none.
std::vector<GnBlob> blobs_of(const FrameInput& input, vec4 light_ws) {
    std::vector<GnBlob> blobs;
    const std::vector<CasterKind> kinds = caster_kinds(input);
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const Box& box_ws = input.scene.objects[i].bounds_ws;
        if (kinds[i] == CasterKind::absent || box_ws.empty() ||
            (light_ws.w > 0.0F && box_ws.contains(vec3(light_ws)))) {
            continue;
        }
        const vec3 way_ws = box_ws.centre() * light_ws.w - vec3(light_ws);
        const float to_centre = glm::length(way_ws);
        if (!(to_centre > 0.0F)) {
            continue;
        }
        const vec3 axis_ws = way_ws / to_centre;
        // The disc grows with the distance from a lamp.
        blobs.push_back({vec4(box_ws.centre(), glsl::gn_blob_radius(box_ws.min, box_ws.max, axis_ws)),
                         vec4(axis_ws, light_ws.w / to_centre), vec4(box_ws.min, 1), vec4(box_ws.max, 1)});
    }
    return blobs;
}

Visibility add_blobs(const FrameInput& input, const Recipe& recipe) {
    const vec4 light_ws = light_point_ws(input.light().shape);
    std::vector<GnBlob> blobs = blobs_of(input, light_ws);
    // A uniform block of this many fits every device, and what is uniform is read once for many pixels.
    constexpr std::size_t most = 16384 / sizeof(GnBlob) - 1;
    const int count = static_cast<int>(blobs.size());
    blobs.resize(std::max<std::size_t>((blobs.size() + most - 1) / most, 1) * most);
    Visibility result{create_visibility(input.graph, input.samples)};
    for (std::size_t first = 0; first < blobs.size(); first += most) {
        ShaderInputs inputs;
        add_gbuffer(inputs, input.device, input.samples);
        inputs.image("r32f", "", "image2D", "visibility", result.image)
            .block("uniform", "Blobs", fmt::format("GnBlob blobs[{}];", most),
                   std::as_bytes(std::span(blobs).subspan(first, most)))
            .constant("GnLight", "light", input.whole_light().shape)
            .constant("GnBlobParams", "params", recipe.of<GnBlobParams>("blob"))
            .constant("int", "first", first == 0 ? 1 : 0)
            .constant("int", "count", std::min(count - static_cast<int>(first), static_cast<int>(most)));
        const auto shader = compute_once(input.prepared, "blob.comp", hashed(inputs), [&] {
            return include_line("shadow/scene/light.h") + include_line("shadow/direct/blob/blob.glsl") + inputs.text() +
                   text;
        });
        add_pixel_pass(input.graph, "blob", inputs, shader, input.samples.width, input.samples.height);
    }
    return result;
}

}  // namespace
}  // namespace gn::parts::blob

namespace gn::parts {

const Part& direct_blob() {
    using namespace blob;
    static const Part part = [] {
        Part p;
        p.id = "blob";
        p.stage = Stage::direct;
        p.title = "Blob shadows";
        p.citation = "AHH18";
        p.needs_scene = true;
        p.params = param_table<GnBlobParams>({
            GN_PARAM(GnBlobParams, softness, real, 0, 1, "of the radius",
                     "Wider ramps at the rims of discs; what a disc hides in all stays."),
            GN_PARAM(GnBlobParams, size, real, 0.01, 10, "",
                     "Larger discs; 1 has the area of the shadow of the caster's bounds."),
            GN_PARAM(GnBlobParams, opacity, real, 0, 1, "", "Darker discs."),
        });
        p.params_type = "GnBlobParams";
        p.glsl = "shadow/direct/blob/blob.glsl";
        p.add_direct = add_blobs;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
