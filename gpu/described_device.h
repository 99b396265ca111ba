// SPDX-License-Identifier: MIT
// A device that answers for another one: what it is asked of its kind and features is what it was told to say, and it
// remembers what was asked. Everything else is a real device's, so that frames can be declared on it, but what they bind is
// never made.
#pragma once

#include "gpu/device.h"

#include <compare>
#include <optional>
#include <set>

namespace gn {

/// One thing that shaders may be composed by: a feature, or whether the device is a CPU.
struct DeviceTrait {
    std::optional<Feature> feature;                        ///< unset: it is a CPU
    auto operator<=>(const DeviceTrait&) const = default;  // NOLINT(modernize-use-nullptr): of the default itself
    [[nodiscard]] std::string name() const { return std::string(feature ? feature_name(*feature) : "cpu"); }
};

/// What holds of the described device; all else does not. `asked` is what it was asked for so far.
struct DeviceDescription {
    std::set<DeviceTrait> has;
    std::set<DeviceTrait> asked;
};

/// Both must outlive the device that is given.
std::unique_ptr<Device> make_described_device(Device& real, DeviceDescription& description);

}  // namespace gn
