// SPDX-License-Identifier: MIT
// Based on: Guennebaud, Barthe, Paulin. High-Quality Adaptive Soft Shadow Mapping. Computer Graphics Forum 2007. [GBP07]
// Departs from it: samples are taken together lattice by lattice, coarse ones first, so that what is looked up lies side by side;
// the coarsest is complete, so that nothing must be pulled up before it is pushed down, and nothing is pushed over borders of
// surfaces.
#include "shadow/lookup/backprojection/sparse.h"

#include "shadow/frame/frame.h"
#include "shadow/frame/seen_by.h"
#include "shadow/lookup/backprojection/backprojection.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/expect.h"
#include "shadow/receiver/sample_pass.h"

namespace gn {
namespace {

// The samples of a lattice, `stride` pixels apart: which of them are new in it, and what lies around them in the coarser one.
constexpr const char* head_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Push { int stride; int coarsest; };
bool counts(vec4 position, vec4 normal) { return position.w > 0.5 && gn_counted(u.whole, position.xyz, normal.xyz); }
bool is_new(ivec2 place) { return coarsest != 0 || any(equal(place & 1, ivec2(1))); }

// Parent i of four, of which two or four are different.
ivec2 parent(ivec2 place, int i) {
    ivec2 odd = place & 1;
    return (place - odd + 2 * odd * ivec2(i & 1, i >> 1)) * stride;
}
)";

constexpr const char* choose_text = R"(
// Whether all parents lie on the sample's surface.
bool between_parents(ivec2 place, vec4 position, vec4 normal) {
    float pixel_ws = gn_pixel_growth(u.view, normal.w) * length(u.view.right_ws.xyz);
    bool all_there = true;
    for (int i = 0; i < 4; ++i) {
        ivec2 other = parent(place, i);
        if (any(greaterThanEqual(other, ivec2(u.view.size.xy)))) {
            return false;
        }
        vec4 q = gbuffer_position_texel(other);
        vec4 q_n = gbuffer_normal_texel(other);
        all_there = all_there && counts(q, q_n) && dot(normal.xyz, q_n.xyz) > 0.9 &&
                    abs(dot(normal.xyz, q.xyz - position.xyz)) < float(stride) * pixel_ws;
    }
    return all_there;
}

void main() {
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(place, imageSize(few_positions)))) {
        return;
    }
    ivec2 pixel = place * stride;
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    float told = texelFetch(footprints, pixel, 0).r;
    bool looked_up = is_new(place) && counts(position, normal) && gn_back_told_visibility(told) < 0.0 &&
                     (coarsest != 0 || stride >= 1 << gn_back_told_apart(told) || !between_parents(place, position, normal));
    imageStore(few_positions, place, looked_up ? position : vec4(0.0));
    imageStore(few_normals, place, looked_up ? normal : vec4(0.0));
}
)";

constexpr const char* fill_text = R"(
void main() {
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(place, textureSize(few_positions, 0))) || !is_new(place)) {
        return;
    }
    ivec2 pixel = place * stride;
    float told = gn_back_told_visibility(texelFetch(footprints, pixel, 0).r);
    float v = 0.0;
    if (texelFetch(few_positions, place, 0).w > 0.5) {
        v = texelFetch(few_visibility, place, 0).r;
    } else if (counts(gbuffer_position_texel(pixel), gbuffer_normal_texel(pixel))) {
        float sum = 0.0;
        for (int i = 0; i < 4 && told < 0.0; ++i) {
            sum += imageLoad(visibility, parent(place, i)).r;
        }
        v = told >= 0.0 ? told : 0.25 * sum;
    }
    imageStore(visibility, pixel, vec4(v));
}
)";

struct RoundPush {
    int stride, coarsest;
};

/// One pass over a lattice of the view's samples.
void add_pass(const FrameInput& input, const char* name, ShaderInputs inputs, const char* text, const ViewSamples& few,
              RoundPush push) {
    add_gbuffer(inputs, input.device, input.samples);
    inputs.constant("GnViewConstants", "view", input.samples.constants)
        .constant("GnLight", "whole", input.whole_light().shape);
    const auto shader = compute_once(input.prepared, name, hashed(inputs), [&] {
        return expect_text(input.device) + channels_text(1) + include_line("shadow/view/view.glsl") +
               include_line("shadow/lookup/backprojection/sparse.glsl") + inputs.text() + head_text + text;
    });
    input.graph.add_pass(
        name, [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader, push, size = uvec2(few.width, few.height)](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.push_value(push);
            r.dispatch_pixels(size.x, size.y);
        });
}

std::shared_ptr<ViewSamples> create_lattice(const FrameInput& input, std::uint32_t stride) {
    auto few = std::make_shared<ViewSamples>();
    few->width = (input.samples.width + stride - 1) / stride;
    few->height = (input.samples.height + stride - 1) / stride;
    few->camera = input.samples.camera;
    few->constants = input.samples.constants;
    few->constants.size = uvec4(few->width, few->height, 0, 0);
    for (const auto& [texture, name] : {std::pair{&few->position, "few positions"}, {&few->normal, "few normals"}}) {
        *texture = input.graph.create(
            {.name = name, .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = few->width, .height = few->height});
    }
    input.graph.hold(few);
    return few;
}

Visibility resolve_with(const FrameInput& input, Recipe recipe, const Part& part, const LightViews& views,
                        const ShadowMap& map) {
    recipe.lookup = &part;
    return add_resolve(input, recipe, views, map);
}

}  // namespace

Visibility add_sparse(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map,
                      const Part& footprint, const Part& lookup) {
    const int levels = recipe.of<GnBackprojectionParams>("backprojection").sparse;
    const TextureHandle footprints = resolve_with(input, recipe, footprint, views, map).image;
    const TextureHandle visibility = create_visibility(input.graph, input.samples);
    for (int level = levels; level >= 0; --level) {
        // Take together what is looked up of this lattice, and look it up.
        const RoundPush push{1 << level, level == levels ? 1 : 0};
        const std::shared_ptr<ViewSamples> few = create_lattice(input, 1U << static_cast<unsigned>(level));
        ShaderInputs chosen;
        chosen.texture("sampler2D", "footprints", footprints);
        chosen.image("rgba32f", "writeonly", "image2D", "few_positions", few->position);
        chosen.image("rgba32f", "writeonly", "image2D", "few_normals", few->normal);
        add_pass(input, "sparse: choose", std::move(chosen), choose_text, *few, push);
        const TextureHandle few_visibility = resolve_with(seen_by(input, *few), recipe, lookup, views, map).image;

        // Put it into the picture, and between it what lies between the coarser lattice's.
        ShaderInputs filled;
        filled.texture("sampler2D", "footprints", footprints)
            .texture("sampler2D", "few_positions", few->position)
            .texture("sampler2D", "few_visibility", few_visibility);
        filled.image(image_format(visibility_format(1)), "", "image2D", "visibility", visibility);
        add_pass(input, "sparse: fill", std::move(filled), fill_text, *few, push);
    }
    return {visibility};
}

}  // namespace gn
