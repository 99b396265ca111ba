// SPDX-License-Identifier: MIT
// What stands behind gn::embed::Shadows.
#pragma once

#include "gpu/baked_shaders.h"
#include "gpu/frames.h"
#include "shadow/embed/embed.h"
#include "shadow/embed/lent_casters.h"
#include "shadow/embed/lent_images.h"
#include "shadow/frame/frame.h"
#include "shadow/frame/history.h"

#include <set>

namespace gn::embed {

/// What a frame is declared with: that of all frames, or of one that is only foreseen.
struct Lenders {
    Frames& frames;
    LentImages& images;
    LentCasters& casters;
    History& history;
    std::set<std::string>& late_remarks;
};

struct Shadows::State {
    State(const Info& asked, std::shared_ptr<const BakedShaders> found, std::unique_ptr<Device> given);

    Info info;
    std::shared_ptr<const BakedShaders> baked;  ///< null: shaders have sources
    std::unique_ptr<Device> device;
    std::shared_ptr<const PreparedRecipe> recipe;
    std::shared_ptr<History> history;
    std::set<std::string> late_remarks;  ///< answers of frames write it, so that it outlives them
    Frames frames;
    LentImages images;
    LentCasters casters;

    void forget_history();
    void prepare(const std::string& text);
    std::vector<std::string> record(VkCommandBuffer commands, const Frame& frame);
    [[nodiscard]] Foreseen foresee(const Frame& frame) const;
    std::size_t reload();
    /// Begins the frame's slot, and declares.
    Foreseen begin(FrameGraph& graph, const Frame& frame);

    /// Throws Error where the frame is beyond the limits.
    void check(const Frame& frame) const;
    /// Adds the frame's passes. Gives why lights have no shadow, and what the casters' draws must match.
    Foreseen declare(FrameGraph& graph, const Lenders& lenders, const Frame& frame) const;
};

}  // namespace gn::embed
