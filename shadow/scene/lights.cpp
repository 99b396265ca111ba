// SPDX-License-Identifier: MIT
// Lights: repaired where their values make no sense, named apart, and a sun where there is none.
#include "base/error.h"
#include "shadow/scene/emission.h"
#include "shadow/scene/model.h"

#include <algorithm>
#include <map>
#include <set>

namespace gn {

namespace {

constexpr float brightest = 1e9F;          // the sun's disc has 1.6e9 cd/m^2; beyond, products overflow
constexpr float most_candela = 1e24F;      // a million lux at the farthest coordinate, 1e9 m
constexpr float widest_cone = 1.5F;        // rad: 86 degrees, half angle; at 90 a projection ceases to exist
constexpr float narrowest_cone = 0.0087F;  // rad: half a degree

class Repair {
  public:
    Repair(const Light& light, std::vector<std::string>& notes) : light_(light), notes_(notes) {}

    // The value moved into [low, high]; `fallback` for NaN.
    float within(float value, float low, float high, float fallback, const char* what) {
        const float repaired = std::isnan(value) ? fallback : std::clamp(value, low, high);
        if (repaired != value) {
            add_note(notes_,
                     fmt::format("Light '{}' had {} {:.4g}; {:.4g} is used.", light_.name, what, value, repaired));
        }
        return repaired;
    }

  private:
    const Light& light_;
    std::vector<std::string>& notes_;
};

void repair_spot(GnLight& shape, Repair& repair) {
    const float outer = std::acos(std::clamp(shape.cos_outer, -1.0F, 1.0F));
    const float inner = std::acos(std::clamp(shape.cos_inner, -1.0F, 1.0F));
    const float good_outer = repair.within(outer, narrowest_cone, widest_cone, 0.785F, "an outer cone (rad) of");
    // The soft rim needs some width, or its division has nothing to divide by.
    const float good_inner = inner < 0.999F * good_outer ? inner : 0.999F * good_outer;
    shape.cos_outer = good_outer == outer ? shape.cos_outer : std::cos(good_outer);
    shape.cos_inner = good_inner == inner ? shape.cos_inner : std::cos(good_inner);
}

// direction, right and up as an orthonormal frame; where one is made, right x up = -direction as for cameras.
void repair_axes(GnLight& shape) {
    // A frame that is already orthonormal stays bit for bit.
    const glm::mat3 frame{vec3(shape.right_ws), vec3(shape.up_ws), vec3(shape.direction_ws)};
    const glm::mat3 error = glm::transpose(frame) * frame - glm::mat3(1.0F);
    if (glm::dot(error[0], error[0]) + glm::dot(error[1], error[1]) + glm::dot(error[2], error[2]) < 1e-10F) {
        return;
    }

    vec3 direction(shape.direction_ws);
    direction = finite(direction) && glm::length(direction) > 1e-6F ? glm::normalize(direction) : vec3(0, -1, 0);
    vec3 up(shape.up_ws);
    up -= direction * glm::dot(direction, up);
    if (!finite(up) || glm::length(up) < 1e-4F) {
        vec3 other;
        complete_frame(direction, other, up);
    }
    up = glm::normalize(up);
    shape.direction_ws = vec4(direction, 0.0F);
    shape.up_ws = vec4(up, 0.0F);
    shape.right_ws = vec4(glm::cross(direction, up), 0.0F);
}

void repair_light(Light& light, std::vector<std::string>& notes) {
    Repair repair(light, notes);
    GnLight& shape = light.shape;
    repair_axes(shape);
    for (int axis = 0; axis < 3; ++axis) {
        shape.position_ws[axis] = repair.within(shape.position_ws[axis], -1e9F, 1e9F, 0.0F, "a coordinate");
        shape.color[axis] = repair.within(shape.color[axis], 0.0F, 1e4F, 0.0F, "a colour channel");
    }
    const bool candela = shape.kind == GN_LIGHT_SPOT || shape.kind == GN_LIGHT_POINT;
    const float most = candela ? most_candela : brightest;
    shape.intensity = repair.within(shape.intensity, 0.0F, most, 0.0F, "an intensity");
    shape.range = repair.within(shape.range, 0.0F, 1e9F, 0.0F, "a range (0 is unlimited)");
    shape.radius = repair.within(shape.radius, 0.0F, 1e9F, 0.0F, "a radius");
    shape.angular_radius = repair.within(shape.angular_radius, 0.0F, 1.5F, 0.0F, "an angular radius");
    if (shape.kind == GN_LIGHT_RECTANGLE) {
        shape.half_size.x = repair.within(shape.half_size.x, 1e-12F, 1e9F, 0.5F, "half a width");
        shape.half_size.y = repair.within(shape.half_size.y, 1e-12F, 1e9F, 0.5F, "half a height");
    }
    if (shape.kind == GN_LIGHT_SPOT) {
        repair_spot(shape, repair);
    }
}

// A clear day's sun, 50 degrees high, from the left behind the first camera's shoulder.
Light default_sun(const Camera& camera) {
    constexpr float elevation = 0.873F;
    vec3 ahead(camera.forward_ws.x, 0.0F, camera.forward_ws.z);
    ahead = glm::length(ahead) > 1e-3F ? glm::normalize(ahead) : vec3(0, 0, -1);
    const vec3 right = glm::cross(ahead, vec3(0, 1, 0));
    const vec3 level = glm::normalize(0.45F * ahead + right);
    Light sun{.name = "sun", .shape = {}};
    sun.shape.kind = GN_LIGHT_DIRECTIONAL;
    sun.shape.intensity = 100'000.0F;
    sun.shape.color = vec4(1.0F, 0.96F, 0.9F, 1.0F);
    sun.shape.angular_radius = 0.00465F;
    sun.shape.direction_ws = vec4(std::cos(elevation) * level - vec3(0, std::sin(elevation), 0), 0.0F);
    repair_axes(sun.shape);
    return sun;
}

}  // namespace

void add_default_sun(Scene& scene) {
    if (scene.lights.empty()) {
        scene.lights.push_back(default_sun(scene.cameras.front()));
    }
}

void complete_lights(Scene& scene) {
    // Lights are asked for by name: a second "lamp" becomes "lamp 2". Numbers of a name only grow, so that thousands of
    // lamps take no longer than their sum.
    std::set<std::string, std::less<>> taken;
    std::map<std::string, int, std::less<>> numbers;
    for (Light& light : scene.lights) {
        const std::string base = light.name.empty() ? "light" : light.name;
        light.name = base;
        for (int& number = numbers.try_emplace(base, 1).first->second; taken.contains(light.name);) {
            light.name = fmt::format("{} {}", base, ++number);
        }
        taken.insert(light.name);
        repair_light(light, scene.notes);
        complete_emission(scene, light);
    }
}

}  // namespace gn
