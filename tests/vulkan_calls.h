// SPDX-License-Identifier: MIT
// Lets Vulkan's calls of this process fail, and counts what they made.
#pragma once

#include <string>
#include <vector>

namespace gn::test {

/// While it lives, a call of this name gives VK_ERROR_DEVICE_LOST once `after` of them succeeded, without doing anything; from
/// then on submitting and waiting do.
class FailingCall {
  public:
    explicit FailingCall(const std::string& call, std::size_t after = 0);
    ~FailingCall();
    FailingCall(const FailingCall&) = delete;
    FailingCall& operator=(const FailingCall&) = delete;
    [[nodiscard]] bool happened() const;
};
/// Names of all calls that can.
const std::vector<std::string>& calls_that_can_fail();

/// Objects of devices that were made and not destroyed: buffers, images, views, memory, pipelines and what they are made of.
std::size_t living();

}  // namespace gn::test
