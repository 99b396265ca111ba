// SPDX-License-Identifier: MIT
#include "apps/bench/print.h"

#include "apps/bench/probes.h"
#include "apps/terminal.h"

#include <nlohmann/json.hpp>

namespace gn {
namespace {

using nlohmann::ordered_json;

template <class T>
ordered_json or_null(const std::optional<T>& value) {
    return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json counts_json(const PassWork& work) {
    if (!work.counts) {
        return nullptr;
    }
    return {{"vertices", work.counts->vertices},
            {"emitted", work.counts->emitted},
            {"primitives", work.counts->primitives},
            {"fragments", work.counts->fragments},
            {"items", work.counts->items}};
}

ordered_json pass_json(const BenchedPass& pass) {
    const Floors& floors = pass.verdict.floors;
    return {{"name", pass.name},
            {"group", pass.group},
            {"times", pass.times},
            {"ms", pass.work.ms},
            {"counts", counts_json(pass.work)},
            {"samples", or_null(pass.work.samples)},
            {"bytes", pass.work.bytes},
            {"floors_ms",
             {{"overhead", floors.overhead},
              {"vertices", floors.vertices},
              {"primitives", floors.primitives},
              {"geometry", floors.geometry},
              {"bandwidth", floors.bandwidth},
              {"fill", floors.fill}}},
            {"rest_ms", floors.rest},
            {"madds_an_invocation", or_null(pass.verdict.madds)},
            {"bottleneck", name_of(pass.verdict.unit)}};
}

ordered_json run_json(const BenchedRun& run) {
    ordered_json passes = ordered_json::array();
    for (const BenchedPass& pass : run.passes) {
        passes.push_back(pass_json(pass));
    }
    const bool measured = run.status == Status::ok;
    return {{"recipe", run.recipe},
            {"status", name_of(run.status)},
            {"reason", run.reason},
            {"shadow_ms", measured ? ordered_json(run.shadow_ms) : ordered_json(nullptr)},
            {"frame_ms", measured ? ordered_json(run.frame_ms) : ordered_json(nullptr)},
            {"bottleneck",
             {{"shadow", measured ? ordered_json(name_of(run.shadow)) : ordered_json(nullptr)},
              {"frame", measured ? ordered_json(name_of(run.frame)) : ordered_json(nullptr)}}},
            {"passes", passes}};
}

/// 1234567 as "1.23 M"; "" where nothing of it was done.
std::string short_count(std::uint64_t count) {
    const auto value = static_cast<double>(count);
    return count == 0          ? ""
           : count < 10'000    ? fmt::format("{}", count)
           : count < 1'000'000 ? fmt::format("{:.0f} k", value / 1e3)
                               : fmt::format("{:.2f} M", value / 1e6);
}

/// A floor's share of the pass's time; "" where it is below a hundredth.
std::string share(double floor_ms, double ms) {
    const double part = ms > 0 ? floor_ms / ms : 0;
    return part < 0.01 ? "" : fmt::format("{:.0f} %", 100 * part);
}

}  // namespace

ordered_json bench_json(const BenchResult& result) {
    ordered_json rates = ordered_json::object();
    for (const RateRow& row : rate_rows()) {
        rates[std::string(row.name)] = result.machine.*row.value;
    }
    ordered_json runs = ordered_json::array();
    for (const BenchedRun& run : result.runs) {
        runs.push_back(run_json(run));
    }
    return {
        {"schema", 1},
        {"version", GNOMON_VERSION},
        {"device",
         {{"name", result.device.name}, {"kind", result.device.cpu ? "cpu" : "gpu"}, {"driver", result.device.driver}}},
        {"uncounted", result.uncounted},
        {"machine_ns", rates},
        {"scene", result.scene},
        {"view", result.view},
        {"size", {result.width, result.height}},
        {"repeat", result.repeat},
        {"runs", runs}};
}

std::string machine_text(const BenchResult& result) {
    std::string text = fmt::format("{} ({})\n", result.device.name, result.device.driver);
    std::vector<std::vector<std::string>> rows;
    for (const RateRow& row : rate_rows()) {
        rows.push_back({std::string(row.of), spoken_rate(row, result.machine)});
    }
    text += text_table({"the machine's best", "rate"}, rows, 1);
    text += result.uncounted.empty() ? "" : result.uncounted + "\n";
    return text + fmt::format("\n{}, view '{}', {}x{}, the least of {} frames\n", result.scene, result.view,
                              result.width, result.height, result.repeat);
}

std::string run_text(const BenchedRun& run) {
    if (run.status != Status::ok) {
        return fmt::format("\n{}: {}: {}\n", run.recipe, name_of(run.status), run.reason);
    }
    std::vector<std::vector<std::string>> rows;
    for (const BenchedPass& pass : run.passes) {
        const PassWork::Counts counts = pass.work.counts.value_or(PassWork::Counts{});
        const Floors& floors = pass.verdict.floors;
        const double ms = pass.work.ms;
        rows.push_back(
            {(pass.group.empty() ? "" : pass.group + "/") + pass.name +
                 (pass.times > 1 ? fmt::format(" ({} times)", pass.times) : ""),
             std::string(name_of(pass.verdict.unit)), fmt::format("{:.3f}", ms), short_count(counts.vertices),
             short_count(counts.primitives), short_count(counts.fragments), short_count(counts.items),
             human_bytes(pass.work.bytes), share(floors.vertices + floors.primitives + floors.geometry, ms),
             share(floors.fill, ms), share(floors.bandwidth, ms), share(floors.rest, ms),
             pass.verdict.madds && *pass.verdict.madds >= 1 ? fmt::format("{:.0f}", *pass.verdict.madds) : ""});
    }
    std::string text = fmt::format("\n{}: shadow {:.2f} ms, {}; frame {:.2f} ms, {}\n", run.recipe, run.shadow_ms,
                                   name_of(run.shadow), run.frame_ms, name_of(run.frame));
    text += text_table({"pass", "waits for", "ms", "vertices", "triangles", "fragments", "items", "moved", "geometry",
                        "fill", "bandwidth", "rest", "madds"},
                       rows, 2);
    return run.reason.empty() ? text : text + "without a shadow: " + run.reason + "\n";
}

}  // namespace gn
