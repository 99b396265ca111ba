// SPDX-License-Identifier: MIT
// Rays towards a light, and the threads that trace them.
#pragma once

#include "reference/light_sample.h"
#include "reference/occluders.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <thread>
#include <vector>

namespace gn {

inline constexpr std::size_t tile_size = 256;  ///< view samples that a thread takes at a time

/// Where a ray towards the light ends: a little beyond it, see reference/occluders.h.
inline float ray_end(float distance, float largest_origin) {
    return distance + static_cast<float>(ulps_at(hit_ulps, static_cast<double>(distance + largest_origin)));
}

/// `start`: metres along the ray that are left out.
template <int Width>
void aim(Packet<Width>& packet, int lane, vec3 origin_ws, const LightPoint& point, float start = 0.0F) {
    RTCRayNt<Width>& rays = packet.rays;
    rays.org_x[lane] = origin_ws.x;
    rays.org_y[lane] = origin_ws.y;
    rays.org_z[lane] = origin_ws.z;
    rays.dir_x[lane] = point.direction_ws.x;
    rays.dir_y[lane] = point.direction_ws.y;
    rays.dir_z[lane] = point.direction_ws.z;
    rays.tnear[lane] = start;
    rays.tfar[lane] = ray_end(point.distance, static_cast<float>(largest(dvec3(origin_ws))));
    rays.time[lane] = 0.0F;
    rays.mask[lane] = ~0U;
    rays.id[lane] = static_cast<unsigned>(lane);
    rays.flags[lane] = 0;
    packet.distance[static_cast<std::size_t>(lane)] = point.distance;
}

/// Calls work(true) on this thread and work(false) on as many others as asked for (0: all there are). Where this
/// thread's work throws, `stop` is called before the others are waited for.
inline void in_parallel(int threads, const std::function<void(bool)>& work, const std::function<void()>& stop) {
    const unsigned available = std::max(1U, std::thread::hardware_concurrency());
    const unsigned count = threads > 0 ? static_cast<unsigned>(threads) : available;
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < std::min(count, 256U); ++i) {
        others.emplace_back([&work] { work(false); });
    }
    try {
        work(true);
    } catch (...) {
        stop();
        throw;
    }
}

}  // namespace gn
