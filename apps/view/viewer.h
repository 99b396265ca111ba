// SPDX-License-Identifier: MIT
// The viewer: a scene, viewports that show it, a panel, and what they all stand still or move by. With a window it draws into
// that; without one it draws the same pictures.
#pragma once

#include "apps/view/truth_worker.h"
#include "apps/view/viewport.h"
#include "apps/view/window.h"
#include "apps/view/window_frame.h"

#include <array>
#include <filesystem>

struct ImGuiContext;

namespace gn {

class Viewer {
  public:
    /// `window`: null where there is none; attached to the device. Throws Error.
    Viewer(Device& device, ViewSetup setup, Window* window);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// One frame: input, panel, viewports, and the window where there is one. Throws Error on a lost device.
    void frame();
    /// Waits for the device, and for all pictures that were asked for.
    void finish();
    [[nodiscard]] std::uint64_t frames_drawn() const { return drawn_; }

    // What the panel and the keyboard do. What fails says so in `message` and leaves all as it was.
    void load(const std::string& scene, const FileOptions& file);
    void load_session(const std::string& path);
    void save_session(const std::string& path);
    void set_recipe(std::size_t viewport, const std::string& text);
    /// A key of the viewport's recipe, as sliders do.
    void set_key(std::size_t viewport, std::string_view key, const std::string& value);
    void set_other(const std::string& text);
    void add_viewport();
    void remove_viewport(std::size_t viewport);
    /// Moves all to a time of an animation, "" to where it is at rest; viewports that look through a camera of the scene stay
    /// with it.
    void set_pose(const std::string& animation, double seconds);
    void set_camera(std::size_t viewport, const Camera& camera, bool cut);  ///< of all where they are linked
    /// The window as it is shown, once the next frame has completed.
    void take_window(const std::filesystem::path& path);
    /// The picture of every viewport, as `gnomon render --antialias 1` writes it: FOLDER/NAME-RECIPE.png.
    void take_pictures(const std::filesystem::path& folder, const std::string& name);
    /// All as it stands, for a file or a command line.
    [[nodiscard]] ViewSetup setup() const;

    [[nodiscard]] World& world() { return *world_; }
    [[nodiscard]] Viewport& viewport(std::size_t i) { return *viewports_.at(i); }
    [[nodiscard]] std::size_t viewports() const { return viewports_.size(); }
    [[nodiscard]] Device& device() { return device_; }
    [[nodiscard]] const std::shared_ptr<TruthPictures>& truth() const { return truth_; }
    [[nodiscard]] double frame_ms() const { return frame_ms_; }  ///< mean over ten frames, from begin to begin

    static constexpr std::size_t most_viewports = 9;

    std::size_t selected = 0;  ///< the viewport that the panel is of
    bool linked = true, error = false, panel = true, measures = false;
    bool plays = false, animates = false;  ///< the camera path; the animation
    float speed = 1;                       ///< seconds of the animation in one
    Against against = Against::nothing;
    float split = 0.5F, stops = 0, scale = 1;
    std::size_t light = 0;
    std::optional<Size> picture;  ///< of every viewport; unset: as large as it is shown, times scale
    std::string message;          ///< the latest sentence for whoever looks
    std::string scene_field, session_field = "session.toml", pictures_field = "pictures";
    std::string other_text = "hard";
    std::size_t path_frame = 0;

  private:
    void make_viewports(const std::vector<ViewportSetup>& setups);
    void swap_world(std::unique_ptr<World> world, const std::vector<ViewportSetup>& setups);
    void apply(const ViewSetup& setup);
    [[nodiscard]] std::vector<ViewportSetup> viewport_setups(bool with_cameras) const;
    uvec2 begin_input();
    void play();
    void animate();
    void follow_truth();
    void take_stage();
    [[nodiscard]] std::string truth_key(const Viewport& viewport) const;
    SharedView shared_of(const Viewport& viewport);
    void draw_viewports(VkCommandBuffer commands);
    void draw_window(VkCommandBuffer commands, uvec2 size, std::optional<std::uint32_t> image);
    void count_time();
    /// What a person asked for and cannot be had becomes the message.
    template <class Action>
    void trying(const Action& action) {
        try {
            action();
        } catch (const std::exception& failed) {
            message = failed.what();
        }
    }

    Device& device_;
    Window* window_;
    ImGuiContext* context_ = nullptr;
    ViewSetup first_;
    std::unique_ptr<World> world_;
    std::vector<std::shared_ptr<Viewport>> viewports_;
    PipelineCompiler compiler_;
    Frames frames_;  ///< of the window's picture
    std::array<std::unique_ptr<WindowFrame>, 2> slots_;
    std::uint32_t slot_ = 0;
    std::uint64_t drawn_ = 0;
    Buffer exposure_;
    Texture2D fonts_;
    std::shared_ptr<Texture2D> picture_;  ///< the window's
    std::filesystem::path take_window_;

    std::unique_ptr<TruthWorker> worker_;  ///< null until the truth is asked for
    std::shared_ptr<TruthPictures> truth_;
    std::string truth_key_;
    int still_ = 0;  ///< frames in which nothing of it moved

    double frame_ms_ = 0, last_ = 0;
    std::vector<double> recent_ms_;
};

}  // namespace gn
