// SPDX-License-Identifier: MIT
// For tests that render: one validated device a process, and a fixture that fails on any message.
#pragma once

#include "gpu/frame_graph.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gn {

inline Device& test_device() {
    static const std::unique_ptr<Device> device = Device::create({.validation = true});
    return *device;
}

class Rendered : public ::testing::Test {
  protected:
    void SetUp() override { before_ = test_device().messages().size(); }
    void TearDown() override {
        const std::vector<std::string>& messages = test_device().messages();
        for (std::size_t i = before_; i < messages.size(); ++i) {
            ADD_FAILURE() << "validation: " << messages[i];
        }
    }
    Device& device = test_device();

  private:
    std::size_t before_ = 0;
};

template <class T>
std::vector<T> values_of(const std::vector<std::byte>& bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

/// The text of the Error that `action` throws, or "" when it throws none.
template <class Action>
std::string error_of(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

inline ShaderSource compute_shader(std::string name, std::string text) {
    return {ShaderKind::compute, std::move(name), std::move(text)};
}
inline ShaderSource fragment_shader(std::string name, std::string text) {
    return {ShaderKind::fragment, std::move(name), std::move(text)};
}
inline ShaderSource vertex_shader(std::string name, std::string text) {
    return {ShaderKind::vertex, std::move(name), std::move(text)};
}

}  // namespace gn
