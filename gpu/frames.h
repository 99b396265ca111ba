// SPDX-License-Identifier: MIT
// What outlives the declaration of a frame: plans and transient resources by the declaration's fingerprint, and for each
// frame in flight its constants, its timestamps and what retires with it. A steady frame finds all of it here: it records,
// and creates nothing and waits for nothing.
//
//     Frames frames(device, 2);
//     for (std::uint32_t slot = 0;; slot = 1 - slot) {
//         wait_for(fences[slot]);                     // the caller's: what the slot recorded last has completed
//         frames.begin(slot);
//         FrameGraph graph(device);
//         declare(graph);
//         graph.record(frames, commands);             // into the caller's command buffer
//     }
#pragma once

#include "gpu/frame_graph.h"

#include <memory>

namespace gn {

struct GraphDeclaration;
struct Imports;

/// A buffer whose final contents somebody waits for.
struct Answer {
    std::uint32_t buffer = 0;  ///< index of the handle
    std::function<void(std::span<const std::byte>)> receive;
};

class Frames {
  public:
    /// in_flight: slots, 1 to 8. Throws Error.
    explicit Frames(Device& device, std::uint32_t in_flight = 2);
    /// The device must have finished with every slot.
    ~Frames();
    Frames(const Frames&) = delete;
    Frames& operator=(const Frames&) = delete;

    [[nodiscard]] std::uint32_t in_flight() const;
    /// Takes a slot up again; the caller has waited until the device finished what was recorded with it last. What
    /// retired with the slot is destroyed here, and what its passes took becomes known. Throws Error for a slot that is
    /// not there.
    void begin(std::uint32_t slot);
    /// Keeps an object until the slot in hand is taken up again: a frame in flight may still use it.
    void retire(std::shared_ptr<const void> object);
    /// The account of a slot's last completed use; times are 0 where the device has no meaningful timestamps.
    [[nodiscard]] const GraphStatistics& completed(std::uint32_t slot) const;
    /// Plans that are kept now.
    [[nodiscard]] std::size_t plans() const;

    /// For FrameGraph::record. Gives the layouts that all textures are left in.
    const std::vector<std::vector<VkImageLayout>>& write(const GraphDeclaration& declaration, const Imports& imports,
                                                         const std::vector<std::function<void(Recorder&)>>& executes,
                                                         const std::vector<Answer>& answers, VkCommandBuffer commands);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gn
