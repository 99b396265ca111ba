// SPDX-License-Identifier: MIT
// What a comparison finds: plain values that JSON, table and report are made from.
#pragma once

#include "gpu/device.h"
#include "shadow/metrics/metrics.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gn {

inline constexpr int schema_version = 1;

/// Milliseconds over the repeats; absent where nothing was timed.
struct Spread {
    std::optional<double> median, min, max;
};
Spread spread_of(const std::vector<double>& values);

/// How a light or a run ended: measured; refused by the recipe; empty, where no view sample counts; failed, where no figure
/// can be trusted.
enum class Status { ok, refused, empty, failed };
inline constexpr std::array<std::string_view, 4> status_names{"ok", "refused", "empty", "failed"};
constexpr std::string_view name_of(Status status) {
    return status_names[static_cast<std::size_t>(status)];
}

struct LightResult {
    std::string name;
    Status status = Status::ok;  ///< never failed
    std::string reason;
    Errors errors;
    std::string error_map;  ///< file beside the report, or ""
    /// Texels along each axis that each frame of a path drew of the light's map; empty where the placement does not choose.
    std::vector<ivec2> path_texels;
};

struct PassResult {
    std::string name, group;
    double median = 0;  ///< milliseconds
};

struct ResourceResult {
    std::string name;
    std::uint64_t bytes = 0;
};

/// A picture of what a recipe hides.
struct InsideResult {
    std::string name, light, picture, legend;
    bool of_view = true;  ///< as large as the view
};

/// One recipe on one view of one scene. `status` is ok when something was measured for at least one light; lights that
/// were refused or reach nothing say so themselves. It is refused when every light was, and empty when nothing could be
/// measured for those that were served.
struct RunResult {
    std::string scene, view, recipe, overrides;
    int width = 0, height = 0;
    Status status = Status::ok;
    std::string reason;
    Errors errors;  ///< all served lights pooled, and the pictures
    /// The picture against light shaded by all of the area, [EASW09] eq. 1.3; absent where that was not asked for.
    std::optional<double> shaded_luma_rms, shaded_flip;
    std::vector<LightResult> lights;
    Spread shadow, frame;
    std::vector<PassResult> passes;
    std::uint64_t bytes = 0;
    std::vector<ResourceResult> resources;
    std::vector<std::string> remarks;  ///< limits of the recipe that show in this scene, lights that leave all dark

    // For the report only.
    std::string title, citation, paragraph, picture, error_map, command;
    std::vector<std::pair<std::string, std::string>> parameters;
    std::vector<InsideResult> inside;
    std::string path;                                 ///< the camera path that was followed, or ""
    std::vector<std::optional<double>> path_flicker;  ///< of each of its steps, served lights pooled
};

struct LightInfo {
    std::string name, kind, size;  ///< size: "0.53 deg", "0.2 m", "point"
};

/// The traced truth of one view: what its runs are measured against.
struct ReferenceResult {
    int samples = 0;            ///< of the light per view sample
    double seconds = 0;         ///< over all lights
    double standard_error = 0;  ///< of the mean of V, averaged over lights
    std::string picture;        ///< file beside the report, or ""
};

struct SceneResult {
    std::string scene, name, view;  ///< as asked for, as it calls itself, and the camera
    int width = 0, height = 0;
    std::uint64_t triangles = 0;
    std::vector<LightInfo> lights;
    std::vector<std::string> notes;
    ReferenceResult reference;
};

struct Comparison {
    DeviceInfo device;
    std::string command;
    std::string against;  ///< the recipe that all runs are held against besides the truth, or ""
    int samples = 0, repeat = 0;
    std::vector<SceneResult> scenes;
    std::vector<RunResult> runs;
};

/// The document of apps/schema/compare.schema.json.
nlohmann::ordered_json contract_json(const Comparison& comparison);
/// The same with what the report shows besides.
nlohmann::ordered_json report_json(const Comparison& comparison);

/// For the cache: everything that a run or a reference holds, there and back. from_* throw nlohmann's exceptions.
nlohmann::ordered_json run_json(const RunResult& run, bool for_report);
RunResult run_from_json(const nlohmann::ordered_json& json);
nlohmann::ordered_json reference_json(const ReferenceResult& reference);
ReferenceResult reference_from_json(const nlohmann::ordered_json& json);

/// Text that is safe for any JSON reader: invalid UTF-8 is replaced.
std::string dump(const nlohmann::ordered_json& json, int indent);

}  // namespace gn
