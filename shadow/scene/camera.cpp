// SPDX-License-Identifier: MIT
// The camera's matrices and default cameras.
#include "base/error.h"
#include "shadow/scene/main_mass.h"
#include "shadow/scene/model.h"

#include <algorithm>

namespace gn {

const Camera& Scene::camera(std::string_view view_name) const {
    if (view_name.empty() && !cameras.empty()) {
        return cameras.front();
    }
    std::string known;
    for (const Camera& camera : cameras) {
        if (camera.name == view_name) {
            return camera;
        }
        known += (known.empty() ? "" : ", ") + camera.name;
    }
    fail("scene '{}' has no view '{}'; its views are: {}", name, view_name, known.empty() ? "none" : known);
}

vec4 eye_of(const Camera& camera) {
    return is_orthographic(camera) ? vec4(-camera.forward_ws, 0.0F) : vec4(camera.position_ws, 1.0F);
}

vec3 to_eye(const Camera& camera, vec3 p_ws) {
    const vec4 eye_ws = eye_of(camera);
    return glm::normalize(vec3(eye_ws) - p_ws * eye_ws.w);
}

double half_height_at(const Camera& camera, double distance) {
    return is_orthographic(camera) ? static_cast<double>(camera.half_height)
                                   : distance * std::tan(0.5 * static_cast<double>(camera.yfov));
}

mat4 vs_from_ws(const Camera& camera) {
    // Turn first, then move: a direction added to a far position would be rounded away.
    mat4 m = glm::lookAtRH(vec3(0.0F), camera.forward_ws, camera.up_ws);
    m[3] = vec4(dvec4(-dvec3(dmat4(m) * dvec4(dvec3(camera.position_ws), 0.0)), 1.0));
    return m;
}

mat4 cs_from_vs(const Camera& camera, float aspect) {
    // In double and rounded once: with d = -z, z_cs / w is 1 at d = near and 0 at d = far.
    const double scale = 1.0 / half_height_at(camera, 1.0);
    const double near = camera.near;
    const double far = camera.far;
    mat4 m(0.0F);
    m[0][0] = static_cast<float>(scale / static_cast<double>(aspect));
    m[1][1] = static_cast<float>(-scale);
    if (is_orthographic(camera)) {
        m[2][2] = static_cast<float>(1.0 / (far - near));
        m[3] = vec4(camera.shift_cs, static_cast<float>(far / (far - near)), 1.0F);
        return m;
    }
    m[2][2] = static_cast<float>(near / (far - near));
    m[2][3] = -1.0F;
    m[2][0] = -camera.shift_cs.x;
    m[2][1] = -camera.shift_cs.y;
    m[3][2] = static_cast<float>(near * far / (far - near));
    return m;
}

namespace {

/// What of the scene lies in a camera's picture, along its axis.
struct Seen {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t beyond = 0;  ///< triangles that lie wholly beyond the far plane
};

/// The part of a polygon where dot(plane, (p, 1)) >= 0.
std::vector<dvec3> cut(const std::vector<dvec3>& polygon, dvec4 plane) {
    std::vector<dvec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 a = polygon[i];
        const dvec3 b = polygon[(i + 1) % polygon.size()];
        const double da = glm::dot(plane, dvec4(a, 1.0));
        const double db = glm::dot(plane, dvec4(b, 1.0));
        if (da >= 0.0) {
            kept.push_back(a);
        }
        if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
            kept.push_back(a + (b - a) * (da / (da - db)));
        }
    }
    return kept;
}

Seen look(const Scene& scene, const Camera& camera, float aspect) {
    // In the camera's own space, z along its axis, scaled so that the picture's sides are the planes |x| = |y| = z, or, under
    // an orthographic camera, |x| = |y| = 1.
    const dvec3 back = -dvec3(camera.forward_ws);
    const dvec3 right = glm::normalize(glm::cross(dvec3(camera.up_ws), back));
    const dvec3 up = glm::cross(back, right);
    const double scale = 1.0 / half_height_at(camera, 1.0);
    const auto seen_from = [&](vec3 p_ws) {
        const dvec3 p = dvec3(p_ws) - dvec3(camera.position_ws);
        return dvec3(scale / static_cast<double>(aspect) * glm::dot(right, p), scale * glm::dot(up, p),
                     -glm::dot(back, p));
    };
    const double z = is_orthographic(camera) ? 0.0 : 1.0;
    const std::array<dvec4, 5> sides{
        {{1, 0, z, 1 - z}, {-1, 0, z, 1 - z}, {0, 1, z, 1 - z}, {0, -1, z, 1 - z}, {0, 0, 1, 0}}};
    Seen seen;
    for (const uvec3 t : scene.triangles) {
        // Most triangles lie beyond one side as a whole.
        const std::array corners{seen_from(scene.positions_ws[t.x]), seen_from(scene.positions_ws[t.y]),
                                 seen_from(scene.positions_ws[t.z])};
        const auto outside = [&](dvec4 side) {
            return std::all_of(corners.begin(), corners.end(),
                               [&](const dvec3& p) { return glm::dot(side, dvec4(p, 1.0)) < 0.0; });
        };
        if (std::any_of(sides.begin(), sides.end(), outside)) {
            continue;
        }
        std::vector<dvec3> polygon(corners.begin(), corners.end());
        for (const dvec4 side : sides) {
            polygon = polygon.empty() ? polygon : cut(polygon, side);
        }
        double nearest = std::numeric_limits<double>::infinity();
        for (const dvec3& p : polygon) {
            nearest = std::min(nearest, p.z);
        }
        seen.nearest = std::min(seen.nearest, nearest);
        seen.beyond += std::isfinite(nearest) && nearest > static_cast<double>(camera.far) ? 1U : 0U;
    }
    return seen;
}

float farthest_of(const Box& bounds, const Camera& camera) {
    float farthest = 0.0F;
    for (const vec3 corner : bounds.corners()) {
        farthest = std::max(farthest, glm::distance(corner, camera.position_ws));
    }
    return farthest;
}

// Depth range for everything in `bounds` as seen by the camera. What stands nearer than a near plane that suits the whole
// would be cut off: then half the way to it serves, down to 2^-20 of the far plane; reversed depth in floats bears it.
// An orthographic camera's depth is linear, and no near plane costs it any: there the least serves.
void choose_range(Camera& camera, const Scene& scene, const Box& bounds, float aspect, bool near_given,
                  bool far_given) {
    const float farthest = farthest_of(bounds, camera);
    const vec3 nearest = glm::clamp(camera.position_ws, bounds.min, bounds.max);
    const float distance = glm::distance(nearest, camera.position_ws);
    if (!far_given) {
        camera.far = farthest > 0.0F ? 1.05F * farthest : 1.0F;
    }
    if (!near_given && is_orthographic(camera)) {
        camera.near = 0x1p-20F * camera.far;
    } else if (!near_given) {
        camera.near = std::max(0.5F * std::min(distance, camera.far), 1e-4F * camera.far);
        const double seen = look(scene, camera, aspect).nearest;
        if (0.5 * seen < static_cast<double>(camera.near)) {
            camera.near = std::max(static_cast<float>(0.5 * seen), 0x1p-20F * camera.far);
        }
    }
}

void note_cut(Scene& scene, const Camera& camera, float aspect) {
    if (const std::size_t beyond = look(scene, camera, aspect).beyond; beyond > 0) {
        add_note(scene.notes,
                 fmt::format("Camera '{}' sees to {:.4g} m and leaves out {} triangle{} in its view beyond.",
                             camera.name, camera.far, beyond, beyond == 1 ? "" : "s"));
    }
}

// Three quarters from the front, above the horizon, at the distance that shows the whole box in a picture of this aspect.
Camera frame_box(const Box& box, float aspect) {
    Camera camera;
    const vec3 towards = glm::normalize(vec3(0.62F, 0.5F, 1.0F));
    camera.forward_ws = -towards;
    const vec3 right = glm::normalize(glm::cross(camera.forward_ws, camera.up_ws));
    const vec3 up = glm::cross(right, camera.forward_ws);
    const float slope = std::tan(0.5F * camera.yfov);
    float distance = 0.0F;
    for (const vec3 corner : box.corners()) {
        const vec3 offset = corner - box.centre();
        const float side = std::max(std::abs(glm::dot(offset, right)) / aspect, std::abs(glm::dot(offset, up)));
        distance = std::max(distance, glm::dot(offset, towards) + side / slope);
    }
    camera.position_ws = box.centre() + towards * (1.05F * distance);
    return camera;
}

// Lens: an angle between 0.1 and 175 degrees, or the height of a picture by parallel rays, at most 1e9 m to each side.
void repair_lens(Camera& camera, std::vector<std::string>& notes) {
    if (!(camera.yfov > 0.0017F && camera.yfov < 3.06F)) {
        camera.yfov = Camera{}.yfov;
        if (!is_orthographic(camera)) {
            add_note(notes, fmt::format("Camera '{}' had no usable field of view and has {:.2f} rad.", camera.name,
                                        camera.yfov));
        }
    }
    if (!std::isfinite(camera.half_height) || camera.half_height > 1e9F || camera.half_height < 0.0F) {
        camera.half_height = 0.0F;
        add_note(notes,
                 fmt::format("Camera '{}' had no usable height of an orthographic picture and is a perspective one.",
                             camera.name));
    }
}

void repair_camera(Camera& camera, const Scene& scene, const Box& bounds, float aspect,
                   std::vector<std::string>& notes) {
    // Pose.
    if (!finite(camera.position_ws) || glm::any(glm::greaterThan(glm::abs(camera.position_ws), vec3(1e9F)))) {
        camera.position_ws = vec3(0.0F);
        add_note(notes, fmt::format("Camera '{}' had no usable position and stands at the origin.", camera.name));
    }
    const float length = glm::length(camera.forward_ws);
    if (!std::isfinite(length) || length < 1e-6F) {
        camera.forward_ws = vec3(0, 0, -1);
        add_note(notes, fmt::format("Camera '{}' had no direction and looks along -z.", camera.name));
    }
    camera.forward_ws = glm::normalize(camera.forward_ws);
    const vec3 right = glm::cross(camera.forward_ws, camera.up_ws);
    if (!finite(right) || glm::length(right) < 1e-4F * glm::length(camera.up_ws) || camera.up_ws == vec3(0)) {
        camera.up_ws = std::abs(camera.forward_ws.y) < 0.9F ? vec3(0, 1, 0) : vec3(0, 0, -1);
    }

    // 0 < near < far.
    repair_lens(camera, notes);
    // Zero means that the file left the choice to us; what else cannot be is a mistake, and so are both planes where the far
    // one does not lie behind the near one, or nothing does.
    const bool near_given = std::isfinite(camera.near) && camera.near > 0.0F;
    const bool far_given = std::isfinite(camera.far) && camera.far > 0.0F;
    const float farthest = far_given ? camera.far : farthest_of(bounds, camera);
    const bool in_order = !near_given || camera.near < farthest;
    if (!near_given || !far_given || !in_order) {
        const bool mistake = !in_order || (!near_given && camera.near != 0.0F) || (!far_given && camera.far != 0.0F);
        choose_range(camera, scene, bounds, aspect, near_given && in_order, far_given && in_order);
        camera.near = std::min(camera.near, 0.5F * camera.far);
        if (mistake) {
            add_note(notes, fmt::format("Camera '{}' had no usable depth range and sees from {:.4g} to {:.4g} m.",
                                        camera.name, camera.near, camera.far));
        }
    }
}

// Views are asked for by name: a second "main" becomes "main 2".
void make_names_unique(std::vector<Camera>& cameras) {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const std::string base = cameras[i].name.empty() ? "view" : cameras[i].name;
        std::string name = base;
        const auto taken = [&] {
            return std::any_of(cameras.begin(), cameras.begin() + static_cast<std::ptrdiff_t>(i),
                               [&](const Camera& other) { return other.name == name; });
        };
        for (int number = 2; taken(); ++number) {
            name = fmt::format("{} {}", base, number);
        }
        cameras[i].name = name;
    }
}

}  // namespace

void complete_cameras(Scene& scene, float aspect) {
    constexpr std::size_t max_cameras = 256;
    if (scene.cameras.size() > max_cameras) {
        add_note(scene.notes, fmt::format("{} cameras were dropped; at most {} are kept.",
                                          scene.cameras.size() - max_cameras, max_cameras));
        scene.cameras.resize(max_cameras);
    }

    // An empty scene is seen as if a unit box stood at the origin.
    Box bounds = bounds_without_strays(scene);
    if (bounds.empty()) {
        bounds.grow(vec3(-0.5F));
        bounds.grow(vec3(0.5F));
    }
    for (Camera& camera : scene.cameras) {
        repair_camera(camera, scene, bounds, aspect, scene.notes);
    }
    for (CameraPath& path : scene.paths) {
        for (Camera& frame : path.frames) {
            repair_camera(frame, scene, bounds, aspect, scene.notes);
        }
    }
    // The whole from outside: the default view of a bare model, one more view, `overview`, of any other.
    make_names_unique(scene.cameras);
    const bool bare = scene.cameras.empty();
    const bool taken = std::any_of(scene.cameras.begin(), scene.cameras.end(),
                                   [](const Camera& camera) { return camera.name == "overview"; });
    if (bare || (!taken && !scene.closed_form && !scene.bounds_ws.empty())) {
        scene.cameras.push_back(frame_box(scene.bounds_ws.empty() ? bounds : main_bounds(scene), aspect));
        scene.cameras.back().name = bare ? "main" : "overview";
        choose_range(scene.cameras.back(), scene, bounds, aspect, false, false);
    }
    for (const Camera& camera : scene.cameras) {
        note_cut(scene, camera, aspect);
    }
}

}  // namespace gn
