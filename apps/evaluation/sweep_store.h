// SPDX-License-Identifier: MIT
// The results of a sweep: one row a finished run, on the disk before the next one begins.
#pragma once

#include "apps/evaluation/database.h"
#include "apps/evaluation/grid.h"

#include <map>

namespace gn {

/// A finished run. `status` is ok, refused, empty, failed, or absent: its recipe or scene is not there (yet).
struct SweepRow {
    std::string key, view;  ///< SweepRun's; `view` is the fingerprint of its view_text
    std::string status, reason;
    std::string document;  ///< the run as in compare.schema.json; "" where absent
    double seconds = 0;    ///< that it took, its share of loading and tracing with it
    std::string device;    ///< that drew it, with its driver
};

/// What a store says of itself: the text that it was asked with, so that a page needs nothing else.
struct SweepTitle {
    std::string name, text, version;
    bool quick = false;
    bool operator==(const SweepTitle&) const = default;
};

class SweepStore {
  public:
    /// Makes the file, or goes on with it. A changed text replaces the old one: runs that are in both are kept. Throws Error.
    SweepStore(const std::filesystem::path& path, const SweepTitle& title);
    /// One that is there already. Throws Error.
    explicit SweepStore(const std::filesystem::path& path);

    [[nodiscard]] SweepTitle title();
    /// Adds a row, all of it or, where the program ends, none. One that is there is replaced where it was absent or failed;
    /// otherwise it stays. Returns whether it was written.
    bool add(const SweepRow& row);
    /// Statuses by key.
    std::map<std::string, std::string> statuses();
    std::vector<SweepRow> rows();
    [[nodiscard]] const std::filesystem::path& path() const { return database_.path(); }

  private:
    void entitle(const SweepTitle& title);
    Database database_;
};

struct Merged {
    std::size_t rows = 0, doubled = 0;  ///< in the new store; that stood in several
};
/// Brings the rows of all into a new store. Throws Error where they are of different sweeps, or `output` is there already.
Merged merge_stores(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& output);

/// What is still to be done, from what is finished.
struct Estimate {
    std::size_t finished = 0, left = 0;
    std::optional<double> seconds, deviation;  ///< that the rest will take, and one standard error of it
    std::optional<double> bytes;               ///< of the store when all is done
};
/// Views are a sample of all views in random order: their mean cost a run foretells the rest. Nothing is foretold from nothing.
Estimate estimate(const std::vector<SweepRow>& rows, const std::vector<SweepRun>& runs);
/// "3 h 10 min", "42 s".
std::string spoken_time(double seconds);

}  // namespace gn
