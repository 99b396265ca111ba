// SPDX-License-Identifier: MIT
#include "shadow/placement/virtual/virtual_grid.h"

#include "shadow/casters/kept_map.h"
#include "shadow/casters/moved.h"
#include "shadow/geometry/potential_receivers.h"
#include "shadow/placement/light_views.h"
#include "shadow/recipe/guard.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gn::virtual_pages {
namespace {

/// Boxes that are told one by one; of more the one around all.
constexpr std::size_t most_boxes = 64;

/// A cone up to this tangent is served by one face: beyond it texels at the rim are three times as wide as in the middle.
constexpr double widest_face = 1.5;

/// A square of the sun's plane around all that can be seen, whose sides run the same way whatever that is.
GnLightView sun_face(const FrameInput& input, const Box& seen_ws, const Guard& guard) {
    const dvec3 axis(vec3(input.light().shape.direction_ws));
    vec3 xf;
    vec3 yf;
    complete_frame(vec3(axis), xf, yf);
    const dvec3 x(xf), y(yf);
    dvec3 low(1e300), high(-1e300);
    for (const vec3& corner_ws : seen_ws.corners()) {
        const dvec3 p(glm::dot(dvec3(corner_ws), x), glm::dot(dvec3(corner_ws), y), glm::dot(dvec3(corner_ws), axis));
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    // A hundredth for the kernels of receivers at the rim, and for what the bias moves.
    const double half =
        0.5 * 1.02 * std::max({high.x - low.x, high.y - low.y, 1e-30}) + static_cast<double>(guard.metres);
    const dvec3 middle = 0.5 * (low + high);
    const double slack = 0.02 * half;
    const double near = low.z - slack - static_cast<double>(guard.before);
    const double far = high.z + slack;
    const std::array<dvec4, 4> rows{dvec4(x / half, -middle.x / half), dvec4(y / half, -middle.y / half),
                                    dvec4(axis / (far - near), -near / (far - near)), dvec4(0, 0, 0, 1)};
    const dmat4 cs_from_ws = glm::transpose(dmat4(rows[0], rows[1], rows[2], rows[3]));
    GnLightView view;
    view.cs_from_ws = mat4(cs_from_ws);
    view.ws_from_cs = mat4(glm::inverse(cs_from_ws));
    view.depth_from_ws = vec4(rows[2]);
    view.eye_ws = vec4(vec3(-axis), 0);
    view.metres_per_depth = static_cast<float>(far - near);
    return view;
}

void add_lamp_faces(Grid& grid, const FrameInput& input) {
    const GnLight& light = input.light().shape;
    const vec3 eye_ws(light.position_ws);
    const double cosine = std::max(static_cast<double>(light.cos_outer), 1e-3);
    const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
    if (light.kind == GN_LIGHT_SPOT && tangent <= widest_face) {
        vec3 x;
        vec3 y;
        complete_frame(vec3(light.direction_ws), x, y);
        grid.faces = {square_perspective(eye_ws, vec3(light.direction_ws), y, 1.01 * tangent, near_plane(grid.reach),
                                         grid.reach, 1)};
        return;
    }
    LightViews six;
    add_cube_views(six, input, {.texels = 1}, 1024);
    grid.faces = six.views;
    grid.around = true;
}

}  // namespace

bool same_faces(const Grid& a, const Grid& b) {
    return a.faces.size() == b.faces.size() && a.casting == b.casting && same_shape(a.shape, b.shape) &&
           std::memcmp(a.faces.data(), b.faces.data(), a.faces.size() * sizeof(GnLightView)) == 0;
}

Grid grid_of(const FrameInput& input, const Recipe& recipe, const Grid* before) {
    Grid grid;
    grid.shape = shadow_shape(input.light());
    grid.seen_ws = seen_bounds(input);
    if (grid.seen_ws.empty()) {
        grid.seen_ws = Box{vec3(-1), vec3(1)};
    }
    grid.reach = grid.shape.kind == GN_LIGHT_DIRECTIONAL ? 0.0 : reach_of(input);
    const Fingerprint casting = casting_of(input.scene, input.light());
    grid.casting = Hasher().value(casting.low).value(casting.high).finish().low;
    grid.version = input.handles.version;
    const bool serves = before != nullptr && same_shape(before->shape, grid.shape) &&
                        before->seen_ws.contains(grid.seen_ws.min) && before->seen_ws.contains(grid.seen_ws.max) &&
                        before->reach >= grid.reach;
    if (serves) {
        grid.faces = before->faces;
        grid.around = before->around;
        grid.seen_ws = before->seen_ws;
        grid.reach = before->reach;
    } else if (grid.shape.kind == GN_LIGHT_DIRECTIONAL) {
        grid.faces = {sun_face(input, grid.seen_ws, guard_of(input, recipe))};
    } else {
        add_lamp_faces(grid, input);
    }
    for (GnLightView& face : grid.faces) {
        face.layer = 0;
        face.resolution = static_cast<float>(recipe.resolution);
    }
    return grid;
}

std::optional<std::vector<vec4>> touched_parts(const FrameInput& input, const Grid& before) {
    const std::optional<std::vector<Box>> boxes = moved_since(input.handles, before.version, most_boxes);
    if (!boxes) {
        return {};
    }
    std::vector<vec4> parts;
    for (const Box& box : *boxes) {
        for (std::size_t face = 0; face < before.faces.size(); ++face) {
            vec2 low(1e30F), high(-1e30F);
            bool before_eye = false, behind_eye = false;
            for (const vec3& corner_ws : box.corners()) {
                const vec4 p_cs = before.faces[face].cs_from_ws * vec4(corner_ws, 1);
                before_eye = before_eye || p_cs.w > 0;
                behind_eye = behind_eye || p_cs.w <= 0;
                const vec2 p_ts = 0.5F * vec2(p_cs) / p_cs.w + 0.5F;
                low = glm::min(low, p_ts);
                high = glm::max(high, p_ts);
            }
            // What reaches from before the light to behind it may be seen anywhere.
            if (before_eye) {
                parts.push_back(behind_eye ? vec4(0, 0, 1, 1) : vec4(low, high));
                parts.emplace_back(static_cast<float>(face), 0, 0, 0);
            }
        }
    }
    return parts;
}

}  // namespace gn::virtual_pages
