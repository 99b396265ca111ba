// SPDX-License-Identifier: MIT
// How fast this machine does the least of each kind of work, measured by passes of the frame graph, as all others are.
#pragma once

#include "apps/evaluation/bottleneck.h"
#include "gpu/device.h"

#include <span>
#include <string>

namespace gn {

/// Runs the probes, which takes some seconds on a software driver. Each counts by the least of several turns. Throws Error.
MachineRates probe_machine(Device& device);

/// The fields of MachineRates in the order of reports: what each is a rate of, and its unit a second.
struct RateRow {
    std::string_view name;
    double MachineRates::*value = nullptr;
    std::string_view unit, of;
};
std::span<const RateRow> rate_rows();

/// "9.1 GB/s"
std::string spoken_rate(const RateRow& row, const MachineRates& rates);

}  // namespace gn
