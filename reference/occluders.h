// SPDX-License-Identifier: MIT
// The scene as Embree sees it, with the question that the truth asks: is the open segment from p towards the light
// blocked? Both sides of a triangle block, or the front alone where its material has one side; alpha-tested texels that are
// not there do not, nor does what casts no shadow of the light.
//
// Self-intersection. In exact arithmetic a ray that starts on a plane never meets that plane again, so a hit on any
// triangle whose plane holds p is a rounding error and is rejected, at whatever distance. "Holds" is decided in double
// precision: the vertices are exact as they stand, but sheets that were meant to be one plane were rounded to floats, half
// a unit an axis. A plane feels the rounding of an axis by its normal's share of it, so that a level ground of 100 km is
// exact and a slab a millimetre above it is a caster, while a turned one is known to units of its coordinates. The limit is
// that of p and of the triangle that is hit; nothing else in the scene matters.
//
// Nor does a ray that rises from p's plane ever meet what lies wholly on or below it: the wall that hangs down from the edge of
// a wide block, which the ray passes above by less than the wall's rounding. Such hits are rejected likewise, by their corners'
// heights above p's plane.
//
// What is left are triangles that meet p's plane at an angle, near the edge. There the origin must not sink under p's
// plane, so it is raised along the geometric normal by origin_ulps such units: rounding it moves it by half a unit an axis.
//
// The light's end. A ray is traced a little beyond the light, and a hit near its end is asked in double precision on which side
// of the triangle's plane the light lies: a triangle blocks where the segment from p to the light crosses its plane. The light
// is known to end_ulps units: half of one by its own rounding, half by the plane's, three by the float direction and distance
// that lead to it.
#pragma once

#include "shadow/scene/scene.h"

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <vector>

namespace gn {

inline constexpr double plane_ulps = 1.5;
inline constexpr double origin_ulps = 4;
/// How far a view sample may be from its surface, for seating: interpolated positions err by units of the vertices.
inline constexpr double seat_ulps = 64;
/// How exactly the end of a ray at a light is known, of its coordinates and of its distance.
inline constexpr double end_ulps = 4;
/// How far beyond a light its rays are traced, and how near to it hits are asked for their side: as much as the ray tracer's
/// distances may be off, in units of the largest of distance and coordinates.
inline constexpr double hit_ulps = 64;

/// One unit of float precision at a magnitude.
inline double ulps_at(double count, double magnitude) {
    return count * 0x1p-23 * magnitude;
}
/// What that many units of float precision on every axis of `magnitude` come to along the unit vector n: rounding moves a
/// plane of that normal no farther. Never less than double precision needs.
inline double ulps_along(double count, dvec3 n, dvec3 magnitude) {
    const dvec3 each = glm::abs(n) * magnitude;
    return ulps_at(count, each.x + each.y + each.z) + 0x1p-40 * std::max({magnitude.x, magnitude.y, magnitude.z});
}
inline double largest(dvec3 v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// A receiver's point, ready for rays.
struct Seat {
    dvec3 p_ws;                                        ///< on the plane of its triangle
    vec3 origin_ws;                                    ///< a hair above it
    std::uint32_t triangle = RTC_INVALID_GEOMETRY_ID;  ///< its triangle, which never hides it; invalid: none was found
    dvec3 n_ws{0};                                     ///< unit normal of its triangle, above it; null: none was found
};

/// Rays that are traced together, from one seat.
template <int Width>
struct alignas(64) Packet {
    RTCRayNt<Width> rays;                 ///< each traced to a little beyond the light
    std::array<float, Width> distance{};  ///< to the light
    std::array<vec3, Width> tint{};       ///< what the translucent surfaces on a ray's way let through; 1 where none is
};

/// Which objects block: one byte an object.
enum class Blocks : std::uint8_t { nothing, all, tinted };
using Blockers = std::vector<Blocks>;

class Occluders {
  public:
    explicit Occluders(const Scene& scene);
    ~Occluders();
    Occluders(const Occluders&) = delete;
    Occluders& operator=(const Occluders&) = delete;

    /// 16, 8 or 4: how many rays the machine traces at once.
    [[nodiscard]] int width() const { return width_; }
    /// Moves p along its normal onto the nearest triangle that faces along it, if one is within precision.
    [[nodiscard]] Seat seat(dvec3 p_ws, dvec3 n_ws) const;
    /// What casts shadows of a light; of any light where it is null. With colours translucent objects tint, else they
    /// block nothing.
    [[nodiscard]] Blockers blockers(const Light* light, bool colours = false) const;
    /// Nothing at all.
    [[nodiscard]] Blockers no_blockers() const { return Blockers(scene_.objects.size(), Blocks::nothing); }
    /// Traces a packet from one seat; afterwards tfar < 0 where something blocks. Width is 1, 4, 8 or 16.
    template <int Width>
    void trace(const Seat& seat, const Blockers& blockers, const int* valid, Packet<Width>& packet) const;

  private:
    struct Query;
    struct SeatQuery;
    struct Alpha;

    void copy_geometry();
    [[nodiscard]] std::array<dvec3, 3> corners(std::uint32_t triangle) const;
    [[nodiscard]] bool holds(std::uint32_t triangle, dvec3 p_ws) const;
    [[nodiscard]] bool below(std::uint32_t triangle, const Seat& seat) const;
    [[nodiscard]] bool beyond(std::uint32_t triangle, dvec3 origin_ws, dvec3 light_ws) const;
    [[nodiscard]] bool transparent(std::uint32_t triangle, float u, float v) const;
    [[nodiscard]] bool seen_from_behind(std::uint32_t triangle, dvec3 towards_light) const;
    static void reject(const RTCFilterFunctionNArguments* arguments);
    static void find_seat(const RTCFilterFunctionNArguments* arguments);

    const Scene& scene_;
    RTCDevice device_ = nullptr;
    RTCScene bvh_ = nullptr;
    int width_ = 4;
    std::vector<std::uint32_t> object_;  ///< per triangle
    double largest_coordinate_ = 0;
};

}  // namespace gn
