// SPDX-License-Identifier: MIT
// Draws depth, normals and colours of the world.
#pragma once

#include "camera.h"
#include "pipeline.h"
#include "targets.h"
#include "world.h"

class ScenePass {
  public:
    ScenePass(const HostDevice& host, const World& world);

    /// Leaves depth as DEPTH_ATTACHMENT_OPTIMAL, normals as COLOR_ATTACHMENT_OPTIMAL, colours for the shading to read.
    void record(VkCommandBuffer commands, const Targets& targets, const HostBuffer& transforms,
                const glm::mat4& cs_from_ws) const;

    /// Vertices and indices of all meshes.
    void bind_meshes(VkCommandBuffer commands) const;
    [[nodiscard]] const HostBuffer& vertices() const { return vertices_; }
    [[nodiscard]] const HostBuffer& indices() const { return indices_; }

  private:
    const World& world_;
    HostBuffer vertices_, indices_, colors_;
    Pipeline pipeline_;
};
