// SPDX-License-Identifier: MIT
#include "apps/evaluation/bottleneck.h"

#include <algorithm>

namespace gn {
namespace {

constexpr double ms_from_ns = 1e-6;

double amount(std::uint64_t count) {
    return static_cast<double>(count);
}

/// Of shaders whose length nothing counts and whose results are kept.
double invocations(const PassWork& pass) {
    return pass.counts && pass.shades ? amount(pass.counts->fragments) + amount(pass.counts->items) : 0;
}

/// Whom the time belongs to that no floor explains.
Unit unit_of_rest(const PassWork& pass) {
    if (!pass.counts) {
        return Unit::unknown;
    }
    // Shaders may be long; a raster pass of depth and stencil alone spends its time on pixels: [Sam07] section 4.1.1.
    if (invocations(pass) > 0) {
        return Unit::shaders;
    }
    // Copies and clears move bytes and nothing else.
    return pass.draws ? Unit::fill : Unit::bandwidth;
}

}  // namespace

PassWork& PassWork::operator+=(const PassWork& other) {
    ms += other.ms;
    draws = draws || other.draws;
    shades = shades || other.shades;
    bytes += other.bytes;
    if (counts && other.counts) {
        counts->vertices += other.counts->vertices;
        counts->emitted += other.counts->emitted;
        counts->primitives += other.counts->primitives;
        counts->fragments += other.counts->fragments;
        counts->items += other.counts->items;
    } else {
        counts.reset();
    }
    samples = samples && other.samples ? std::optional(*samples + *other.samples) : std::nullopt;
    return *this;
}

Floors floors_of(const PassWork& pass, const MachineRates& machine) {
    Floors floors;
    floors.overhead = machine.pass * ms_from_ns;
    floors.bandwidth = machine.byte * amount(pass.bytes) * ms_from_ns;
    if (pass.counts) {
        floors.vertices = machine.vertex * amount(pass.counts->vertices) * ms_from_ns;
        // Clipping leaves what is culled next; no more triangles are drawn than there are samples.
        const double triangles = amount(pass.counts->primitives);
        const double drawn = std::min(triangles, amount(pass.samples.value_or(0)));
        floors.primitives = (machine.culled * (triangles - drawn) + machine.primitive * drawn) * ms_from_ns;
        floors.geometry = machine.emitted * amount(pass.counts->emitted) * ms_from_ns;
        floors.fill = machine.fragment * amount(pass.counts->fragments) * ms_from_ns;
    }
    floors.fill = std::max(floors.fill, machine.sample * amount(pass.samples.value_or(0)) * ms_from_ns);

    // Geometry comes before pixels; memory moves while pixels are made.
    const double explained = floors.overhead + floors.vertices + floors.primitives + floors.geometry +
                             std::max(floors.fill, floors.bandwidth);
    floors.rest = std::max(0.0, pass.ms - explained);
    return floors;
}

Verdict bottleneck_of(const PassWork& pass, const MachineRates& machine) {
    Verdict verdict{Unit::unknown, floors_of(pass, machine), {}};
    const Floors& floors = verdict.floors;
    if (invocations(pass) > 0 && machine.madd > 0) {
        verdict.madds = floors.rest / (invocations(pass) * machine.madd * ms_from_ns);
    }
    // A pass as short as an empty one tells nothing else.
    if (pass.ms <= 2 * floors.overhead) {
        verdict.unit = Unit::overhead;
        return verdict;
    }
    // The largest share has it; the rest comes last, so that it wins only by being larger.
    const std::array<std::pair<double, Unit>, 6> shares{{{floors.vertices, Unit::vertices},
                                                         {floors.primitives, Unit::primitives},
                                                         {floors.geometry, Unit::geometry},
                                                         {floors.bandwidth, Unit::bandwidth},
                                                         {floors.fill, Unit::fill},
                                                         {floors.rest, unit_of_rest(pass)}}};
    verdict.unit = std::max_element(shares.begin(), shares.end(), [](const auto& a, const auto& b) {
                       return a.first < b.first;
                   })->second;
    return verdict;
}

Unit bottleneck_of(std::span<const JudgedPass> passes) {
    std::array<double, unit_names.size()> ms{};
    for (const JudgedPass& pass : passes) {
        ms[static_cast<std::size_t>(pass.unit)] += pass.ms;
    }
    const auto most = std::max_element(ms.begin(), ms.end());
    return *most > 0 ? static_cast<Unit>(most - ms.begin()) : Unit::unknown;
}

}  // namespace gn
