// SPDX-License-Identifier: MIT
// Curves over time: glTF 2.0, appendix C.
#include "shadow/scene/rig.h"

#include <algorithm>

namespace gn {
namespace {

/// The key at or before a time, how far the time is on the way to the next one, and how long that way is.
struct Place {
    std::size_t key = 0;
    double share = 0, seconds = 0;  ///< share 0: at the key
};

Place place_of(const Curve& curve, double seconds) {
    const auto after =
        std::upper_bound(curve.times.begin(), curve.times.end(), seconds, [](double t, float key) { return t < key; });
    if (after == curve.times.begin()) {
        return {};
    }
    const auto key = static_cast<std::size_t>(after - curve.times.begin()) - 1;
    if (after == curve.times.end()) {
        return {key};
    }
    const double begin = curve.times[key], length = *after - begin;
    return {key, (seconds - begin) / length, length};
}

/// v(t) = (2 t^3 - 3 t^2 + 1) v_k + d (t^3 - 2 t^2 + t) b_k + (-2 t^3 + 3 t^2) v_k+1 + d (t^3 - t^2) a_k+1
dvec4 spline(const Curve& curve, const Place& at) {
    const std::size_t k = 3 * at.key;
    const dvec4 value(curve.values[k + 1]);
    if (at.share == 0) {
        return value;
    }
    const dvec4 leaves(curve.values[k + 2]), arrives(curve.values[k + 3]), next(curve.values[k + 4]);
    const double t = at.share, t2 = t * t, t3 = t2 * t, d = at.seconds;
    return (2 * t3 - 3 * t2 + 1) * value + d * (t3 - 2 * t2 + t) * leaves + (-2 * t3 + 3 * t2) * next +
           d * (t3 - t2) * arrives;
}

glm::dquat unit_quaternion(dvec4 v) {
    const double length = glm::length(v);
    return std::isfinite(length) && length > 1e-12 ? glm::dquat(v.w / length, v.x / length, v.y / length, v.z / length)
                                                   : glm::dquat(1, 0, 0, 0);
}

}  // namespace

dvec3 vector_at(const Curve& curve, double seconds) {
    const Place at = place_of(curve, seconds);
    if (curve.between == Interpolation::cubic_spline) {
        return dvec3(spline(curve, at));
    }
    const dvec3 value(curve.values[at.key]);
    const bool between = at.share > 0 && curve.between == Interpolation::linear;
    return between ? glm::mix(value, dvec3(curve.values[at.key + 1]), at.share) : value;
}

glm::dquat rotation_at(const Curve& curve, double seconds) {
    const Place at = place_of(curve, seconds);
    if (curve.between == Interpolation::cubic_spline) {
        return unit_quaternion(spline(curve, at));
    }
    const glm::dquat value = unit_quaternion(dvec4(curve.values[at.key]));
    const bool between = at.share > 0 && curve.between == Interpolation::linear;
    return between ? glm::slerp(value, unit_quaternion(dvec4(curve.values[at.key + 1])), at.share) : value;
}

dmat4 matrix_of(dvec3 translation, glm::dquat rotation, dvec3 scale) {
    const double length = glm::length(rotation);
    const glm::dquat unit =
        std::isfinite(length) && length > 1e-12 ? rotation / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
    return glm::translate(dmat4(1.0), translation) * glm::mat4_cast(unit) * glm::scale(dmat4(1.0), scale);
}

}  // namespace gn
