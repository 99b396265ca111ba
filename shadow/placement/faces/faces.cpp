// SPDX-License-Identifier: MIT
// A map for each face of the camera's frustum that the light's rays leave it by, or enter it by, each warped along the face.
//
// Based on: Lloyd, Tuft, Yoon, Manocha. Warping and Partitioning for Low Error Shadow Maps. EGSR 2006. [LTYM06]
// Departs from it: of the faces turned to the light and those turned away, the set that needs fewer texels in all serves, and
// maps are fitted to what of the scene lies behind their face.
#include "shadow/placement/faces/faces.h"

#include "shadow/placement/faces/faces.glsl"
#include "shadow/placement/warp.h"

#include <algorithm>

namespace gn::parts::faces {
namespace {

constexpr std::size_t faces = GN_FRUSTUM_FACES;
/// Of a face that no ray goes through: more than of any that one does.
constexpr float no_key = 1e30F;

/// A plane of the frustum; p is inside where dot(plane_ws, (p, 1)) >= 0.
struct Face {
    dvec4 plane_ws{0};
    double away = 0;  ///< of the light from it, inwards: metres, of the sun the sine between its rays and the plane
    dvec3 along_ws{
        0};  ///< from the middle of its near edge to the middle of its far edge; 0 of the near and the far face
};

std::array<Face, faces> faces_of(const FrameInput& input) {
    const Camera& camera = input.samples.camera;
    const GnLight& light = input.light().shape;
    const bool sun = light.kind == GN_LIGHT_DIRECTIONAL;
    const dvec4 light_ws = sun ? dvec4(-dvec3(vec3(light.direction_ws)), 0) : dvec4(dvec3(vec3(light.position_ws)), 1);
    const float aspect = static_cast<float>(input.samples.width) / static_cast<float>(input.samples.height);
    const auto planes =
        frustum_planes(camera, aspect, static_cast<double>(camera.near), static_cast<double>(camera.far));
    const dvec3 forward = glm::normalize(dvec3(camera.forward_ws));
    std::array<Face, faces> found;
    for (std::size_t i = 0; i < faces; ++i) {
        const double size = glm::length(planes[i].normal_ws);
        found[i].plane_ws = dvec4(planes[i].normal_ws, planes[i].offset) / size;
        found[i].away = glm::dot(found[i].plane_ws, light_ws);
        // What is left of the view's direction in the plane of a side runs from its near edge to its far one.
        const dvec3 normal(found[i].plane_ws);
        found[i].along_ws = i < 2 ? dvec3(0) : forward - glm::dot(forward, normal) * normal;
    }
    return found;
}

/// The faces of one side of the frustum as the light sees it, and what of the receivers lies behind each.
struct Partition {
    std::array<vec4, faces> keys_ws{};
    std::array<ConvexBody, faces> bodies;
    std::array<GnLightView, faces> views;
    int used = 0;
    double worst = 0;    ///< side of a texel over its distance from the eye, where it is largest
    bool valid = false;  ///< false where a view would be too wide
    /// Texels that all maps need in all, in proportion: each as many as the coarsest texel asks for.
    [[nodiscard]] double needed() const { return used * worst * worst; }
};

/// Cuts the receivers where two faces' keys are equal: planes through the edge of both and along the light's rays.
Partition cut(const std::array<Face, faces>& of, const ConvexBody& body, double sign, double edge_on) {
    Partition partition;
    std::array<dvec4, faces> keys{};
    for (std::size_t i = 0; i < faces; ++i) {
        const double away = sign * of[i].away;
        keys[i] = away > edge_on ? of[i].plane_ws / away : dvec4(0);
    }
    for (std::size_t i = 0; i < faces; ++i) {
        partition.keys_ws[i] = vec4(0, 0, 0, no_key);
        if (keys[i] == dvec4(0)) {
            continue;
        }
        ConvexBody behind = body;
        for (std::size_t j = 0; j < faces; ++j) {
            if (j != i && keys[j] != dvec4(0)) {
                const dvec4 nearer = keys[j] - keys[i];
                behind = clip(behind, {dvec3(nearer), nearer.w});
            }
        }
        if (!behind.empty()) {
            partition.keys_ws[i] = vec4(keys[i]);
            partition.bodies[i] = std::move(behind);
            ++partition.used;
        }
    }
    return partition;
}

/// Side of a texel over the distance from the eye, the larger side, where it is largest among the receivers that steer.
double worst_texel(const GnLightView& view, const ConvexBody& body, const Camera& camera, double first) {
    double worst = 0;
    const dvec3 forward = glm::normalize(dvec3(camera.forward_ws));
    for (const dvec3& p_ws : body.vertices()) {
        const double depth = glm::dot(p_ws - dvec3(camera.position_ws), forward);
        if (depth < first && !is_orthographic(camera)) {
            continue;
        }
        vec3 du_ws;
        vec3 dv_ws;
        glsl::gn_uv_gradients(view, vec3(p_ws), du_ws, dv_ws);
        const auto least = static_cast<double>(std::min(glm::length(du_ws), glm::length(dv_ws)));
        worst = std::max(worst, 1 / (least * (is_orthographic(camera) ? 1 : depth)));
    }
    return worst;
}

/// Fits and warps a view for every face that something lies behind.
void add_views(Partition& partition, const std::array<Face, faces>& of, const FrameInput& input, const Recipe& recipe,
               double end) {
    const GnLight& light = input.light().shape;
    const auto params = recipe.of<GnFacesParams>("faces");
    const auto near = static_cast<double>(params.near);
    const Guard guard = guard_of(input, recipe);
    for (std::size_t i = 0; i < faces; ++i) {
        const ConvexBody& body = partition.bodies[i];
        if (body.empty()) {
            continue;
        }
        Fitted fitted{{}, true};
        if (light.kind == GN_LIGHT_DIRECTIONAL) {
            fitted.view = fit_orthographic(body, light, recipe.resolution, guard);
        } else {
            fitted = fit_perspective(body, light, recipe.resolution, guard);
        }
        if (!fitted.valid) {
            return;
        }
        partition.views[i] = fitted.view;
        if (params.warp == GN_FACES_PERSPECTIVE && of[i].along_ws != dvec3(0)) {
            if (const auto plane = warp::plane_along(input, body, fitted.view, recipe, near, of[i].along_ws)) {
                partition.views[i] = warp::even_view(*plane, 0);
            }
        }
        partition.worst =
            std::max(partition.worst, worst_texel(partition.views[i], body, input.samples.camera, near * end));
    }
    partition.valid = partition.used > 0;
}

/// The faces that the light's rays leave the frustum by or those that they enter it by: of valid ones those that need fewer
/// texels, unless the recipe says which.
Partition best(const FrameInput& input, const Recipe& recipe, const ConvexBody& body) {
    const std::array<Face, faces> of = faces_of(input);
    const dvec3 forward = glm::normalize(dvec3(input.samples.camera.forward_ws));
    double end = 0;
    dvec3 low(1e300);
    dvec3 high(-1e300);
    for (const dvec3& p_ws : body.vertices()) {
        end = std::max(end, glm::dot(p_ws - dvec3(input.samples.camera.position_ws), forward));
        low = glm::min(low, p_ws);
        high = glm::max(high, p_ws);
    }
    // A face in whose plane the light lies shows nothing.
    const bool sun = input.light().shape.kind == GN_LIGHT_DIRECTIONAL;
    const double edge_on = 1e-3 * (sun ? 1 : glm::length(high - low));
    const int side = recipe.of<GnFacesParams>("faces").side;
    Partition chosen;
    for (const double sign : {1.0, -1.0}) {
        if (side != (sign > 0 ? GN_FACES_FRONT : GN_FACES_BACK)) {
            Partition tried = cut(of, body, sign, edge_on);
            add_views(tried, of, input, recipe, end);
            if (tried.valid && (!chosen.valid || tried.needed() < chosen.needed())) {
                chosen = std::move(tried);
            }
        }
    }
    return chosen;
}

/// A view like another that sees no point: all lie at x = 2 of its clip space.
GnLightView blind(GnLightView view) {
    view.cs_from_ws = mat4(vec4(0), vec4(0), vec4(0), vec4(2, 0, 0.5F, 1));
    return view;
}

LightViews place_faces(const FrameInput& input, const Recipe& recipe) {
    LightViews views;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    ConvexBody body = potential_receivers(input);
    if (body.empty()) {
        // Nothing can receive: any views will do.
        body = body_of(Box{vec3(-1), vec3(1)});
    }
    const Partition partition = best(input, recipe, body);
    GnFrustumFaces data;
    if (!partition.valid) {
        // The receivers surround the light.
        add_cube_views(views, input, guard_of(input, recipe), recipe.resolution);
        data.eye_ws = vec4(vec3(input.light().shape.position_ws), 1);
        views.set_data(data);
        return views;
    }

    // Faces that hold something have a layer each; the views of the others see nothing, and keep every face's number.
    const auto first = std::find_if(partition.bodies.begin(), partition.bodies.end(),
                                    [](const ConvexBody& behind) { return !behind.empty(); });
    const GnLightView nothing = blind(partition.views[static_cast<std::size_t>(first - partition.bodies.begin())]);
    views.layers = 0;
    for (std::size_t i = 0; i < faces; ++i) {
        const bool used = !partition.bodies[i].empty();
        views.views.push_back(used ? partition.views[i] : nothing);
        views.views[i].layer = used ? static_cast<int>(views.layers++) : 0;
        views.casters.push_back(used ? casters_of(input.scene, views.views[i]) : std::vector<std::uint32_t>{});
        data.keys_ws[i] = partition.keys_ws[i];
    }
    views.set_data(data);
    views.kind = kind_of(views.views);
    return views;
}

}  // namespace
}  // namespace gn::parts::faces

namespace gn::parts {

const Part& placement_faces() {
    using namespace faces;
    static const Part part = [] {
        Part p;
        p.id = "faces";
        p.stage = Stage::placement;
        p.title = "A warped map for each face of the view frustum";
        p.citation = "LTYM06";
        p.params = param_table<GnFacesParams>({
            GN_CHOICE(
                GnFacesParams, side,
                "Which faces have maps: those that the light's rays leave the frustum by, those that they enter it "
                "by, or of both the set that needs fewer texels.",
                "auto", "back", "front"),
            GN_CHOICE(GnFacesParams, warp,
                      "Warps the maps of sides along them, so that the error is equal at both ends, or leaves them "
                      "uniform as those of the near and the far face.",
                      "none", "perspective"),
            GN_PARAM(GnFacesParams, near, real, 0, 0.1, "of the depth",
                     "Pseudo-near plane, as a share of the farthest receiver's depth: a larger one gives far receivers "
                     "finer texels and those nearer than it coarser ones."),
        });
        p.params_type = "GnFacesParams";
        p.data_type = "GnFrustumFaces";
        p.glsl = "shadow/placement/faces/faces.glsl";
        p.place = place_faces;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
