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

    /// Others of the same device for a frame that is only foreseen: buffers may be missing. What is only read is shared.
    [[nodiscard]] LentCasters twin() const;

    /// Adds the passes that bring the mesh up to date, and gives what parts know of it. Where the topology changed, buffers
    /// are made for it, and those of before retire with the slot. Throws Error where ranges leave their buffers. Where the
    /// renderer draws its casters itself there is no mesh, and the handles say so.
    SceneHandles add(FrameGraph& graph, Frames& frames, const CasterBuffers& casters);
    /// After a frame that failed: what its commands would have made is made with the next.
    void forget() { topology_.reset(); }
    /// The scene of the last add: bounds and objects, without triangles on the CPU.
    [[nodiscard]] Scene& scene() { return scene_; }

  private:
    LentCasters(Device& device, std::shared_ptr<Buffer> empty, std::shared_ptr<Texture2D> white, bool foreseen);
    [[nodiscard]] std::shared_ptr<Buffer> borrow(const char* name, const LentBuffer& lent) const;
    void rebuild(Frames& frames, std::span<const CasterObject> objects);

    Device& device_;
    Scene scene_;
    std::shared_ptr<Buffer> positions_, indices_;
    std::shared_ptr<Buffer> empty_;     ///< attributes that no caster has
    std::shared_ptr<Texture2D> white_;  ///< the colour of all
    bool foreseen_;
    bool drawn_ = false;            ///< the last frame's casters were drawn by the renderer
    std::vector<std::byte> table_;  ///< GnLentObject for every object that casts
    std::uint32_t vertices_ = 0, index_count_ = 0;
    std::optional<std::uint64_t> topology_, poses_;
    std::uint64_t version_ = 0;
    std::shared_ptr<Kept> derived_ = std::make_shared<Kept>();
    std::shared_ptr<Moves> moves_ = std::make_shared<Moves>();
};

}  // namespace gn::embed
