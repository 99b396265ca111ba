// SPDX-License-Identifier: MIT
#include "apps/options.h"
#include "base/paths.h"
#include "shadow/recipe/part.h"

namespace gn {
namespace {

/// Parts that the device's missing features rule out, a line each.
void print_ruled_out() {
    const std::unique_ptr<Device> device = Device::create();
    for (const std::string& note : device->info().notes) {
        fmt::print("  note: {}\n", note);
    }
    int ruled_out = 0;
    for (const Part* part : all_parts()) {
        for (const Feature feature : part->features) {
            if (!device->has(feature)) {
                fmt::print("  {} '{}' is refused: it needs {}\n", stage_names[static_cast<std::size_t>(part->stage)],
                           part->id, feature_name(feature));
                ++ruled_out;
            }
        }
    }
    fmt::print("{}", ruled_out == 0 ? fmt::format("  none: all {} parts can run here\n", all_parts().size()) : "");
}

}  // namespace

int run(const DoctorOptions& /*options*/) {
    const DoctorReport report = examine_machine();
    for (const std::string& line : report.lines) {
        fmt::print("{}\n", line);
    }
    fmt::print("\nGnomon {}\n  recipes and shaders: {}\n  cache: {}\n", GNOMON_VERSION, data_root().string(),
               cache_root().empty() ? "none that can be written, so nothing is cached" : cache_root().string());
    if (!report.usable) {
        fmt::print(stderr, "gnomon: no Vulkan 1.3 device on this machine can be used; the lines above say why\n");
        return exit_failed;
    }
    fmt::print("\nTechniques ruled out on this device\n");
    print_ruled_out();
    return exit_done;
}

}  // namespace gn
