// SPDX-License-Identifier: MIT
// What shadows cost over the least that any method must pay, as ratios of one run: `make bench` prints the tables of
// docs/performance.md. Nothing here is asserted. Names of groups (lookups, placements, filters, inline,
// recording, recording-geometry, soft, geometry) select some.
#include "tests/performance/bench.h"

#include <array>
#include <cstdio>

int main(int count, char** names) try {
    using namespace gn::performance;
    constexpr std::array<std::pair<std::string_view, void (*)(Bench&)>, 8> groups{
        {{"lookups", lookups},
         {"placements", placements},
         {"filters", filters},
         {"inline", inlined},
         {"recording", recording},
         {"recording-geometry", recording_geometry},
         {"soft", soft},
         {"geometry", geometry}}};
    Bench bench;
    bench.print_head();
    for (const auto& [name, run] : groups) {
        bool wanted = count == 1;
        for (int i = 1; i < count; ++i) {
            wanted = wanted || name == names[i];
        }
        if (wanted) {
            run(bench);
        }
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "ratios: %s\n", error.what());
    return 1;
}
