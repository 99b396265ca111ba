// SPDX-License-Identifier: MIT
#include "scenes/analytic.h"

#include "scenes/mesh_builder.h"

#include <algorithm>

namespace gn::scenes {
namespace {

constexpr double touching = 1e-4;  // metres: a receiver this near to a surface lies on it

bool is_rectangle(const GnLight& light) {
    return light.kind == uint(GN_LIGHT_RECTANGLE);
}
bool is_directional(const GnLight& light) {
    return light.kind == uint(GN_LIGHT_DIRECTIONAL);
}

bool has_size(const GnLight& light) {
    if (is_rectangle(light)) {
        return light.half_size.x > 0 || light.half_size.y > 0;
    }
    return is_directional(light) ? light.angular_radius > 0 : light.radius > 0;
}

// From p towards the (only) point of a light of size zero; one unit of the parameter reaches it, or infinity.
dvec3 segment_to(const GnLight& light, dvec3 p) {
    return is_directional(light) ? -dvec3(light.direction_ws) * 1e6 : dvec3(light.position_ws) - p;
}

double hard_sheet_visibility(const GnLight& light, std::span<const Sheet> sheets, dvec3 p) {
    const dvec3 d = segment_to(light, p);
    for (const Sheet& s : sheets) {
        const double t = (s.y - p.y) / d.y;
        const dvec2 hit = dvec2(p.x, p.z) + t * dvec2(d.x, d.z);
        if (s.y > p.y + touching && t < 1 && glm::all(glm::lessThan(s.low, hit)) &&
            glm::all(glm::lessThan(hit, s.high))) {
            return 0;
        }
    }
    return 1;
}

// A rectangle on the light's plane, relative to the light's centre.
struct Patch {
    dvec2 low, high;
};

// The sheet's shadow volume from p cuts the light's plane in p + (q - p) (y_light - p.y) / (y_sheet - p.y): similar
// triangles, so level sheets stay rectangles with the same axes.
std::vector<Patch> project(const GnLight& light, std::span<const Sheet> sheets, dvec3 p) {
    const dvec2 centre(light.position_ws.x, light.position_ws.z);
    const dvec2 at(p.x, p.z);
    std::vector<Patch> patches;
    for (const Sheet& s : sheets) {
        if (s.y <= p.y + touching) {
            continue;
        }
        const double scale = (light.position_ws.y - p.y) / (s.y - p.y);
        patches.push_back({at + (s.low - at) * scale - centre, at + (s.high - at) * scale - centre});
    }
    return patches;
}

// Area of a rectangle's part of the light, of the whole light's area.
double light_fraction(const GnLight& light, dvec2 low, dvec2 high) {
    if (is_rectangle(light)) {
        const dvec2 half(light.half_size);
        const dvec2 size = glm::max(glm::min(high, half) - glm::max(low, -half), dvec2(0));
        return size.x * size.y / (4 * half.x * half.y);
    }
    const dvec2 a = low / static_cast<double>(light.radius), b = high / static_cast<double>(light.radius);
    return (unit_disc_area(b.x, b.y) - unit_disc_area(a.x, b.y) - unit_disc_area(b.x, a.y) + unit_disc_area(a.x, a.y)) /
           std::numbers::pi;
}

}  // namespace

double unit_disc_area(double x, double z) {
    // Below a negative chord lies what lies above the mirrored one.
    const auto slice = [](double t) { return 0.5 * (t * std::sqrt(std::max(1 - t * t, 0.0)) + std::asin(t)); };
    const double right = std::clamp(x, -1.0, 1.0);
    const double chord = std::clamp(z, -1.0, 1.0);
    const double lower_and_upper = 2 * (slice(right) - slice(-1));
    if (chord < 0) {
        return lower_and_upper - unit_disc_area(right, -chord);
    }
    // Lower half in full; of the upper half what lies under the chord, which leaves the disc at |x| = c.
    const double c = std::sqrt(1 - chord * chord);
    double upper = slice(std::min(right, -c)) - slice(-1);
    upper += chord * (std::clamp(right, -c, c) + c);
    upper += slice(std::max(right, c)) - slice(c);
    return 0.5 * lower_and_upper + upper;
}

std::optional<double> sheet_visibility(const GnLight& light, std::span<const Sheet> sheets, dvec3 p) {
    if (!has_size(light)) {
        return hard_sheet_visibility(light, sheets, p);
    }
    const bool level = light.direction_ws.y == -1.0F && p.y < light.position_ws.y;
    if (!level || is_directional(light) || light.kind == uint(GN_LIGHT_POINT)) {
        return std::nullopt;
    }
    // Cut the plane into cells along all borders, so that overlapping sheets count once (occluder fusion).
    const std::vector<Patch> patches = project(light, sheets, p);
    std::vector<double> xs, zs;
    for (const Patch& patch : patches) {
        xs.insert(xs.end(), {patch.low.x, patch.high.x});
        zs.insert(zs.end(), {patch.low.y, patch.high.y});
    }
    std::sort(xs.begin(), xs.end());
    std::sort(zs.begin(), zs.end());
    double hidden = 0;
    for (std::size_t i = 1; i < xs.size(); ++i) {
        for (std::size_t k = 1; k < zs.size(); ++k) {
            const dvec2 middle(0.5 * (xs[i - 1] + xs[i]), 0.5 * (zs[k - 1] + zs[k]));
            const bool covered = std::any_of(patches.begin(), patches.end(), [&](const Patch& patch) {
                return glm::all(glm::lessThan(patch.low, middle)) && glm::all(glm::lessThan(middle, patch.high));
            });
            hidden += covered ? light_fraction(light, {xs[i - 1], zs[k - 1]}, {xs[i], zs[k]}) : 0;
        }
    }
    return 1 - hidden;
}

std::optional<double> box_visibility(const GnLight& light, std::span<const SolidBox> boxes, dvec3 p) {
    if (has_size(light)) {
        return std::nullopt;
    }
    const dvec3 d = segment_to(light, p);
    const double reach = is_directional(light) ? 1 : 1 - touching / glm::length(d);
    for (const SolidBox& b : boxes) {
        // The segment's stretch inside the box, shrunk so that a receiver on a face does not shadow itself.
        const dvec3 t0 = (b.low + touching - p) / d, t1 = (b.high - touching - p) / d;
        const dvec3 near = glm::min(t0, t1), far = glm::max(t0, t1);
        const double enter = std::max({near.x, near.y, near.z, 0.0});
        const double leave = std::min({far.x, far.y, far.z, reach});
        if (enter < leave) {
            return 0;
        }
    }
    return 1;
}

std::vector<ParamRow> overhead_light_rows() {
    return {
        GN_CHOICE(GnOverheadLightParams, light, "The kind of light that hangs above the scene.", "rectangle", "spot",
                  "point", "directional"),
        GN_PARAM(GnOverheadLightParams, radius, real, 0, 1.5, "m",
                 "Half the light's width: wider penumbrae; 0 is a hard shadow."),
        GN_PARAM(GnOverheadLightParams, hard, boolean, 0, 1, "", "A light of size zero at the same place."),
    };
}

Light overhead_light(const GnOverheadLightParams& params, float height) {
    const float illuminance = 1000;  // lux at the origin
    const float radius = params.hard != 0 ? 0.0F : params.radius;
    Light light;
    light.name = "key";
    light.shape.position_ws = vec4(0, height, 0, 0);
    light.shape.direction_ws = vec4(0, -1, 0, 0);
    light.shape.intensity = illuminance * height * height;
    light.shape.radius = radius;
    switch (params.light) {
        case 0:
            // A rectangle without area is no light: a spot of radius zero takes its place.
            if (radius > 0) {
                light.shape.kind = GN_LIGHT_RECTANGLE;
                light.shape.half_size = vec2(radius);
                light.shape.radius = 0;
                light.shape.intensity /= 4 * radius * radius;
                break;
            }
            [[fallthrough]];
        case 1:
            light.shape.kind = GN_LIGHT_SPOT;
            light.shape.cos_inner = std::cos(glm::radians(48.0F));
            light.shape.cos_outer = std::cos(glm::radians(52.0F));
            break;
        case 2: light.shape.kind = GN_LIGHT_POINT; break;
        default:
            light.shape.kind = GN_LIGHT_DIRECTIONAL;
            light.shape.intensity = illuminance;
            light.shape.radius = 0;
            light.shape.angular_radius = std::atan(radius / height);
    }
    return light;
}

Light directional_light(std::string name, vec3 to_light, float lux, float radius_degrees, vec3 color) {
    Light light;
    light.name = std::move(name);
    light.shape.kind = GN_LIGHT_DIRECTIONAL;
    light.shape.direction_ws = vec4(-glm::normalize(to_light), 0);
    light.shape.color = vec4(color, 1);
    light.shape.intensity = lux;
    light.shape.angular_radius = glm::radians(radius_degrees);
    return light;
}

Light rectangle_light(std::string name, vec3 at, vec3 target, vec2 half_size, float candela_per_m2, vec3 color) {
    Light light;
    light.name = std::move(name);
    light.shape.kind = GN_LIGHT_RECTANGLE;
    const vec3 forward = glm::normalize(target - at);
    vec3 right, up;
    complete_frame(forward, right, up);
    light.shape.position_ws = vec4(at, 0);
    light.shape.direction_ws = vec4(forward, 0);
    light.shape.right_ws = vec4(right, 0);
    light.shape.up_ws = vec4(up, 0);
    light.shape.half_size = half_size;
    light.shape.intensity = candela_per_m2;
    light.shape.color = vec4(color, 1);
    return light;
}

Light spot_light(std::string name, vec3 at, vec3 target, float radius, float candela, float outer_degrees, vec3 color) {
    Light light;
    light.name = std::move(name);
    light.shape.kind = GN_LIGHT_SPOT;
    light.shape.position_ws = vec4(at, 0);
    light.shape.direction_ws = vec4(glm::normalize(target - at), 0);
    light.shape.radius = radius;
    light.shape.intensity = candela;
    light.shape.cos_inner = std::cos(glm::radians(0.9F * outer_degrees));
    light.shape.cos_outer = std::cos(glm::radians(outer_degrees));
    light.shape.color = vec4(color, 1);
    return light;
}

int raster_columns(int count) {
    return static_cast<int>(std::ceil(std::sqrt(static_cast<float>(count))));
}

vec2 raster_cell(int i, int count) {
    const int columns = raster_columns(count);
    const int rows = (count + columns - 1) / columns;
    const int row = i / columns;
    const int in_row = std::min(columns, count - row * columns);
    return {static_cast<float>(i % columns) - 0.5F * static_cast<float>(in_row - 1),
            static_cast<float>(row) - 0.5F * static_cast<float>(rows - 1)};
}

Camera look_at(std::string name, vec3 eye, vec3 target, float yfov_degrees, float near, float far) {
    Camera camera;
    camera.name = std::move(name);
    camera.position_ws = eye;
    camera.forward_ws = glm::normalize(target - eye);
    camera.up_ws = std::abs(camera.forward_ws.y) > 0.99F ? vec3(0, 0, -1) : vec3(0, 1, 0);
    camera.yfov = glm::radians(yfov_degrees);
    camera.near = near;
    camera.far = far;
    return camera;
}

void add_boxes(MeshBuilder& builder, std::span<const SolidBox> boxes) {
    for (const SolidBox& b : boxes) {
        builder.box(vec3(b.low), vec3(b.high));
    }
}

double contact_scene::distance_to_foot(dvec3 p) {
    const dvec2 out = glm::max(glm::abs(dvec2(p.x, p.z)) - half_width, dvec2(0));
    return glm::length(out);
}

bool contact_scene::well_in_shadow(const GnLight& light, dvec3 p, double margin) {
    // The shadow shrunk by the margin is the set whose neighbours at that distance, across the light, are dark too.
    const SolidBox box{{-half_width, 0, -half_width}, {half_width, height, half_width}};
    const dvec3 across = glm::normalize(dvec3(-light.direction_ws.z, 0, light.direction_ws.x)) * margin;
    return box_visibility(light, {&box, 1}, p) == 0.0 && box_visibility(light, {&box, 1}, p + across) == 0.0 &&
           box_visibility(light, {&box, 1}, p - across) == 0.0;
}

double contact_scene::gap(const GnLight& light, std::span<const vec4> position_ws, std::span<const float> visibility,
                          double reach, double margin) {
    GN_CHECK_EQ(position_ws.size(), visibility.size());
    double widest = 0;
    for (std::size_t i = 0; i < position_ws.size(); ++i) {
        const dvec3 p(position_ws[i]);
        const bool on_ground = position_ws[i].w > 0 && std::abs(p.y) < touching;
        if (on_ground && visibility[i] > 0.5F && distance_to_foot(p) < reach && well_in_shadow(light, p, margin)) {
            widest = std::max(widest, distance_to_foot(p));
        }
    }
    return widest;
}

}  // namespace gn::scenes
