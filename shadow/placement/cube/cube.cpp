// SPDX-License-Identifier: MIT
// Six perspective views around a light, layers of one array: any lookup works on them unchanged. Faces may be as fine as
// the screen needs them, several then share a layer.
//
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
// Departs from it: a 2D array whose faces overlap by the kernels' reach, where hardware cubes would filter across faces.
#include "shadow/placement/cube/cube.h"

#include "shadow/geometry/convex_body.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/placement/light_views.h"
#include "shadow/placement/shelf.h"
#include "shadow/recipe/guard.h"
#include "shadow/scene/clusters.h"

#include <algorithm>
#include <numeric>

namespace gn::parts::cube {
namespace {

constexpr int faces = 6;

/// The camera's plane at distance 1; bodies seen by the camera lie before it.
struct Screen {
    dvec3 eye, right, down, forward;
    bool orthographic = false;
    double area = 1;
    [[nodiscard]] dvec2 project(dvec3 p) const {
        const dvec3 d = p - eye;
        return dvec2(glm::dot(d, right), glm::dot(d, down)) / (orthographic ? 1.0 : glm::dot(d, forward));
    }
};

Screen screen_of(const FrameInput& input) {
    const Camera& camera = input.samples.camera;
    Screen screen;
    screen.eye = camera.position_ws;
    screen.forward = glm::normalize(dvec3(camera.forward_ws));
    screen.right = glm::normalize(glm::cross(screen.forward, dvec3(camera.up_ws)));
    screen.down = glm::cross(screen.forward, screen.right);
    screen.orthographic = is_orthographic(camera);
    const double half_height = half_height_at(camera, 1);
    screen.area = 4 * half_height * half_height * input.samples.width / input.samples.height;
    return screen;
}

/// Share of the picture that a body covers. Of a convex body half of the faces are seen and half are not: the sum of
/// all projected areas counts everything twice.
double coverage(const ConvexBody& body, const Screen& screen) {
    double area = 0;
    for (const auto& face : body.faces_ws) {
        double twice = 0;
        for (std::size_t i = 0; i < face.size(); ++i) {
            const dvec2 a = screen.project(face[i]);
            const dvec2 b = screen.project(face[(i + 1) % face.size()]);
            twice += a.x * b.y - a.y * b.x;
        }
        area += 0.5 * std::abs(twice);
    }
    return 0.5 * area / screen.area;
}

/// The part of the potential receivers behind one face, whose view is square and a little wider than the face.
ConvexBody behind(ConvexBody body, const GnLightView& face) {
    const dmat4 rows = glm::transpose(dmat4(face.cs_from_ws));
    for (int axis = 0; axis < 2; ++axis) {
        // A hair beyond 45 degrees, so that no receiver on the border is missed.
        const dvec4 side = 0.999 * rows[axis];
        const dvec4 middle = glm::length(dvec3(rows[axis])) * rows[3];
        body = clip(body, {dvec3(middle + side), (middle + side).w});
        body = clip(body, {dvec3(middle - side), (middle - side).w});
    }
    return body;
}

/// How often each face's side is halved, in proportion to the side of what it covers on screen; -1 where nothing can
/// receive.
std::array<int, faces> halvings(const FrameInput& input, const LightViews& views, int most) {
    const Screen screen = screen_of(input);
    const ConvexBody body = potential_receivers(input);
    std::array<double, faces> shares{};
    std::transform(views.views.begin(), views.views.end(), shares.begin(),
                   [&](const GnLightView& face) { return coverage(behind(body, face), screen); });
    const double largest = *std::max_element(shares.begin(), shares.end());
    std::array<int, faces> result{};
    for (std::size_t i = 0; i < faces; ++i) {
        result[i] = shares[i] > 0
                        ? std::clamp(static_cast<int>(std::floor(0.5 * std::log2(largest / shares[i]))), 0, most)
                        : -1;
    }
    return result;
}

/// The same face with the half-angle that leaves room for the kernels in a smaller square.
GnLightView resized(const GnLightView& face, double far, double tangent) {
    const vec3 eye_ws(face.eye_ws);
    const dmat4 rows = glm::transpose(dmat4(face.cs_from_ws));
    GnLightView view = square_perspective(eye_ws, vec3(dvec3(rows[3])), vec3(-glm::normalize(dvec3(rows[1]))), tangent,
                                          near_plane(far), far, 1);
    view.resolution = face.resolution;
    return view;
}

/// Shrinks and packs the faces. A face without receivers keeps a square of the smallest size that nothing is drawn to.
void fit_to_screen(LightViews& views, const FrameInput& input, const Recipe& recipe, const Guard& guard) {
    // Halve only while squares stay whole and kernels stay small against them.
    int most = 0;
    while (most < 4 && recipe.resolution % (2 << most) == 0 &&
           static_cast<float>(recipe.resolution >> (most + 1)) >= std::max(16.0F, 6 * guard.texels)) {
        ++most;
    }
    const std::array<int, faces> halved = halvings(input, views, most);

    // Draw every caster into faces that are looked at, none into others.
    std::vector<std::uint32_t> all(input.scene.objects.size());
    std::iota(all.begin(), all.end(), 0U);
    std::array<std::size_t, faces> order{0, 1, 2, 3, 4, 5};
    const auto size_of = [&](std::size_t i) { return halved[i] < 0 ? most : halved[i]; };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return size_of(a) < size_of(b); });
    Shelf shelf{most};
    views.casters.resize(faces);
    for (const std::size_t i : order) {
        const double share = static_cast<double>(guard.texels) / (recipe.resolution >> size_of(i));
        views.views[i] = resized(views.views[i], reach_of(input), 1 / (1 - 2 * share) + (guard.metres > 0 ? 0.1 : 0.0));
        shelf.put(views.views[i], size_of(i));
        views.casters[i] = halved[i] < 0 && !views.crosses ? std::vector<std::uint32_t>{} : all;
    }
    views.layers = static_cast<std::uint32_t>(views.views[order.back()].layer) + 1;
}

LightViews place_cube(const FrameInput& input, const Recipe& recipe) {
    LightViews views;
    views.resolution = static_cast<std::uint32_t>(recipe.resolution);
    const auto params = recipe.of<GnCubeParams>("cube");
    views.crosses = params.edges == GN_CUBE_CROSS;
    add_cube_views(views, input, views.crosses ? Guard{.texels = 1} : guard_of(input, recipe), recipe.resolution);
    const bool seen = !potential_receivers(input).empty();
    if (seen && params.resolution == GN_CUBE_COVERAGE) {
        fit_to_screen(views, input, recipe, views.crosses ? Guard{.texels = 1} : guard_of(input, recipe));
    }
    return views;
}

/// A cube looks everywhere: of a light far off say how little of it is spent on the scene.
std::string remark_cube(const Scene& scene, const Recipe& recipe) {
    constexpr double few = 16;
    const Box most = largest_cluster(scene);
    for (const Light& light : scene.lights) {
        if (light.shape.kind == GN_LIGHT_DIRECTIONAL || light.shape.kind == GN_LIGHT_ENVIRONMENT ||
            recipe.placement_for(light.shape).place != &place_cube) {
            continue;
        }
        const vec3 light_ws(light.shape.position_ws);
        const double away = glm::distance(light_ws, glm::clamp(light_ws, most.min, most.max));
        // A face is twice as wide as it is far.
        const double across = 0.5 * recipe.resolution * static_cast<double>(most.diagonal()) / away;
        if (across < few) {
            return fmt::format(
                "placement 'cube' looks around light '{}' from {:.3g} m off: {:.2g} of its {} texels a side "
                "hold all it shines on; placement=fit looks there alone",
                light.name, away, across, recipe.resolution);
        }
    }
    return {};
}

}  // namespace
}  // namespace gn::parts::cube

namespace gn::parts {

const Part& placement_cube() {
    using namespace cube;
    static const Part part = [] {
        Part p;
        p.id = "cube";
        p.stage = Stage::placement;
        p.title = "Six faces around the light";
        p.citation = "EASW09";
        p.lights = {.spot = true, .point = true, .rectangle = true};
        p.stands_in_for = {.point = true};
        p.view_names = {"+x", "-x", "+y", "-y", "+z", "-z"};
        p.params = param_table<GnCubeParams>({
            GN_CHOICE(GnCubeParams, resolution,
                      "Gives all faces the same texels, or each as many as it covers of the screen: less memory and "
                      "time, and texels that change size with the view.",
                      "equal", "coverage"),
            GN_CHOICE(
                GnCubeParams, edges,
                "What kernels read beyond a face's edge: a border that every face has for them, which costs texels "
                "and cannot hold a radius in metres near the light, or the next face, which costs time there.",
                "guard", "cross"),
        });
        p.params_type = "GnCubeParams";
        p.data_type = "GnFacesData";
        p.glsl = "shadow/placement/cube/cube.glsl";
        p.place = place_cube;
        p.remark = remark_cube;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
