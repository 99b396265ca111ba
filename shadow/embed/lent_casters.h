// SPDX-License-Identifier: MIT
// A renderer's buffers become the scene that parts know: one mesh in world space, made on the device. Positions are made anew
// where poses changed, indices where the topology did.
#pragma once

#include "gpu/frames.h"
#include "shadow/embed/embed.h"
#include "shadow/stages.h"

namespace gn::embed {

class LentCasters {
  public:
    explicit LentCasters(Device& device);

    /// Adds the passes that bring the mesh up to date, and gives what parts know of it. Where the topology changed, buffers
    /// are made for it, and those of before retire with the slot. Throws Error where ranges leave their buffers.
    SceneHandles add(FrameGraph& graph, Frames& frames, const CasterBuffers& casters);
    /// After a frame that failed: what its commands would have made is made with the next.
    void forget() { topology_.reset(); }
    /// The scene of the last add: bounds and objects, without triangles on the CPU.
    [[nodiscard]] Scene& scene() { return scene_; }

  private:
    void rebuild(Frames& frames, const CasterBuffers& casters);

    Device& device_;
    Scene scene_;
    std::shared_ptr<Buffer> positions_, indices_;
    Buffer empty_;
    Texture2D white_;
    std::vector<std::byte> table_;  ///< GnLentObject for every object that casts
    std::uint32_t vertices_ = 0, index_count_ = 0;
    std::optional<std::uint64_t> topology_, poses_;
    std::uint64_t version_ = 0;
    std::shared_ptr<Kept> derived_ = std::make_shared<Kept>();
};

}  // namespace gn::embed
