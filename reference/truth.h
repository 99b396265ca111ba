// SPDX-License-Identifier: MIT
// The truth: V traced by Embree on the CPU for exactly the view samples that the GPU rendered.
#pragma once

#include "base/sobol.h"
#include "shadow/scene/light_samples.h"
#include "shadow/scene/scene.h"

#include <functional>
#include <memory>
#include <span>

namespace gn {

struct TruthOptions {
    int samples = 256;  ///< of the light per view sample; rounded up to a power of two
    uint seed = 0;
    int threads = 0;           ///< 0: all; changes nothing in the result
    bool (*stop)() = nullptr;  ///< asked by every thread before every view sample; true leaves the rest untraced
    bool integral = false;     ///< also [EASW09] eq. 1.3: sum of V x cosine-weighted radiance over the light
    int channels =
        1;  ///< 3: V of red, green and blue, which translucent surfaces on the way tint; 1: they block nothing
    /// Instead of random points of the light exactly these, for tests: V is their weighted mean, without an error of its
    /// own; points behind a sample's surface show it nothing, though it be a sheet that no ray meets again. Not together with `integral`.
    const LightSamples* exactly = nullptr;
    uint width = 0;  ///< with `exactly`: of the picture that the view samples fill row by row
};

struct TruthResult {
    std::vector<float> visibility;  ///< per sample its channels, in [0,1]; 0 where it does not count
    int channels = 1;
    std::vector<float> standard_error;  ///< per sample, of `visibility`; the largest of its channels
    /// 1 where gn_counted holds and a surface is seen that receives shadows; where it receives none, V = 1 and 0.
    std::vector<std::uint8_t> counted;
    /// With options.integral: [EASW09] eq. 1.3 without the material, lux; else empty. Range windows are left to shading.
    std::vector<float> irradiance;
    bool complete = true;            ///< false where options.stop ended it: what it holds is worth nothing
    double mean_standard_error = 0;  ///< mean of standard_error over counted samples
    double seconds = 0;
};

/// What lies around a sample: the points p + s a + t b, s and t in [-1,1], each moved along its ray to the light onto the
/// sample's tangent plane.
struct Surroundings {
    vec3 a_ws{0}, b_ws{0};  ///< metres, across the rays; both null: nothing is asked
};

/// Embree's acceleration structure over one scene; the scene must outlive it.
class Truth {
  public:
    explicit Truth(const Scene& scene);
    ~Truth();
    Truth(const Truth&) = delete;
    Truth& operator=(const Truth&) = delete;
    /// position_ws (w = 1: surface) and normal_ws per view sample. progress(0..1), when given, is called from one thread.
    /// What the light spares, and what was told not to cast, blocks nothing.
    [[nodiscard]] TruthResult trace(std::span<const vec4> position_ws, std::span<const vec4> normal_ws,
                                    const Light& light, const TruthOptions& options,
                                    const std::function<void(double)>& progress = {}) const;
    /// The same for a light that spares nothing.
    [[nodiscard]] TruthResult trace(std::span<const vec4> position_ws, std::span<const vec4> normal_ws,
                                    const GnLight& light, const TruthOptions& options,
                                    const std::function<void(double)>& progress = {}) const {
        return trace(position_ws, normal_ws, Light{.name = "", .shape = light, .spared = {}}, options, progress);
    }
    /// 1 where a part of the scene other than the sample's own surface hides the light's centre from some place around the
    /// sample: the sample is beside a shadow, or in it. See reference/rims.h. threads and stop as in TruthOptions.
    [[nodiscard]] std::vector<std::uint8_t> blocked_around(std::span<const vec4> position_ws,
                                                           std::span<const vec4> normal_ws,
                                                           std::span<const Surroundings> around, const Light& light,
                                                           int threads = 0, bool (*stop)() = nullptr) const;
    [[nodiscard]] std::vector<std::uint8_t> blocked_around(std::span<const vec4> position_ws,
                                                           std::span<const vec4> normal_ws,
                                                           std::span<const Surroundings> around, const GnLight& light,
                                                           int threads = 0) const {
        return blocked_around(position_ws, normal_ws, around, Light{.name = "", .shape = light, .spared = {}}, threads);
    }
    /// One exact question, for tests: is the segment (p, q) blocked?
    [[nodiscard]] bool blocked(dvec3 p_ws, dvec3 q_ws) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Point (u in [0,1)^2) on the light as seen from p: direction to it (unit) and distance (infinite if directional).
struct LightPoint {
    vec3 direction_ws;
    float distance;
};
LightPoint sample_light(const GnLight& light, vec3 p_ws, vec2 u);

}  // namespace gn
