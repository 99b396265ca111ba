// SPDX-License-Identifier: MIT
// What the parts without a map share: which objects cast, the light as one homogeneous point, results kept per
// geometry.
#pragma once

#include "shadow/scene/scene.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace gn {

/// How an object blocks light.
enum class CasterKind : std::uint8_t {
    opaque,  ///< everywhere: also alpha materials whose alpha nowhere falls below the cutoff
    masked,  ///< where its texture's alpha reaches the cutoff
    absent,  ///< nowhere: its alpha lies below the cutoff everywhere, or it casts no shadow of this light
};
/// One entry an object. Blended materials count as masked with cutoff 0.5.
std::vector<CasterKind> caster_kinds(const Scene& scene, const Light& light);

/// The kinds of two-sided objects and those of one-sided ones, the others absent.
struct CasterSides {
    std::vector<CasterKind> both, one;
};
CasterSides split_sides(const Scene& scene, const std::vector<CasterKind>& kinds);

/// Runs of consecutive triangles, the opaque objects joined: what one draw can take.
struct TriangleRun {
    std::uint32_t first = 0, count = 0;
};
std::vector<TriangleRun> opaque_caster_runs(const Scene& scene, const std::vector<CasterKind>& kinds);

/// Where the light is, ws: w = 1 a point (the centre of an area light), w = 0 the direction towards the sun.
vec4 light_point_ws(const GnLight& light);

/// A fingerprint of positions, triangles and `salt`: equal geometry, equal number.
std::uint64_t geometry_hash(const Scene& scene, std::uint64_t salt);

/// Keeps the few latest values by fingerprint; safe to use from several threads.
template <class Value>
class GeometryCache {
  public:
    template <class Make>
    std::shared_ptr<const Value> get(std::uint64_t key, Make make) {
        const std::lock_guard lock(mutex_);
        const auto found =
            std::find_if(entries_.begin(), entries_.end(), [&](const auto& e) { return e.first == key; });
        if (found != entries_.end()) {
            std::rotate(entries_.begin(), found, found + 1);
            return entries_.front().second;
        }
        entries_.insert(entries_.begin(), {key, std::make_shared<const Value>(make())});
        entries_.resize(std::min<std::size_t>(entries_.size(), 4));
        return entries_.front().second;
    }

  private:
    std::mutex mutex_;
    std::vector<std::pair<std::uint64_t, std::shared_ptr<const Value>>> entries_;
};

}  // namespace gn
