// SPDX-License-Identifier: MIT
// Based on: Art B. Owen. Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences. MCQMC 1995. [Owe95]
//
// Every view sample is its own experiment: its seeds depend on the seed asked for and on its index alone, and its rays
// are summed in the order of the sequence. So threads only decide who works when. There is no adaptive stopping, which
// would bias the mean; the one shortcut is exact: a light without extent takes one ray.
//
// Standard error. The N samples are B = min(8, N) independent scrambles of the sequence's first N/B points. Each
// scramble is a (0,m,2)-net and unbiased by itself [Owe95, section 3], so V is their mean, and the variance between
// them divided by B is an unbiased estimate of the variance of V. (The error inside one scramble can not be estimated
// from its own points, which are correlated.)
#include "reference/truth.h"

#include "base/error.h"
#include "base/sobol.h"
#include "reference/light_sample.h"
#include "reference/occluders.h"
#include "reference/rays.h"
#include "reference/rims.h"
#include "shadow/scene/emission.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>

namespace gn {
namespace {

constexpr int most_samples = 1 << 20;
constexpr std::uint32_t most_batches = 8;

/// How many samples, in how many independent scrambles.
struct Plan {
    std::uint32_t batches, per_batch;
    std::uint32_t seed;
    std::vector<std::uint32_t> second;  ///< coordinate 1 of the sequence, bit-reversed

    explicit Plan(const TruthOptions& options) : seed(options.seed) {
        if (options.exactly != nullptr && (options.integral || options.width == 0 || options.exactly->points.empty())) {
            fail(
                "the reference traces exactly the given points: at least one, with the picture's width, without "
                "integral");
        }
        if (options.channels != 1 && options.channels != 3) {
            fail("{} channels are asked of the reference; valid is 1 or 3", options.channels);
        }
        if (options.samples < 1 || options.samples > most_samples) {
            fail("{} samples are asked of the reference; valid is 1 to {}", options.samples, most_samples);
        }
        const std::uint32_t samples = std::bit_ceil(static_cast<std::uint32_t>(options.samples));
        batches = std::min(most_batches, samples);
        per_batch = samples / batches;
        second = sobol::second_reversed_table(per_batch);
    }
    /// The points of one scramble for one view sample.
    [[nodiscard]] sobol::Seeds seeds(std::size_t view_sample, std::uint32_t batch) const {
        return sobol::Seeds(sobol::mix(sobol::mix(seed, batch), static_cast<std::uint32_t>(view_sample)));
    }
    [[nodiscard]] vec2 point(const sobol::Seeds& seeds, std::uint32_t i) const {
        return {sobol::unit_from_reversed(sobol::scramble_reversed(i, seeds.first)),
                sobol::unit_from_reversed(sobol::scramble_reversed(second[i], seeds.second))};
    }
};

struct Estimate {
    dvec3 visibility{0};  ///< of red, green and blue; all alike where nothing tints
    double standard_error = 0, irradiance = 0;
};

/// What a rectangle that shows a picture (shadow/scene/emission.h) sends from its points, in its own colours: V of three channels
/// are shares of it. 1 everywhere of a light that shows none.
struct Sent {
    const Image8* picture = nullptr;
    const GnLight& light;
    bvec3 dark{false};  ///< channels of which it sends nothing at all: their points count alike

    /// From the point of the unit square that a sampler takes.
    [[nodiscard]] vec3 from(vec2 u) const {
        return picture == nullptr
                   ? vec3(1)
                   : mix(emission_at(*picture, gn_emission_place(light, 2.0F * u - 1.0F)), vec3(1), dark);
    }
};

/// What a traced ray brings of its light.
template <int Width>
vec3 brought(const Packet<Width>& packet, std::size_t lane) {
    return packet.rays.tfar[lane] < 0.0F ? vec3(0) : packet.tint[lane];
}

Estimate trace_single(const Occluders& occluders, const Blockers& blockers, const Seat& seat,
                      const LightSampler& sampler, vec3 n_ws) {
    Packet<1> ray;
    const LightPoint point = sampler.centre();
    aim(ray, 0, seat.origin_ws, point);
    const int valid = -1;
    occluders.trace(seat, blockers, &valid, ray);
    const dvec3 visible(brought(ray, 0));
    return {visible, 0.0, visible.g * static_cast<double>(sampler.irradiance(point, n_ws))};
}

/// The weighted mean over points that are given. What lies behind the sample's own surface is hidden by it.
Estimate trace_exactly(const Occluders& occluders, const Blockers& blockers, const Seat& seat, vec3 n_ws,
                       const GnLight& light, const LightSamples& samples, ivec2 pixel) {
    const int count = static_cast<int>(samples.points.size());
    dvec3 visible(0);
    double weights = 0;
    for (int i = 0; i < count; ++i) {
        const GnLight& one = samples.points[static_cast<std::size_t>(i)];
        const float weight =
            gn_point_taken(i, count, pixel, samples.side) ? gn_point_weight(light, one, seat.origin_ws) : 0.0F;
        if (weight > 0) {
            Packet<1> ray;
            const LightPoint point = LightSampler(one, seat.origin_ws).centre();
            aim(ray, 0, seat.origin_ws, point);
            const int valid = -1;
            occluders.trace(seat, blockers, &valid, ray);
            visible += glm::dot(n_ws, point.direction_ws) > 0.0F ? dvec3(weight * brought(ray, 0)) : dvec3(0);
            weights += static_cast<double>(weight);
        }
    }
    return {weights > 0 ? visible / weights : dvec3(1), 0.0, 0.0};
}

/// The mean of the batches' means and its standard error.
Estimate combine(std::span<const dvec3> visible, const Plan& plan) {
    Estimate estimate;
    dvec3 squares(0);
    for (const dvec3 count : visible) {
        const dvec3 mean = count / static_cast<double>(plan.per_batch);
        estimate.visibility += mean / static_cast<double>(plan.batches);
        squares += mean * mean / static_cast<double>(plan.batches);
    }
    if (plan.batches == 1) {
        estimate.standard_error = 0.5;  // one yes or no: the largest standard deviation there is
        return estimate;
    }
    const dvec3 variances = squares - estimate.visibility * estimate.visibility;
    const double variance = std::max({0.0, variances.r, variances.g, variances.b});
    estimate.standard_error = std::sqrt(variance / (plan.batches - 1));
    return estimate;
}

/// What is seen of each batch, as counts whose mean is what is seen of all over what all send; they scatter as that ratio does, to first order.
void divide_by_sent(std::span<dvec3> visible, std::span<const dvec3> sent, const Plan& plan) {
    dvec3 all_visible(0), all_sent(0);
    for (std::size_t b = 0; b < visible.size(); ++b) {
        all_visible += visible[b];
        all_sent += sent[b];
    }
    const dvec3 share = all_visible / max(all_sent, dvec3(1e-30));
    const dvec3 mean_sent = max(all_sent / static_cast<double>(visible.size()), dvec3(1e-30));
    for (std::size_t b = 0; b < visible.size(); ++b) {
        visible[b] = (share + (visible[b] - share * sent[b]) / mean_sent) * static_cast<double>(plan.per_batch);
    }
}

template <int Width>
Estimate trace_area(const Occluders& occluders, const Blockers& blockers, const Plan& plan, std::size_t view_sample,
                    const Seat& seat, const LightSampler& sampler, vec3 n_ws, bool integral, const Sent& sent) {
    Packet<Width> packet;
    std::array<vec3, Width> sent_of{};
    std::array<dvec3, most_batches> sent_by{};
    alignas(4 * Width) std::array<int, Width> valid{};
    std::array<std::uint32_t, Width> batch_of{};
    std::array<float, Width> weight{};
    std::array<dvec3, most_batches> visible{};
    double irradiance = 0;
    int lane = 0;

    // Add up what a full packet sees, in the order of its samples.
    const auto flush = [&] {
        std::fill(valid.begin(), valid.begin() + lane, -1);
        std::fill(valid.begin() + lane, valid.end(), 0);
        occluders.trace(seat, blockers, valid.data(), packet);
        for (int i = 0; i < lane; ++i) {
            const auto k = static_cast<std::size_t>(i);
            if (packet.rays.tfar[i] >= 0.0F) {
                visible[batch_of[k]] += dvec3(packet.tint[k] * sent_of[k]);
                irradiance += static_cast<double>(weight[k]);
            }
        }
        lane = 0;
    };

    // Send one ray to every point of every scramble.
    for (std::uint32_t batch = 0; batch < plan.batches; ++batch) {
        const sobol::Seeds seeds = plan.seeds(view_sample, batch);
        for (std::uint32_t i = 0; i < plan.per_batch; ++i) {
            const vec2 u = plan.point(seeds, i);
            const LightPoint point = sampler.at(u);
            aim(packet, lane, seat.origin_ws, point);
            sent_of[static_cast<std::size_t>(lane)] = sent.from(u);
            sent_by[batch] += dvec3(sent_of[static_cast<std::size_t>(lane)]);
            batch_of[static_cast<std::size_t>(lane)] = batch;
            weight[static_cast<std::size_t>(lane)] = integral ? sampler.irradiance(point, n_ws) : 0.0F;
            if (++lane == Width) {
                flush();
            }
        }
    }
    if (lane > 0) {
        flush();
    }
    if (sent.picture != nullptr) {
        divide_by_sent(std::span(visible).first(plan.batches), std::span(sent_by).first(plan.batches), plan);
    }
    Estimate estimate = combine(std::span(visible).first(plan.batches), plan);
    estimate.irradiance = irradiance / (static_cast<double>(plan.batches) * plan.per_batch);
    return estimate;
}

/// The work of one call of Truth::trace, shared by its threads; every view sample is written by one of them.
struct Job {
    const Occluders& occluders;
    std::span<const vec4> position_ws, normal_ws;
    const GnLight& light;
    const Plan& plan;
    const TruthOptions& options;
    TruthResult& result;
    Blockers blockers, nothing;
    Sent sent;
    std::atomic<std::size_t> next_tile = 0, done = 0;
    std::atomic<bool> stop = false;

    void trace_one(std::size_t i) {
        const vec3 p_ws(position_ws[i]);
        const vec3 n_ws(normal_ws[i]);
        if (!(position_ws[i].w > 0.0F) || !finite(p_ws) || !gn_counted(light, p_ws, n_ws)) {
            return;
        }
        const Seat seat = occluders.seat(dvec3(p_ws), glm::normalize(dvec3(n_ws)));
        const LightSampler sampler(light, seat.origin_ws);
        // On what receives no shadow nothing blocks, and no technique is measured.
        const bool receives = position_ws[i].w < 1.5F;
        const Estimate estimate = estimate_at(i, receives ? blockers : nothing, seat, sampler, n_ws);
        result.counted[i] = receives ? 1 : 0;
        const auto channels = static_cast<std::size_t>(options.channels);
        for (std::size_t c = 0; c < channels; ++c) {
            result.visibility[channels * i + c] = static_cast<float>(estimate.visibility[static_cast<int>(c)]);
        }
        result.standard_error[i] = static_cast<float>(estimate.standard_error);
        if (options.integral) {
            result.irradiance[i] = static_cast<float>(estimate.irradiance);
        }
    }

    Estimate estimate_at(std::size_t i, const Blockers& by, const Seat& seat, const LightSampler& sampler,
                         vec3 n_ws) const {
        if (options.exactly != nullptr) {
            const ivec2 pixel(static_cast<int>(i % options.width), static_cast<int>(i / options.width));
            return trace_exactly(occluders, by, seat, n_ws, light, *options.exactly, pixel);
        }
        if (sampler.single()) {
            return trace_single(occluders, by, seat, sampler, n_ws);
        }
        switch (occluders.width()) {
            case 16: return trace_area<16>(occluders, by, plan, i, seat, sampler, n_ws, options.integral, sent);
            case 8: return trace_area<8>(occluders, by, plan, i, seat, sampler, n_ws, options.integral, sent);
            default: return trace_area<4>(occluders, by, plan, i, seat, sampler, n_ws, options.integral, sent);
        }
    }

    /// Whether to leave the rest alone: one sample at the most samples takes a tenth of a second, a tile half a minute.
    bool stopped() {
        if (options.stop != nullptr && options.stop()) {
            stop = true;
        }
        return stop;
    }

    /// Takes tiles until none is left; `after_tile` gets the fraction done.
    void work(const std::function<void(double)>& after_tile) {
        const std::size_t size = position_ws.size();
        for (std::size_t first = tile_size * next_tile++; first < size && !stop; first = tile_size * next_tile++) {
            const std::size_t end = std::min(first + tile_size, size);
            for (std::size_t i = first; i < end && !stopped(); ++i) {
                trace_one(i);
            }
            done += end - first;
            if (after_tile) {
                after_tile(static_cast<double>(done) / static_cast<double>(size));
            }
        }
    }
};

}  // namespace

struct Truth::Impl {
    Occluders occluders;
    const Scene& scene;

    /// Of three channels each has its own weights; one is the share of the light's area.
    [[nodiscard]] Sent sent(const Light& light, const TruthOptions& options) const {
        const bool weighted = options.channels == 3 && options.exactly == nullptr;
        const Image8* const picture = weighted ? shown_picture(scene, light.shape) : nullptr;
        return {picture, light.shape, picture != nullptr ? equal(mean_emission(*picture), vec3(0)) : bvec3(false)};
    }
};

Truth::Truth(const Scene& scene) : impl_(new Impl{Occluders(scene), scene}) {}
Truth::~Truth() = default;

TruthResult Truth::trace(std::span<const vec4> position_ws, std::span<const vec4> normal_ws, const Light& light,
                         const TruthOptions& options, const std::function<void(double)>& progress) const {
    GN_CHECK_EQ(position_ws.size(), normal_ws.size());
    const auto start = std::chrono::steady_clock::now();
    const Plan plan(options);
    TruthResult result;
    result.channels = options.channels;
    result.visibility.assign(position_ws.size() * static_cast<std::size_t>(options.channels), 0.0F);
    result.standard_error.assign(position_ws.size(), 0.0F);
    result.counted.assign(position_ws.size(), 0);
    result.irradiance.assign(options.integral ? position_ws.size() : 0, 0.0F);
    const Occluders& occluders = impl_->occluders;
    Job job{occluders,
            position_ws,
            normal_ws,
            light.shape,
            plan,
            options,
            result,
            occluders.blockers(&light, options.channels == 3),
            occluders.no_blockers(),
            impl_->sent(light, options)};
    in_parallel(
        options.threads, [&](bool first) { job.work(first ? progress : std::function<void(double)>{}); },
        [&] { job.stop = true; });
    result.complete = !job.stop;
    if (progress) {
        progress(1.0);
    }

    // Sum in one order, whoever traced.
    std::size_t counted = 0;
    for (std::size_t i = 0; i < position_ws.size(); ++i) {
        counted += result.counted[i];
        result.mean_standard_error += static_cast<double>(result.standard_error[i]);
    }
    result.mean_standard_error /= static_cast<double>(std::max<std::size_t>(counted, 1));
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

std::vector<std::uint8_t> Truth::blocked_around(std::span<const vec4> position_ws, std::span<const vec4> normal_ws,
                                                std::span<const Surroundings> around, const Light& light, int threads,
                                                bool (*stop)()) const {
    return find_rims(impl_->occluders, position_ws, normal_ws, around, light, threads, stop);
}

bool Truth::blocked(dvec3 p_ws, dvec3 q_ws) const {
    const vec3 origin_ws(p_ws);
    const dvec3 segment = q_ws - dvec3(origin_ws);
    const double length = glm::length(segment);
    if (!(length > 0.0)) {
        return false;
    }
    Packet<1> ray;
    aim(ray, 0, origin_ws, {vec3(segment / length), static_cast<float>(length)});
    const int valid = -1;
    impl_->occluders.trace({p_ws, origin_ws}, impl_->occluders.blockers(nullptr), &valid, ray);
    return ray.rays.tfar[0] < 0.0F;
}

}  // namespace gn
