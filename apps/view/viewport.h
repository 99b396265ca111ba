// SPDX-License-Identifier: MIT
// One viewport: a camera, a recipe, and the frames that show them. It records the very frame that hosts embed
// (shadow/frame/frame.h) into the viewer's commands, and shows it with one pass more.
#pragma once

#include "apps/view/recipe_text.h"
#include "apps/view/world.h"
#include "gpu/frames.h"
#include "gpu/pipeline_compiler.h"
#include "shadow/frame/frame.h"
#include "shadow/frame/history.h"

#include <functional>
#include <memory>

namespace gn {

/// V of every light that the truth has found so far, on the device; whoever draws with it holds it.
struct TruthPictures {
    std::vector<Texture2D> visibility;
    int samples = 0;
    double standard_error = 0;
};

/// What all viewports of a frame share.
struct SharedView {
    Against against = Against::nothing;
    float split = 0.5F;
    bool error = false;
    std::size_t light = 0;  ///< that the error is of
    float stops = 0;
    Buffer* exposure = nullptr;
    bool measures = false;                 ///< passes are timed by submits of their own, and the frame is waited for
    std::shared_ptr<TruthPictures> truth;  ///< of this viewport's camera; null: not there yet
};

/// A recipe that frames are drawn with, and one that they wait for.
class LiveRecipe {
  public:
    explicit LiveRecipe(Device& device) : device_(device) {}

    /// Takes the text's recipe once a frame would find all its pipelines made. Throws Error where it is none.
    void ask(const RecipeText& text);
    void ask(const RecipeText& text, Recipe recipe);
    [[nodiscard]] bool awaits() const { return awaited_ != nullptr; }
    /// The one that frames are drawn with; null: none yet.
    [[nodiscard]] const std::shared_ptr<const PreparedRecipe>& now() const { return now_; }
    [[nodiscard]] const RecipeText& text() const { return text_; }  ///< of the one asked for last
    [[nodiscard]] const Recipe& asked() const { return (awaited_ ? awaited_ : now_)->recipe(); }
    [[nodiscard]] const std::shared_ptr<History>& history() { return history_; }
    /// Nothing of the frames before is kept: the camera jumped, the scene is another.
    void forget();
    /// Takes the awaited recipe where it is ready: `declare` adds a frame with it and a history. Waits for the compiler where
    /// there is no recipe yet. Throws Error where a shader does not compile; then it is awaited no longer.
    void take(PipelineCompiler& compiler,
              const std::function<void(FrameGraph&, const PreparedRecipe&, History&)>& declare);

  private:
    Device& device_;
    RecipeText text_;
    std::shared_ptr<const PreparedRecipe> now_, awaited_;
    std::shared_ptr<History> history_;
};

class Viewport {
  public:
    Viewport(Device& device, World& world, const ViewportSetup& setup, std::uint32_t frames_in_flight);

    LiveRecipe recipe, other;
    Camera camera;
    std::string show;              ///< a picture of the hidden instead, "" for none
    std::string legend;            ///< what that picture means
    std::string trouble;           ///< why something asked for is not shown, a sentence or ""
    uint width = 64, height = 36;  ///< of the picture, pixels; set before draw

    /// The device has finished with what the slot drew last.
    void begin(std::uint32_t slot);
    /// Records the frame. `sets_exposure`: all viewports are shown by this one's.
    void draw(VkCommandBuffer commands, PipelineCompiler& compiler, const SharedView& shared, bool sets_exposure);
    /// What is shown: RGBA8, sRGB-encoded; ready once draw was called.
    Texture2D& shown() { return *shown_; }
    [[nodiscard]] bool drawn() const { return shown_ != nullptr; }

    /// The next frame's view samples, for the truth, or its picture, for a screenshot, once it has completed.
    void ask_samples(std::function<void(CpuSamples)> receive) { receive_samples_ = std::move(receive); }
    void ask_picture(std::function<void(Image)> receive) { receive_picture_ = std::move(receive); }

    /// Of the frames that completed: means over ten.
    [[nodiscard]] const GraphStatistics& costs() const { return costs_; }
    [[nodiscard]] const std::vector<std::string>& refused() const { return refused_; }  ///< a sentence a light, or ""
    [[nodiscard]] std::set<std::string> remarks() const;
    [[nodiscard]] bool coloured() const;  ///< V has three channels
    /// Another camera or size than in the frame before.
    void cut();
    World& world() { return world_; }

  private:
    struct Side {
        std::vector<TextureHandle> visibility;
        TextureHandle picture;
    };
    Side add_side(FrameGraph& graph, const ViewSamples& samples, const FrameCasters& casters,
                  const PreparedRecipe& with, History& history, std::vector<std::string>* refused);
    ViewSamples add_samples(FrameGraph& graph, FrameCasters& casters);
    void declare(FrameGraph& graph, const SharedView& shared, bool sets_exposure);
    TextureHandle add_truth(FrameGraph& graph, const ViewSamples& samples, const FrameCasters& casters,
                            const SharedView& shared, std::vector<TextureHandle>& visibility);
    void take_recipes(PipelineCompiler& compiler, const SharedView& shared);
    void draw_hidden(const SharedView& shared);
    void make_shown();
    void answer(FrameGraph& graph, const ViewSamples& samples, TextureHandle picture);
    void average(const GraphStatistics& completed);

    Device& device_;
    World& world_;
    Frames frames_;
    std::uint32_t slot_ = 0;
    std::shared_ptr<Texture2D> shown_;
    std::vector<std::string> refused_;
    std::shared_ptr<std::set<std::string>> late_remarks_ = std::make_shared<std::set<std::string>>();
    std::function<void(CpuSamples)> receive_samples_;
    std::function<void(Image)> receive_picture_;
    GraphStatistics costs_;
    std::vector<GraphStatistics> completed_;  ///< the last ten
    std::string hidden_key_;                  ///< of what the picture of the hidden shows
};

}  // namespace gn
