// SPDX-License-Identifier: MIT
// The error policy, in one place.
//
//   a user's mistake (file, name, value, combination)   throw Error: one sentence: what, where, what would be valid
//   a combination a part cannot do                      throw Refusal: one sentence naming the limit
//   a broken invariant of our own                       GN_CHECK: prints the values and aborts
//   something that may well be absent                   std::optional
//
// No exception crosses the library's public boundary (shadow/embed/host.h) into a host.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace gn {

/// A user's mistake. what() is one sentence without a trailing newline.
struct Error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A part that says what it cannot do ("planar needs a flat receiver; scene 'fence' has none").
struct Refusal : Error {
    using Error::Error;
};

/// The device or the host has no room for something.
struct OutOfMemory : Error {
    using Error::Error;
};

template <class... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
    throw Error(fmt::format(format, std::forward<Args>(args)...));
}

template <class... Args>
[[noreturn]] void refuse(fmt::format_string<Args...> format, Args&&... args) {
    throw Refusal(fmt::format(format, std::forward<Args>(args)...));
}

/// Prints `expression` with its place and `values`, then aborts.
[[noreturn]] void check_failed(const char* file, int line, const char* expression, const std::string& values);

}  // namespace gn

#define GN_CHECK(condition)                                       \
    do {                                                          \
        if (!(condition)) {                                       \
            gn::check_failed(__FILE__, __LINE__, #condition, ""); \
        }                                                         \
    } while (false)

#define GN_CHECK_EQ(a, b)                                                                             \
    do {                                                                                              \
        const auto& gn_a = (a);                                                                       \
        const auto& gn_b = (b);                                                                       \
        if (!(gn_a == gn_b)) {                                                                        \
            gn::check_failed(__FILE__, __LINE__, #a " == " #b, fmt::format("{} and {}", gn_a, gn_b)); \
        }                                                                                             \
    } while (false)
