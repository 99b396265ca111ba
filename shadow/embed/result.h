// SPDX-License-Identifier: MIT
// What calls of the public boundary give: a value, or one sentence why there is none. No exception leaves the library.
#pragma once

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <utility>

namespace gn {

/// A value, or one sentence why there is none. Whoever drops one misses that sentence.
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : value_(std::move(value)) {}  // NOLINT(google-explicit-constructor): returned by value
    static Result failure(const std::string& why) {
        Result result;
        result.why_ = why;
        return result;
    }
    [[nodiscard]] bool ok() const { return value_.has_value(); }
    /// Only where ok().
    [[nodiscard]] T& value() { return *value_; }
    [[nodiscard]] const T& value() const { return *value_; }
    [[nodiscard]] const std::string& why() const { return why_; }

  private:
    Result() = default;
    std::optional<T> value_;
    std::string why_;
};

/// Nothing, where only success matters.
struct Done {};

/// Runs `work`; what it throws becomes a sentence.
template <class T, class Work>
Result<T> guarded(Work&& work) noexcept {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return Result<T>::failure("out of memory");
    } catch (const std::exception& error) {
        return Result<T>::failure(error.what());
    } catch (...) {
        return Result<T>::failure("something unknown was thrown inside the library");
    }
}

}  // namespace gn
