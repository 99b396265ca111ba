// SPDX-License-Identifier: MIT
// Based on: van Sambeek. Real-time Shadow Generation for 3D Simulations Using Modern Hardware. Twente 2007. [Sam07]
// Departs from it: counters of busy units are those of one maker's driver; here work is counted and held against how fast this
// machine does such work. What both have in common: what no counter explains while rasterizing is fill rate (section 4.1.1).
// Which part of the pipeline a pass waits for: rules over plain numbers, stated on docs/bench.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace gn {

/// What a pass can wait for.
enum class Unit { overhead, vertices, primitives, geometry, bandwidth, fill, shaders, unknown };
inline constexpr std::array<std::string_view, 8> unit_names{"overhead",  "vertices",  "primitives", "geometry shaders",
                                                            "bandwidth", "fill rate", "shaders",    "unknown"};
constexpr std::string_view name_of(Unit unit) {
    return unit_names[static_cast<std::size_t>(unit)];
}

/// The least nanoseconds that a machine takes for one of each, with nothing else to do.
struct MachineRates {
    double pass = 0;       ///< a pass that does nothing
    double vertex = 0;     ///< a vertex that is only placed
    double culled = 0;     ///< a triangle without area
    double primitive = 0;  ///< a triangle of half a pixel
    double emitted = 0;    ///< a triangle that a geometry shader passes on
    double fragment = 0;   ///< a fragment of one constant, four bytes written
    double sample = 0;     ///< a sample of depth, without any fragment shader
    double byte = 0;       ///< read or written in a row
    double madd = 0;       ///< a multiply and an add of 32 bits, of all units together
};

/// What a pass took and did. Counts are absent where the device counts nothing.
struct PassWork {
    struct Counts {
        std::uint64_t vertices = 0, emitted = 0, primitives = 0, fragments = 0, items = 0;
    };
    double ms = 0;
    bool draws = false;                    ///< has attachments
    bool shades = false;                   ///< writes colours or storage
    std::optional<Counts> counts;          ///< gpu/pass_counters.h
    std::optional<std::uint64_t> samples;  ///< that passed the tests of depth and stencil
    std::uint64_t bytes = 0;               ///< moved at the least
    PassWork& operator+=(const PassWork& other);
};

/// What each unit takes of a pass, ms, by what was counted, and what is left for what cannot be counted.
struct Floors {
    double overhead = 0, vertices = 0, primitives = 0, geometry = 0, fill = 0, bandwidth = 0;
    double rest = 0;  ///< never negative
};
Floors floors_of(const PassWork& pass, const MachineRates& machine);

struct Verdict {
    Unit unit = Unit::unknown;
    Floors floors;
    /// The rest as multiply-adds that each invocation of a fragment or compute shader could have done meanwhile; absent where
    /// there is none.
    std::optional<double> madds;
};
Verdict bottleneck_of(const PassWork& pass, const MachineRates& machine);

/// Of several passes: the unit in which most of their milliseconds are. Ties go to the unit that comes first in the pipeline.
/// Unknown where nothing took any time.
struct JudgedPass {
    Unit unit = Unit::unknown;
    double ms = 0;
};
Unit bottleneck_of(std::span<const JudgedPass> passes);

}  // namespace gn
