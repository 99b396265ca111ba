// SPDX-License-Identifier: MIT
#include "apps/evaluation/sweep_store.h"

#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace gn {
namespace {

constexpr std::string_view kind = "GnSw";
constexpr int version = 1;
constexpr std::string_view sweep_schema = R"(
CREATE TABLE title (only INTEGER PRIMARY KEY CHECK (only = 1), name TEXT NOT NULL, text TEXT NOT NULL,
                    version TEXT NOT NULL, quick INTEGER NOT NULL);
CREATE TABLE run (key TEXT PRIMARY KEY, view TEXT NOT NULL, status TEXT NOT NULL, reason TEXT NOT NULL,
                  document TEXT NOT NULL, seconds REAL NOT NULL, device TEXT NOT NULL,
                  finished TEXT NOT NULL DEFAULT CURRENT_TIMESTAMP) WITHOUT ROWID;
)";

/// Of a row besides its texts: SQLite's own, and the half-empty pages of its tree.
constexpr double row_overhead = 1.3;

}  // namespace

SweepStore::SweepStore(const std::filesystem::path& path, const SweepTitle& title)
    : database_(path, kind, version, sweep_schema) {
    entitle(title);
}

SweepStore::SweepStore(const std::filesystem::path& path) : database_(Database::existing(path, kind, version)) {}

void SweepStore::entitle(const SweepTitle& title) {
    database_.transaction([&] {
        database_.prepare("INSERT OR REPLACE INTO title VALUES (1, ?, ?, ?, ?)")
            .bind(1, title.name)
            .bind(2, title.text)
            .bind(3, title.version)
            .bind(4, title.quick ? 1 : 0)
            .run();
    });
}

SweepTitle SweepStore::title() {
    Statement statement = database_.prepare("SELECT name, text, version, quick FROM title");
    if (!statement.step()) {
        fail("{}: says not which sweep it is of", path().string());
    }
    return {statement.text(0), statement.text(1), statement.text(2), statement.integer(3) != 0};
}

bool SweepStore::add(const SweepRow& row) {
    // What was measured once is never overwritten by a second process that measured it too.
    Statement statement = database_.prepare(
        "INSERT INTO run (key, view, status, reason, document, seconds, device) VALUES (?, ?, ?, ?, ?, ?, ?) "
        "ON CONFLICT (key) DO UPDATE SET status = excluded.status, reason = excluded.reason, document = "
        "excluded.document, seconds = excluded.seconds, device = excluded.device, finished = CURRENT_TIMESTAMP "
        "WHERE run.status IN ('absent', 'failed')");
    statement.bind(1, row.key).bind(2, row.view).bind(3, row.status).bind(4, row.reason);
    statement.bind(5, row.document).bind(6, row.seconds).bind(7, row.device).run();
    return database_.changes() > 0;
}

std::map<std::string, std::string> SweepStore::statuses() {
    std::map<std::string, std::string> found;
    Statement statement = database_.prepare("SELECT key, status FROM run");
    while (statement.step()) {
        found.emplace(statement.text(0), statement.text(1));
    }
    return found;
}

std::vector<SweepRow> SweepStore::rows() {
    std::vector<SweepRow> rows;
    Statement statement =
        database_.prepare("SELECT key, view, status, reason, document, seconds, device FROM run ORDER BY key");
    while (statement.step()) {
        rows.push_back({statement.text(0), statement.text(1), statement.text(2), statement.text(3), statement.text(4),
                        statement.real(5), statement.text(6)});
    }
    return rows;
}

Merged merge_stores(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& output) {
    // Read all titles before anything is written.
    std::vector<SweepStore> stores;
    for (const std::filesystem::path& path : inputs) {
        stores.emplace_back(path);
        if (stores.back().title() != stores.front().title()) {
            fail("{}: is of another sweep than {}, or of another version of it", path.string(),
                 inputs.front().string());
        }
    }
    std::error_code code;
    if (std::filesystem::exists(output, code)) {
        fail("{}: is there already; name a new file for what is merged", output.string());
    }
    // Write beside, and rename when whole.
    std::filesystem::path partial = output;
    partial += ".part";
    std::filesystem::remove(partial, code);
    Merged merged;
    {
        SweepStore all(partial, stores.front().title());
        std::set<std::string> seen;
        for (SweepStore& store : stores) {
            for (const SweepRow& row : store.rows()) {
                merged.doubled += seen.insert(row.key).second ? 0 : 1;
                all.add(row);
            }
        }
        merged.rows = seen.size();
    }
    std::filesystem::rename(partial, output);
    return merged;
}

Estimate estimate(const std::vector<SweepRow>& rows, const std::vector<SweepRun>& runs) {
    // Each key counts once, however many grids it stands in.
    std::set<std::string> wanted;
    for (const SweepRun& run : runs) {
        wanted.insert(run.key);
    }
    struct View {
        double seconds = 0, runs = 0;
    };
    std::map<std::string, View> views;
    Estimate result;
    double bytes = 0, seconds = 0, measured = 0;
    for (const SweepRow& row : rows) {
        if (wanted.count(row.key) == 0) {
            continue;
        }
        ++result.finished;
        bytes += static_cast<double>(row.key.size() + row.view.size() + row.document.size() + row.device.size()) + 60;
        if (row.status != "absent") {
            View& view = views[row.view];
            view.seconds += row.seconds;
            view.runs += 1;
            seconds += row.seconds;
            measured += 1;
        }
    }
    result.left = wanted.size() - result.finished;
    if (measured == 0) {
        return result;
    }
    const double mean = seconds / measured, left = static_cast<double>(result.left);
    result.seconds = mean * left;
    result.bytes = row_overhead * bytes / static_cast<double>(result.finished) * static_cast<double>(wanted.size());
    // A ratio of sums over views, which are what was drawn at random: its error by the residuals of the views.
    const auto count = static_cast<double>(views.size());
    if (count > 1) {
        double squares = 0;
        for (const auto& [name, view] : views) {
            squares += (view.seconds - mean * view.runs) * (view.seconds - mean * view.runs);
        }
        result.deviation = left * std::sqrt(squares * count / (count - 1)) / measured;
    }
    return result;
}

std::string spoken_time(double seconds) {
    if (seconds < 90) {
        return fmt::format("{:.0f} s", seconds);
    }
    const auto minutes = static_cast<long long>(std::llround(seconds / 60));
    if (minutes < 90) {
        return fmt::format("{} min", minutes);
    }
    return minutes < 48 * 60 ? fmt::format("{} h {} min", minutes / 60, minutes % 60)
                             : fmt::format("{:.1f} days", static_cast<double>(minutes) / (24 * 60));
}

}  // namespace gn
