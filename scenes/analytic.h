// SPDX-License-Identifier: MIT
// Closed forms of visibility, and the measures of the analytic scenes that tests need.
//
// World space, metres. "Sheets" are level rectangles; "boxes" are axis-aligned solids.
#pragma once

#include "base/param.h"
#include "shadow/scene/scene.h"

#include <optional>
#include <span>
#include <vector>

namespace gn::scenes {

class MeshBuilder;

/// A level rectangle at height y that blocks light.
struct Sheet {
    double y = 0;
    dvec2 low{0}, high{0};  ///< x and z
};

/// V of the light at p above which only `sheets` block. A closed form exists for lights of size zero, and for a
/// rectangle (axes along x and z) or a spot's disc that lies level above all sheets and shines straight down.
std::optional<double> sheet_visibility(const GnLight& light, std::span<const Sheet> sheets, dvec3 p_ws);

struct SolidBox {
    dvec3 low{0}, high{0};
};

/// V of a light of size zero at p, on or outside the boxes; nothing for a light that has a size.
std::optional<double> box_visibility(const GnLight& light, std::span<const SolidBox> boxes, dvec3 p_ws);

/// Area of the unit disc left of x and below z, by which discs are clipped against rectangles.
double unit_disc_area(double x, double z);

/// How a scene's main light was asked for: shared by the scenes lit from straight above.
struct GnOverheadLightParams {
    int light = 0;  ///< index into the choices rectangle, spot, point, directional
    float radius =
        0.5F;  ///< half the side of the rectangle, or the radius of disc, sphere or (seen from the ground) sun
    int hard = 0;
};
std::vector<ParamRow> overhead_light_rows();
/// A light `height` metres above the origin that gives 1000 lux there.
Light overhead_light(const GnOverheadLightParams& params, float height);

/// A sun by the direction towards it, with its angular radius in degrees.
Light directional_light(std::string name, vec3 to_light, float lux, float radius_degrees, vec3 color = vec3(1));

/// A rectangle that shines from `at` towards `target`.
Light rectangle_light(std::string name, vec3 at, vec3 target, vec2 half_size, float candela_per_m2,
                      vec3 color = vec3(1));

/// A spot with a disc of a radius that shines from `at` towards `target`; its cone begins to fade at nine tenths of its half
/// angle.
Light spot_light(std::string name, vec3 at, vec3 target, float radius, float candela, float outer_degrees,
                 vec3 color = vec3(1));

/// Where thing i of `count` stands in a square raster of cells of size one around the origin; rows that are not full stand in
/// the middle too.
vec2 raster_cell(int i, int count);
/// Cells of the raster along x.
int raster_columns(int count);

Camera look_at(std::string name, vec3 eye, vec3 target, float yfov_degrees, float near, float far);

/// Adds one closed mesh per box under one object name, and returns the boxes as the closed form sees them.
void add_boxes(MeshBuilder& builder, std::span<const SolidBox> boxes);

/// Lauritzen's figure 3.4: A casts a shadow on B, B hides C.
/// Based on: Lauritzen. Rendering Antialiased Shadows using Warped Variance Shadow Maps. Waterloo 2008. [Lau08]
namespace stack_scene {
inline constexpr double height_a = 3.0, height_b = 1.6, height_c = 0.0;  ///< metres above the ground
inline constexpr double dx = height_a - height_b;                        ///< of eq. 3.4: from A down to B
inline constexpr double dy = height_b - height_c;                        ///< of eq. 3.4: from B down to C
inline constexpr double edge_x = 0.0;                                    ///< A covers x < edge_x
inline constexpr double half_width_b = 1.2;                              ///< B covers |x|, |z| < half_width_b
/// What a variance map whose filter is centred on the edge of A lets through to depth dy below B (eq. 3.4); truth is 0.
constexpr double bleeding(double below_b) {
    return 0.25 * dx * dx / (0.5 * dx * dx + dx * below_b + below_b * below_b);
}
/// The share of the filter that A covers where most is let through to depth dy below B, and what it is there.
constexpr double worst_share(double below_b) {
    return below_b / (dx + 2 * below_b);
}
constexpr double worst_bleeding(double below_b) {
    const double ratio = dx / (dx + 2 * below_b);
    return ratio * ratio;
}
}  // namespace stack_scene

/// The box on the ground of the scene `contact`, and the gap between its foot and the shadow.
namespace contact_scene {
inline constexpr double half_width = 0.5;  ///< |x|, |z| < half_width
inline constexpr double height = 1.0;
/// Distance on the ground from p to the foot of the box.
double distance_to_foot(dvec3 p_ws);
/// Whether p on the ground lies behind the box, at least `margin` metres inside the true hard shadow's sides.
bool well_in_shadow(const GnLight& light, dvec3 p_ws, double margin);
/// The gap, metres: how far from the foot light (V > 0.5) still leaks into the true shadow. Samples off the ground,
/// further than `reach` from the foot or nearer than `margin` to the shadow's sides do not count.
double gap(const GnLight& light, std::span<const vec4> position_ws, std::span<const float> visibility,
           double reach = 0.3, double margin = 0.1);
}  // namespace contact_scene

}  // namespace gn::scenes
