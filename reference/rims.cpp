// SPDX-License-Identifier: MIT
#include "reference/rims.h"

#include "base/error.h"
#include "base/sobol.h"
#include "reference/rays.h"

#include <array>
#include <atomic>

namespace gn {
namespace {

/// Points of [-1,1]^2 in an order whose every beginning covers the square evenly.
std::array<vec2, rim_rays> spread_points() {
    std::array<vec2, rim_rays> points{};
    for (std::uint32_t i = 0; i < rim_rays; ++i) {
        points[i] = 2.0F * sobol_owen(i, 0) - 1.0F;
    }
    return points;
}

/// The rays around one sample.
struct Around {
    const Occluders& occluders;
    const Blockers& blockers;
    Seat seat;
    vec3 n_ws;
    Surroundings axes;
    const GnLight& light;

    [[nodiscard]] LightPoint centre_from(vec3 p_ws) const { return sample_light(light, p_ws, vec2(0.5F)); }

    /// Where the ray through p + offset meets the tangent plane, and how far that is from the sample.
    void aim_from(Packet<16>& packet, int lane, vec2 at) const {
        const vec3 offset_ws = at.x * axes.a_ws + at.y * axes.b_ws;
        const vec3 beside_ws = seat.origin_ws + offset_ws;
        const vec3 to_light_ws = centre_from(beside_ws).direction_ws;
        const float along = -glm::dot(n_ws, offset_ws) / glm::dot(n_ws, to_light_ws);
        const vec3 from_p_ws = offset_ws + along * to_light_ws;
        const vec3 q_ws = seat.origin_ws + from_p_ws;
        aim(packet, lane, q_ws, centre_from(q_ws), rim_clearance * glm::length(from_p_ws));
    }

    [[nodiscard]] bool any_blocked(std::span<const vec2> points) const {
        Packet<16> packet;
        const RTCRayNt<16>& rays = packet.rays;
        alignas(64) std::array<int, 16> valid{};
        for (std::size_t first = 0; first < points.size(); first += 16) {
            for (int lane = 0; lane < 16; ++lane) {
                aim_from(packet, lane, points[first + static_cast<std::size_t>(lane)]);
                valid[static_cast<std::size_t>(lane)] = rays.tnear[lane] < rays.tfar[lane] ? -1 : 0;
            }
            occluders.trace(seat, blockers, valid.data(), packet);
            if (std::any_of(std::begin(rays.tfar), std::end(rays.tfar), [](float end) { return end < 0.0F; })) {
                return true;
            }
        }
        return false;
    }
};

bool has_rim(const Occluders& occluders, const Blockers& blockers, vec4 position_ws, vec4 normal_ws,
             const Surroundings& axes, const GnLight& light, std::span<const vec2> points) {
    const vec3 p_ws(position_ws);
    const vec3 n_ws(normal_ws);
    const bool asked = glm::length(axes.a_ws) + glm::length(axes.b_ws) > 0.0F;
    if (!asked || !(position_ws.w > 0.0F) || !finite(p_ws) || !gn_counted(light, p_ws, n_ws)) {
        return false;
    }
    const Seat seat = occluders.seat(dvec3(p_ws), glm::normalize(dvec3(n_ws)));
    return Around{occluders, blockers, seat, glm::normalize(n_ws), axes, light}.any_blocked(points);
}

}  // namespace

std::vector<std::uint8_t> find_rims(const Occluders& occluders, std::span<const vec4> position_ws,
                                    std::span<const vec4> normal_ws, std::span<const Surroundings> around,
                                    const Light& light, int threads, bool (*asked_to_stop)()) {
    GN_CHECK_EQ(position_ws.size(), normal_ws.size());
    GN_CHECK_EQ(position_ws.size(), around.size());
    static const std::array<vec2, rim_rays> points = spread_points();
    std::vector<std::uint8_t> rims(around.size(), 0);
    const Blockers blockers = occluders.blockers(&light);
    std::atomic<std::size_t> next_tile = 0;
    std::atomic<bool> stop = false;
    const auto work = [&](bool /*first*/) {
        for (std::size_t tile = next_tile++; tile * tile_size < rims.size() && !stop; tile = next_tile++) {
            const std::size_t end = std::min((tile + 1) * tile_size, rims.size());
            for (std::size_t i = tile * tile_size; i < end && !stop; ++i) {
                stop = stop || (asked_to_stop != nullptr && asked_to_stop());
                rims[i] =
                    has_rim(occluders, blockers, position_ws[i], normal_ws[i], around[i], light.shape, points) ? 1 : 0;
            }
        }
    };
    in_parallel(threads, work, [&] { stop = true; });
    return rims;
}

}  // namespace gn
