// SPDX-License-Identifier: MIT
// The camera's matrices and default cameras.
#include "base/error.h"
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

mat4 vs_from_ws(const Camera& camera) {
    // Turn first, then move: a direction added to a far position would be rounded away.
    mat4 m = glm::lookAtRH(vec3(0.0F), camera.forward_ws, camera.up_ws);
    m[3] = vec4(dvec4(-dvec3(dmat4(m) * dvec4(dvec3(camera.position_ws), 0.0)), 1.0));
    return m;
}

mat4 cs_from_vs(const Camera& camera, float aspect) {
    // In double and rounded once: with d = -z, z_cs / w is 1 at d = near and 0 at d = far.
    const double scale = 1.0 / std::tan(0.5 * static_cast<double>(camera.yfov));
    const double near = camera.near;
    const double far = camera.far;
    mat4 m(0.0F);
    m[0][0] = static_cast<float>(scale / static_cast<double>(aspect));
    m[1][1] = static_cast<float>(-scale);
    m[2][2] = static_cast<float>(near / (far - near));
    m[2][3] = -1.0F;
    m[3][2] = static_cast<float>(near * far / (far - near));
    return m;
}

namespace {

struct Weighted {
    float value, weight;
};

// The values below and above which 2 % of the weight lies.
void trim_axis(std::vector<Weighted>& samples, float& low, float& high) {
    std::sort(samples.begin(), samples.end(), [](Weighted a, Weighted b) { return a.value < b.value; });
    double total = 0.0;
    for (const Weighted s : samples) {
        total += static_cast<double>(s.weight);
    }
    double sum = 0.0;
    bool below = true;
    for (const Weighted s : samples) {
        sum += static_cast<double>(s.weight);
        if (below && sum > 0.02 * total) {
            low = s.value;
            below = false;
        }
        if (sum >= 0.98 * total) {
            high = s.value;
            return;
        }
    }
}

float triangle_size(const Scene& scene, uvec3 t) {
    const vec3 a = scene.positions_ws[t.x];
    const glm::dvec3 ab(scene.positions_ws[t.y] - a);
    const glm::dvec3 ac(scene.positions_ws[t.z] - a);
    return static_cast<float>(std::sqrt(0.5 * glm::length(glm::cross(ab, ac))));
}

}  // namespace

Box main_bounds(const Scene& scene) {
    // Weigh each triangle by its size (the root of its area), at most a quarter percent of the whole, so that neither a crumb far
    // away nor one vast ground plane decides what the picture shows. A hundred thousand triangles are sample enough.
    const std::size_t step = std::max<std::size_t>(1, scene.triangles.size() / 100'000);
    double total = 0.0;
    for (std::size_t i = 0; i < scene.triangles.size(); i += step) {
        total += static_cast<double>(triangle_size(scene, scene.triangles[i]));
    }
    const auto heaviest = static_cast<float>(0.0025 * total);

    // Trim 2 % at both ends of each axis.
    Box box = scene.bounds_ws;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<Weighted> samples;
        for (std::size_t i = 0; i < scene.triangles.size(); i += step) {
            const float weight = std::min(triangle_size(scene, scene.triangles[i]), heaviest);
            for (int corner = 0; corner < 3; ++corner) {
                samples.push_back({scene.positions_ws[scene.triangles[i][corner]][axis], weight});
            }
        }
        trim_axis(samples, box.min[axis], box.max[axis]);
    }

    // Where trimming takes little away there are no outliers: show everything.
    if (box.empty() || box.diagonal() > 0.7F * scene.bounds_ws.diagonal()) {
        return scene.bounds_ws;
    }
    const vec3 margin(0.1F * box.extent());
    return {box.min - margin, box.max + margin};
}

namespace {

// Depth range for everything in `bounds` as seen by the camera.
void choose_range(Camera& camera, const Box& bounds, bool near_given, bool far_given) {
    float farthest = 0.0F;
    for (const vec3 corner : bounds.corners()) {
        farthest = std::max(farthest, glm::distance(corner, camera.position_ws));
    }
    const vec3 nearest = glm::clamp(camera.position_ws, bounds.min, bounds.max);
    const float distance = glm::distance(nearest, camera.position_ws);
    farthest = std::max(farthest, 1e-3F);
    if (!far_given) {
        camera.far = 1.05F * farthest;
    }
    if (!near_given) {
        camera.near = std::max(0.5F * std::min(distance, camera.far), 1e-4F * camera.far);
    }
}

// Three quarters from the front, above the horizon, at the distance that shows the whole box in a square picture.
Camera frame_box(const Box& box) {
    Camera camera;
    const vec3 towards = glm::normalize(vec3(0.62F, 0.5F, 1.0F));
    camera.forward_ws = -towards;
    const vec3 right = glm::normalize(glm::cross(camera.forward_ws, camera.up_ws));
    const vec3 up = glm::cross(right, camera.forward_ws);
    const float slope = std::tan(0.5F * camera.yfov);
    float distance = 0.0F;
    for (const vec3 corner : box.corners()) {
        const vec3 offset = corner - box.centre();
        const float side = std::max(std::abs(glm::dot(offset, right)), std::abs(glm::dot(offset, up)));
        distance = std::max(distance, glm::dot(offset, towards) + side / slope);
    }
    camera.position_ws = box.centre() + towards * std::max(1.05F * distance, 1e-3F);
    return camera;
}

void repair_camera(Camera& camera, const Box& bounds, std::vector<std::string>& notes) {
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

    // Lens: an angle between 0.1 and 175 degrees, 0 < near < far.
    if (!(camera.yfov > 0.0017F && camera.yfov < 3.06F)) {
        camera.yfov = Camera{}.yfov;
        add_note(notes,
                 fmt::format("Camera '{}' had no usable field of view and has {:.2f} rad.", camera.name, camera.yfov));
    }
    const bool near_given = std::isfinite(camera.near) && camera.near > 0.0F;
    const bool far_given = std::isfinite(camera.far) && camera.far > (near_given ? camera.near : 0.0F);
    if (!near_given || !far_given) {
        // Zero means that the file left the choice to us; anything else was a mistake.
        const bool mistake = (!near_given && camera.near != 0.0F) || (!far_given && camera.far != 0.0F);
        choose_range(camera, bounds, near_given, far_given);
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

void complete_cameras(Scene& scene) {
    constexpr std::size_t max_cameras = 256;
    if (scene.cameras.size() > max_cameras) {
        add_note(scene.notes, fmt::format("{} cameras were dropped; at most {} are kept.",
                                          scene.cameras.size() - max_cameras, max_cameras));
        scene.cameras.resize(max_cameras);
    }

    // An empty scene is seen as if a unit box stood at the origin.
    Box bounds = scene.bounds_ws;
    if (bounds.empty()) {
        bounds.grow(vec3(-0.5F));
        bounds.grow(vec3(0.5F));
    }
    for (Camera& camera : scene.cameras) {
        repair_camera(camera, bounds, scene.notes);
    }
    for (CameraPath& path : scene.paths) {
        for (Camera& frame : path.frames) {
            repair_camera(frame, bounds, scene.notes);
        }
    }
    // The whole from outside: the default view of a bare model, one more view, `overview`, of any other.
    make_names_unique(scene.cameras);
    const bool bare = scene.cameras.empty();
    const bool taken = std::any_of(scene.cameras.begin(), scene.cameras.end(),
                                   [](const Camera& camera) { return camera.name == "overview"; });
    if (bare || (!taken && !scene.closed_form && !scene.bounds_ws.empty())) {
        scene.cameras.push_back(frame_box(scene.bounds_ws.empty() ? bounds : main_bounds(scene)));
        scene.cameras.back().name = bare ? "main" : "overview";
        choose_range(scene.cameras.back(), bounds, false, false);
    }
}

}  // namespace gn
