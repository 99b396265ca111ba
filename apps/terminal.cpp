// SPDX-License-Identifier: MIT
#include "apps/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>

namespace gn {
namespace {

volatile std::sig_atomic_t stop_flag = 0;

extern "C" void on_stop(int /*signal*/) {
    stop_flag = 1;
}

std::size_t terminal_columns() {
    winsize size{};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

/// Characters on screen: UTF-8 continuation bytes take no column.
std::size_t columns(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

Progress::Progress() : terminal_(isatty(STDERR_FILENO) != 0) {}
Progress::~Progress() {
    clear();
}

void Progress::step(int done, int total, std::string label) {
    done_ = done;
    total_ = std::max(total, 1);
    fraction_ = 0;
    label_ = std::move(label);
    draw();
}

void Progress::within(double fraction) {
    // Ten pictures a second are enough for a bar.
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(100)) {
        return;
    }
    fraction_ = std::clamp(fraction, 0.0, 1.0);
    draw();
}

void Progress::draw() {
    if (!terminal_) {
        return;
    }
    last_ = std::chrono::steady_clock::now();
    constexpr int cells = 24;
    const double part = std::clamp((done_ + fraction_) / total_, 0.0, 1.0);
    const int full = static_cast<int>(std::lround(part * cells));
    std::string line;
    for (int i = 0; i < cells; ++i) {
        line += i < full ? "━" : "─";
    }
    line += fmt::format(" {:3.0f} %  {}", part * 100, label_);
    while (columns(line) + 1 > terminal_columns() && !line.empty()) {
        line.pop_back();
    }
    fmt::print(stderr, "\r\033[K{}", line);
    std::fflush(stderr);
    drawn_ = true;
}

void Progress::clear() {
    if (drawn_) {
        fmt::print(stderr, "\r\033[K");
        std::fflush(stderr);
        drawn_ = false;
    }
}

std::string text_table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows,
                       std::size_t left_aligned) {
    // Every column is as wide as its widest cell.
    std::vector<std::size_t> widths;
    for (std::size_t c = 0; c < header.size(); ++c) {
        std::size_t width = columns(header[c]);
        for (const auto& row : rows) {
            width = std::max(width, columns(row.at(c)));
        }
        widths.push_back(width);
    }
    // The last left-aligned column of a table of text needs no padding behind it.
    std::string text;
    const auto add = [&](const std::vector<std::string>& row) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            const std::string padding(widths[c] - columns(row[c]), ' ');
            line += c == 0 ? "" : "  ";
            line += c < left_aligned ? row[c] + padding : padding + row[c];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    };
    add(header);
    for (const auto& row : rows) {
        add(row);
    }
    return text;
}

std::string figure(std::optional<double> value) {
    if (!value || !std::isfinite(*value)) {
        return "-";
    }
    if (*value != 0 && std::abs(*value) < 1e-4) {
        return fmt::format("{:.1e}", *value);
    }
    return std::abs(*value) < 10 ? fmt::format("{:.4f}", *value) : fmt::format("{:.1f}", *value);
}

std::string human_bytes(std::uint64_t bytes) {
    constexpr std::array<std::string_view, 4> units{"B", "KiB", "MiB", "GiB"};
    auto value = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (value >= 1024 && unit + 1 < units.size()) {
        value /= 1024;
        ++unit;
    }
    return unit == 0 ? fmt::format("{} B", bytes) : fmt::format("{:.1f} {}", value, units[unit]);
}

void watch_signals() {
    struct sigaction action {};
    action.sa_handler = on_stop;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() {
    return stop_flag != 0;
}

}  // namespace gn
