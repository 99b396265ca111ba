// SPDX-License-Identifier: MIT
// Occluders as a black picture, drawn from the light and projected onto everything else.
//
// Based on: Segal, Korobkin, van Widenfelt, Foran, Haeberli. Fast Shadows and Lighting Effects Using Texture Mapping. SIGGRAPH
// 1992. [SKB92]
// Departs from it: who occludes and who receives is found in the scene: objects that lie in its large planes receive.
//
// Stands on: shadow/placement/place (its picture is placed as maps are)
#include "shadow/direct/projective_texture/projective_texture.h"

#include "shadow/casters/raster.h"
#include "shadow/frame/frame.h"
#include "shadow/frame/map_memory.h"
#include "shadow/geometry/receiver_planes.h"
#include "shadow/placement/place.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"
#include "shadow/scene/casting.h"

#include <algorithm>

namespace gn::parts::projective_texture {
namespace {

constexpr const char* text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
float light_at(GnLightView view, GnProjected p) {
    // Texels of the view's own rectangle alone.
    ivec2 first = ivec2(view.rect_ts.xy * view.resolution + 0.5);
    ivec2 last = ivec2((view.rect_ts.xy + view.rect_ts.zw) * view.resolution + 0.5) - 1;
    vec2 at = p.uv_ts * view.resolution - 0.5;
    ivec2 low = ivec2(floor(at));
    vec4 depths;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = clamp(low + ivec2(i & 1, i >> 1), first, last);
        depths[i] = texelFetch(occluders, ivec3(texel, view.layer), 0).r;
    }
    return gn_projective_texture_light(depths, at - vec2(low));
}
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    float v = 0.0;
    GnReceiver receiver;
    if (read_sample(pixel, receiver)) {
        v = 1.0;
        uint object = gn_surface_object(gbuffer_surface_texel(pixel).xy);
        int view = GN_CHOOSE(receiver, placement).first;
        GnProjected p = gn_project(receiver, views[view], u.bias);
        if (p.inside && receives[object] != 0u) {
            v = light_at(views[view], p);
        }
    }
    imageStore(visibility, pixel, vec4(v));
}
)";

/// Twice the area of a triangle.
double doubled_area(const Scene& scene, std::uint32_t triangle) {
    const uvec3 t = scene.triangles[triangle];
    const dvec3 a(scene.positions_ws[t.x]);
    return glm::length(glm::cross(dvec3(scene.positions_ws[t.y]) - a, dvec3(scene.positions_ws[t.z]) - a));
}

bool lies_in(const Scene& scene, std::uint32_t triangle, vec4 plane_ws, float tolerance) {
    for (int i = 0; i < 3; ++i) {
        const vec3 p_ws = scene.positions_ws[scene.triangles[triangle][i]];
        if (std::abs(glm::dot(plane_ws, vec4(p_ws, 1))) > tolerance) {
            return false;
        }
    }
    return true;
}

/// Per object whether it receives, because so much of it lies in one plane: a floor does, a box does not. All others occlude.
std::vector<std::uint32_t> receiving_objects(const Scene& scene, const ReceiverPlanes& found, float flat_share) {
    std::vector<std::uint32_t> receives;
    for (const Object& object : scene.objects) {
        double all = 0;
        std::vector<double> flat(found.planes.size(), 0.0);
        for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t) {
            const double area = doubled_area(scene, t);
            all += area;
            for (std::size_t i = 0; i < flat.size(); ++i) {
                flat[i] += lies_in(scene, t, found.planes[i].plane_ws, found.tolerance) ? area : 0.0;
            }
        }
        const double most = *std::max_element(flat.begin(), flat.end());
        receives.push_back(most > static_cast<double>(flat_share) * all ? 1 : 0);
    }
    return receives;
}

/// The occluders seen from the light, black where depth is below 1.
TextureHandle add_picture(const FrameInput& input, const Recipe& recipe, LightViews& views,
                          const std::vector<std::uint32_t>& receives) {
    std::vector<std::uint32_t> occluders;
    for (std::uint32_t i = 0; i < receives.size(); ++i) {
        if (receives[i] == 0 && casts(input.scene, i, &input.light())) {
            occluders.push_back(i);
        }
    }
    if (occluders.empty()) {
        refuse(
            "projective-texture finds no occluder in '{}': each of its objects lies in a receiver plane; raise "
            "projective-texture.flat_share or take planar",
            input.scene.name);
    }
    views.casters.assign(views.views.size(), occluders);
    views.kept.reset();
    const TextureHandle depth = input.graph.create(TextureDesc{.name = "map",
                                                               .format = VK_FORMAT_D32_SFLOAT,
                                                               .width = views.resolution,
                                                               .height = views.resolution,
                                                               .layers = views.layers});
    check_map_memory(input, recipe, depth);
    add_caster_passes(input, recipe, views, {.depth = depth});
    return depth;
}

Visibility add_projective_texture(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnProjectiveTextureParams>("projective-texture");
    const auto found = flat_receivers(input, {params.planes, params.min_area, params.tolerance}, "projective-texture");
    const std::uint64_t key = hashed({})
                                  .value(params.planes)
                                  .value(params.min_area)
                                  .value(params.tolerance)
                                  .value(params.flat_share)
                                  .finish()
                                  .low;
    const auto receives = input.derive("receiving objects", key,
                                       [&] { return receiving_objects(input.scene, *found, params.flat_share); });
    LightViews views = place_views(input, recipe);
    const TextureHandle picture = add_picture(input, recipe, views, *receives);

    Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    inputs.texels(input.device, VK_FORMAT_R32G32_UINT, "2D", "gbuffer_surface", lent(input.samples.surface, "object"));
    inputs.texture("sampler2DArray", "occluders", picture)
        .image("r32f", "writeonly", "image2D", "visibility", result.image)
        .block("readonly buffer", "Receives", "uint receives[];", std::as_bytes(std::span(*receives)));
    const std::string defines = receiver_defines(recipe, views);
    const std::string functions = sample_functions(input, recipe, views);
    const Hasher shader_key = hashed(inputs).text(defines).text(functions).text(views.part->id);
    const auto shader = compute_once(input.prepared, "projective-texture.comp", shader_key, [&] {
        return defines + include_line("shadow/view/view.glsl") + include_line("shadow/view/surface.glsl") +
               placement_text(*views.part, recipe) +
               include_line("shadow/direct/projective_texture/projective_texture.glsl") + inputs.text() + functions +
               text;
    });
    add_pixel_pass(input.graph, "projective-texture", inputs, shader, input.samples.width, input.samples.height);
    return result;
}

}  // namespace
}  // namespace gn::parts::projective_texture

namespace gn::parts {

const Part& direct_projective_texture() {
    using namespace projective_texture;
    static const Part part = [] {
        Part p;
        p.id = "projective-texture";
        p.stage = Stage::direct;
        p.title = "Projected pictures of occluders";
        p.citation = "SKB92";
        p.needs_scene = true;
        p.params = param_table<GnProjectiveTextureParams>({
            GN_PARAM(
                GnProjectiveTextureParams, flat_share, real, 0, 1, "of an object's surface",
                "Objects of which less lies in one receiver plane occlude and receive nothing; the others receive."),
            GN_PARAM(GnProjectiveTextureParams, planes, integer, 1, 64, "", "More planes make more objects receivers."),
            GN_PARAM(GnProjectiveTextureParams, min_area, real, 0, 1, "of the scene's surface",
                     "Smaller flat parts are no receiver planes."),
            GN_PARAM(GnProjectiveTextureParams, tolerance, real, 1e-7, 1e-2, "of the scene's diagonal",
                     "Rougher planes receive."),
        });
        p.params_type = "GnProjectiveTextureParams";
        p.glsl = "shadow/direct/projective_texture/projective_texture.glsl";
        p.reads = {"placement", "resolution"};
        p.add_direct = add_projective_texture;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
