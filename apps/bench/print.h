// SPDX-License-Identifier: MIT
// What a bench found, as JSON and as text.
#pragma once

#include "apps/bench/measured.h"

#include <nlohmann/json_fwd.hpp>

namespace gn {

struct BenchResult {
    DeviceInfo device;
    std::string uncounted;  ///< what the device does not count, one sentence, or ""
    MachineRates machine;
    std::string scene, view;
    int width = 0, height = 0, repeat = 0;
    std::vector<BenchedRun> runs;
};

/// The document of apps/schema/bench.schema.json.
nlohmann::ordered_json bench_json(const BenchResult& result);
std::string machine_text(const BenchResult& result);
std::string run_text(const BenchedRun& run);

}  // namespace gn
