// SPDX-License-Identifier: MIT
// Lights, cameras and costs.
#include "apps/terminal.h"
#include "apps/view/camera_control.h"
#include "apps/view/panel.h"
#include "apps/view/viewer.h"
#include "apps/view/widgets.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

/// A direction as two angles: turned about the vertical, and how high it comes from; degrees.
struct Angles {
    float azimuth = 0, elevation = 0;
};
Angles angles_of(vec3 direction_ws) {
    return {glm::degrees(std::atan2(-direction_ws.x, -direction_ws.z)),
            glm::degrees(std::asin(std::clamp(-direction_ws.y, -1.0F, 1.0F)))};
}
vec3 direction_of(const Angles& angles) {
    const float a = glm::radians(angles.azimuth), e = glm::radians(angles.elevation);
    return -vec3(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
}

bool direction_rows(GnLight& light) {
    Angles angles = angles_of(vec3(light.direction_ws));
    bool changed = slider_row("light.azimuth", "azimuth", angles.azimuth, -180, 180, "%.1f deg",
                              "Whence it shines, about the vertical.");
    changed =
        slider_row("light.elevation", "elevation", angles.elevation, -90, 90, "%.1f deg", "How high it stands.") ||
        changed;
    if (changed) {
        angles.elevation = std::clamp(angles.elevation, -89.9F, 89.9F);
        point_light(light, direction_of(angles));
    }
    return changed;
}

bool place_rows(GnLight& light, const Box& bounds) {
    bool changed = false;
    const vec3 margin = 0.5F * (bounds.max - bounds.min) + 1e-3F;
    for (int axis = 0; axis < 3; ++axis) {
        const std::string name(1, "xyz"[axis]), key = "light." + name;
        changed = slider_row(key.c_str(), name.c_str(), light.position_ws[axis], bounds.min[axis] - margin[axis],
                             bounds.max[axis] + margin[axis], "%.3f m", "Where it stands.") ||
                  changed;
    }
    return changed;
}

bool size_row(GnLight& light, float scene_size) {
    if (light.kind == GN_LIGHT_DIRECTIONAL) {
        float degrees = glm::degrees(light.angular_radius);
        if (slider_row("light.size", "angular radius", degrees, 0, 10, "%.3f deg",
                       "Of the disc that receivers see: wider penumbrae.", true)) {
            light.angular_radius = glm::radians(degrees);
            return true;
        }
        return false;
    }
    return light.kind != GN_LIGHT_RECTANGLE && slider_row("light.size", "radius", light.radius, 0, 0.05F * scene_size,
                                                          "%.4f m", "Of its disc or sphere: wider penumbrae.", true);
}

}  // namespace

void draw_light_section(Viewer& viewer) {
    World& world = viewer.world();
    if (!section("Light", false) || world.scene.lights.empty()) {
        return;
    }
    std::vector<std::string> names;
    for (const Light& light : world.scene.lights) {
        names.push_back(light.name);
    }
    std::string name = names.at(viewer.light);
    if (choice_row("light.name", "light", name, names,
                   "The one that is moved, and that errors and hidden pictures are of.")) {
        viewer.light = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    }
    Light& light = world.scene.lights.at(viewer.light);
    GnLight shape = light.shape;
    told_row("kind", std::string(light_kind_names.at(shape.kind)));
    bool changed = shape.kind != GN_LIGHT_POINT && direction_rows(shape);
    changed = (shape.kind != GN_LIGHT_DIRECTIONAL && place_rows(shape, world.scene.bounds_ws)) || changed;
    changed = slider_row("light.intensity", "intensity", shape.intensity, 0,
                         10.0F * std::max(world.as_loaded.at(viewer.light).shape.intensity, 1.0F), "%.4g",
                         "lux of a sun, candela of a lamp.", true) ||
              changed;
    changed = size_row(shape, world.size()) || changed;
    if (button("light.reset", "As it was", "The light as the scene has it.")) {
        shape = world.as_loaded.at(viewer.light).shape;
        changed = true;
    }
    if (changed) {
        light.shape = shape;
        ++world.lights_version;
    }
}

void draw_camera_section(Viewer& viewer) {
    if (!section("Camera", false)) {
        return;
    }
    const Scene& scene = viewer.world().scene;
    std::vector<std::string> names;
    for (const Camera& camera : scene.cameras) {
        names.push_back(camera.name);
    }
    Camera camera = viewer.viewport(viewer.selected).camera;
    // Cameras of paths have names of their own.
    std::string name = std::find(names.begin(), names.end(), camera.name) != names.end() ? camera.name : names.front();
    if (choice_row("camera", "view", name, names, "A camera of the scene.") ||
        button("camera.reset", "Back to it", "The view as the scene has it.")) {
        viewer.set_camera(viewer.selected, scene.camera(name), true);
        return;
    }
    bool changed = false;
    if (!is_orthographic(camera)) {
        float degrees = glm::degrees(camera.yfov);
        if (slider_row("camera.yfov", "field of view", degrees, 5, 120, "%.1f deg",
                       "From the lower edge to the upper one.")) {
            camera.yfov = glm::radians(degrees);
            changed = true;
        }
    }
    changed = slider_row("camera.near", "near", camera.near, 1e-5F * camera.far, 0.1F * camera.far, "%.4f m",
                         "What is nearer is cut away.", true) ||
              changed;
    told_row("stands at",
             fmt::format("{:.2f} {:.2f} {:.2f}", camera.position_ws.x, camera.position_ws.y, camera.position_ws.z));
    if (changed) {
        viewer.set_camera(viewer.selected, camera, false);
    }
    if (scene.paths.empty()) {
        sentence("This scene has no camera path to play; corridor has one.", false);
    } else {
        check_row("camera.plays", "play path", viewer.plays,
                  "Follows the scene's camera path. The space bar does the same.");
        told_row("frame", fmt::format("{} of {}", viewer.path_frame + 1, scene.paths.front().frames.size()));
    }
    sentence(
        "Left drag looks around, right drag orbits, middle drag slides, the wheel goes forward; W A S D Q E fly, Shift "
        "faster. Ctrl and drag moves the light. Tab hides the panel.",
        false);
}

void draw_animation_section(Viewer& viewer) {
    const Rig& rig = viewer.world().loaded.rig;
    if (!rig.moves() || !section("Animation", true)) {
        return;
    }
    const std::string at_rest = "at rest";
    std::vector<std::string> names{at_rest};
    for (const Animation& animation : rig.animations) {
        names.push_back(animation.name);
    }
    const FileOptions& now = viewer.world().file;
    std::string name = now.animation.empty() ? at_rest : rig.animations[find_animation(rig, now.animation)].name;
    if (choice_row("animation", "animation", name, names, "What moves; or everything as the file has it at rest.")) {
        viewer.animates = viewer.animates && name != at_rest;
        viewer.set_pose(name == at_rest ? "" : name, 0);
        return;
    }
    check_row("animation.plays", "play", viewer.animates, "Goes on with every frame. The space bar does the same.");
    if (!now.animation.empty()) {
        auto seconds = static_cast<float>(now.time);
        const auto length = static_cast<float>(rig.animations[find_animation(rig, now.animation)].seconds);
        if (slider_row("animation.time", "time", seconds, 0, length, "%.3f s", "Since the animation's begin.")) {
            viewer.set_pose(now.animation, static_cast<double>(std::clamp(seconds, 0.0F, length)));
        }
    }
    slider_row("animation.speed", "speed", viewer.speed, 0.05F, 4, "%.2f", "Seconds of the animation in one second.",
               true);
}

void draw_cost_section(Viewer& viewer) {
    if (!section("Costs", false)) {
        return;
    }
    const Viewport& viewport = viewer.viewport(viewer.selected);
    const GraphStatistics& costs = viewport.costs();
    if (!viewer.device().has(Feature::timestamps)) {
        check_row("measures", "time passes", viewer.measures,
                  "This device tells no times of passes, so that each is submitted by itself and waited for: frames "
                  "take longer.");
    }
    // Times: means over ten frames; bars against the longest.
    const auto longest = std::max_element(costs.passes.begin(), costs.passes.end(),
                                          [](const auto& a, const auto& b) { return a.ms < b.ms; });
    double shadow = 0, frame = 0;
    for (const PassTime& pass : costs.passes) {
        frame += pass.ms;
        shadow += pass.group == "shadow" ? pass.ms : 0.0;
    }
    if (frame > 0) {
        told_row("shadow, frame", fmt::format("{:.2f} ms, {:.2f} ms", shadow, frame),
                 "All passes of the group shadow; all passes. Means over ten frames.");
        for (const PassTime& pass : costs.passes) {
            bar(pass.name, fmt::format("{:.2f} ms", pass.ms), static_cast<float>(pass.ms / longest->ms),
                pass.group == "shadow");
        }
    }
    // Bytes of what shadows take.
    VkDeviceSize most = 1, sum = 0;
    for (const ResourceBytes& resource : costs.resources) {
        most = resource.group == "shadow" ? std::max(most, resource.bytes) : most;
        sum += resource.group == "shadow" ? resource.bytes : 0;
    }
    told_row("map", fmt::format("{} texels a side",
                                viewport.recipe.asked().map != nullptr ? viewport.recipe.asked().resolution : 0));
    told_row("shadow, frame", fmt::format("{}, {}", human_bytes(sum), human_bytes(costs.transient_bytes)),
             "What shadows take by their formats; memory of the whole frame, shared where lives do not overlap.");
    for (const ResourceBytes& resource : costs.resources) {
        if (resource.group == "shadow") {
            bar(resource.name, human_bytes(resource.bytes),
                static_cast<float>(resource.bytes) / static_cast<float>(most), true);
        }
    }
}

}  // namespace gn
