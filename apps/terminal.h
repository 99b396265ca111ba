// SPDX-License-Identifier: MIT
// What a person at a terminal sees while and after work is done, and how they stop it.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gn {

/// A bar on standard error, when that is a terminal; otherwise nothing at all.
class Progress {
  public:
    Progress();
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// Work done before this step, of `total` steps.
    void step(int done, int total, std::string label);
    /// The part of this step that is done, 0 to 1.
    void within(double fraction);
    void clear();
    [[nodiscard]] bool terminal() const { return terminal_; }

  private:
    void draw();
    bool terminal_ = false, drawn_ = false;
    int done_ = 0, total_ = 1;
    double fraction_ = 0;
    std::string label_;
    std::chrono::steady_clock::time_point last_{};
};

/// Columns of text, the first ones left-aligned, the rest right-aligned.
std::string text_table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows,
                       std::size_t left_aligned);

/// "0.0123", "1.2e-05", "-" when absent.
std::string figure(std::optional<double> value);
/// "4.0 MiB"
std::string human_bytes(std::uint64_t bytes);

/// From here on the first SIGINT or SIGTERM asks to stop after the current step; the second one stops at once.
void watch_signals();
bool stop_requested();

}  // namespace gn
