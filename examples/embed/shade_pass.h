// SPDX-License-Identifier: MIT
// The host's shading, over the whole picture: it reads depth, normals, colours and V of both lights.
#pragma once

#include "camera.h"
#include "pipeline.h"
#include "targets.h"

class ShadePass {
  public:
    explicit ShadePass(const HostDevice& host);
    ~ShadePass();
    ShadePass(const ShadePass&) = delete;
    ShadePass& operator=(const ShadePass&) = delete;

    /// What it reads is in SHADER_READ_ONLY_OPTIMAL. Leaves the picture in TRANSFER_SRC_OPTIMAL.
    void record(VkCommandBuffer commands, const Targets& targets, const HostCamera& camera) const;

  private:
    VkDevice device_;
    VkSampler sampler_ = VK_NULL_HANDLE;
    Pipeline pipeline_;
};
