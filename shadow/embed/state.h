// SPDX-License-Identifier: MIT
// What stands behind gn::embed::Shadows.
#pragma once

#include "gpu/baked_shaders.h"
#include "gpu/frames.h"
#include "gpu/pipeline_compiler.h"
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

/// The recipe as it is asked for.
std::string text_of(const Recipe& recipe);

struct Shadows::State {
    State(const Info& asked, std::shared_ptr<const BakedShaders> found, std::unique_ptr<Device> given);

    Info info;
    std::shared_ptr<const BakedShaders> baked;  ///< null: shaders have sources
    std::unique_ptr<Device> device;
    std::shared_ptr<const PreparedRecipe> recipe;  ///< null: none is there yet
    std::shared_ptr<History> history;
    std::set<std::string> late_remarks;  ///< answers of frames write it, so that it outlives them
    Frames frames;
    LentImages images;
    LentCasters casters;
    std::shared_ptr<const PreparedRecipe> awaited;  ///< whose pipelines a thread makes; null: nothing is awaited
    std::string failed;                             ///< why what was awaited last never comes
    std::unique_ptr<PipelineCompiler> compiler;     ///< null until something is awaited

    void forget_history();
    /// Loads a recipe, checked. Throws Error.
    [[nodiscard]] std::shared_ptr<const PreparedRecipe> load(const std::string& text) const;
    /// Throws Error where the baked folder lacks a shader that the recipe's frames bind.
    void demand_shaders(const PreparedRecipe& with) const;
    /// One sentence, with the command that bakes it.
    [[nodiscard]] std::string missing_from(const PreparedRecipe& with, const MissingShader& missing) const;
    /// The recipe that frames are drawn with, or that they wait for. Throws Error where there is none.
    [[nodiscard]] const PreparedRecipe& present() const;
    void set(std::shared_ptr<const PreparedRecipe> next);
    void await(std::shared_ptr<const PreparedRecipe> next);
    /// Takes the awaited recipe where the frame would find every pipeline that it binds with it.
    void take_awaited(const Frame& frame);
    [[nodiscard]] bool is_ready(const Frame& frame) const;
    std::vector<std::string> record(VkCommandBuffer commands, const Frame& frame);
    [[nodiscard]] Foreseen foresee(const Frame& frame) const;
    std::size_t reload();
    /// Begins the frame's slot, and declares.
    Foreseen begin(FrameGraph& graph, const Frame& frame);

    /// Throws Error where the frame is beyond the limits.
    void check(const Frame& frame) const;
    /// Adds the frame's passes. Gives why lights have no shadow, and what the casters' draws must match.
    Foreseen declare(FrameGraph& graph, const Lenders& lenders, const Frame& frame, const PreparedRecipe& with) const;
    /// The same without any recipe: every light is seen from everywhere.
    Foreseen declare_lit(FrameGraph& graph, const Frame& frame);
};

}  // namespace gn::embed
