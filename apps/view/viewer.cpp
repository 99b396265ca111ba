// SPDX-License-Identifier: MIT
// One frame of the viewer, from input to window.
#include "apps/view/viewer.h"

#include "apps/choose.h"
#include "apps/view/display.h"
#include "apps/view/panel.h"
#include "apps/view/ui_pass.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <chrono>
#include <cmath>
#include <numeric>

namespace gn {
namespace {

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

TextureDesc window_picture(uvec2 size) {
    return {.name = "window",
            .format = VK_FORMAT_R8G8B8A8_UNORM,
            .width = size.x,
            .height = size.y,
            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
}

/// Bytes of a RGBA8 picture as an Image.
Image image_of(std::span<const std::byte> bytes, uvec2 size) {
    Image image(static_cast<int>(size.x), static_cast<int>(size.y), 3);
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            image.values[3 * i + c] = static_cast<float>(std::to_integer<int>(bytes[4 * i + c])) / 255.0F;
        }
    }
    return image;
}

}  // namespace

Viewer::Viewer(Device& device, ViewSetup setup, Window* window)
    : device_(device),
      window_(window),
      first_(std::move(setup)),
      world_(std::make_unique<World>(device, first_.scene, first_.file, first_.window)),
      compiler_(device),
      frames_(device, 2),
      exposure_(device, exposure_buffer()) {
    apply(first_);
    make_viewports(first_.viewports);
    for (std::unique_ptr<WindowFrame>& slot : slots_) {
        slot = std::make_unique<WindowFrame>(device_);
    }
    context_ = ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    if (window_ != nullptr) {
        ImGui_ImplGlfw_InitForVulkan(window_->glfw(), true);
    }
    set_style();
    fonts_ = upload_fonts(device_);
}

Viewer::~Viewer() {
    vkDeviceWaitIdle(device_.vk());
    worker_.reset();
    if (window_ != nullptr) {
        ImGui_ImplGlfw_Shutdown();
    }
    ImGui::DestroyContext(context_);
}

void Viewer::frame() {
    // The slot's last frame has completed: what it answers arrives.
    WindowFrame& slot = *slots_[slot_];
    slot.wait();
    count_time();
    frames_.begin(slot_);
    for (const std::shared_ptr<Viewport>& viewport : viewports_) {
        viewport->begin(slot_);
    }

    // What the person does, and what moves by itself.
    const uvec2 size = begin_input();
    ImGui::NewFrame();
    play();
    draw_stage(*this, vec2(size));
    if (panel) {
        draw_panel(*this, vec2(size));
    }
    ImGui::Render();
    follow_truth();

    // The viewports, and the window that shows them.
    std::optional<std::uint32_t> image;
    if (window_ != nullptr && !(image = window_->acquire(slot.acquired()))) {
        return;
    }
    VkCommandBuffer commands = slot.begin();
    world_->bring(commands, slot_);
    draw_viewports(commands);
    draw_window(commands, size, image);
    slot.submit(image ? window_->rendered(*image) : VK_NULL_HANDLE);
    if (image) {
        window_->present(*image);
    }
    slot_ = 1 - slot_;
    ++drawn_;
}

uvec2 Viewer::begin_input() {
    ImGuiIO& io = ImGui::GetIO();
    if (window_ != nullptr) {
        ImGui_ImplGlfw_NewFrame();
        return glm::max(window_->size(), uvec2(1));
    }
    const uvec2 size(static_cast<uint>(first_.window.width), static_cast<uint>(first_.window.height));
    io.DisplaySize = {static_cast<float>(size.x), static_cast<float>(size.y)};
    io.DeltaTime = 1.0F / 60.0F;
    return size;
}

void Viewer::animate() {
    const Rig& rig = world_->loaded.rig;
    if (!animates || !rig.moves()) {
        return;
    }
    // The first frame shows where it begins; after the last key it begins anew.
    const FileOptions& now = world_->file;
    if (now.animation.empty()) {
        set_pose(rig.animations.front().name, 0);
    } else if (drawn_ > 0) {
        const double length = rig.animations[find_animation(rig, now.animation)].seconds;
        const double next = now.time + static_cast<double>(speed * ImGui::GetIO().DeltaTime);
        set_pose(now.animation, length > 0 ? std::fmod(next, length) : 0);
    }
}

void Viewer::play() {
    animate();
    if (!plays || world_->scene.paths.empty()) {
        return;
    }
    const std::vector<Camera>& path = world_->scene.paths.front().frames;
    path_frame = (path_frame + 1) % path.size();
    set_camera(selected, path[path_frame], path_frame == 0);
}

SharedView Viewer::shared_of(const Viewport& viewport) {
    return {.against = against,
            .split = split,
            .error = error,
            .light = light,
            .stops = stops,
            .exposure = &exposure_,
            .measures = measures && !device_.has(Feature::timestamps),
            .truth = truth_ != nullptr && truth_key(viewport) == truth_key_ ? truth_ : nullptr};
}

void Viewer::draw_viewports(VkCommandBuffer commands) {
    // All are shown by one exposure, so that pictures can be compared: that of the first that shows one.
    bool sets_exposure = true;
    for (const std::shared_ptr<Viewport>& viewport : viewports_) {
        viewport->draw(commands, compiler_, shared_of(*viewport), sets_exposure);
        sets_exposure = sets_exposure && !viewport->show.empty();
    }
}

void Viewer::draw_window(VkCommandBuffer commands, uvec2 size, std::optional<std::uint32_t> image) {
    if (picture_ == nullptr || !serves(picture_->desc(), window_picture(size))) {
        frames_.retire(std::exchange(picture_, std::make_shared<Texture2D>(device_, window_picture(size))));
    }
    FrameGraph graph(device_);
    const TextureHandle target = graph.import(*picture_);
    std::vector<TextureHandle> textures{graph.import(fonts_)};
    for (const std::shared_ptr<Viewport>& viewport : viewports_) {
        textures.push_back(graph.import(viewport->shown()));
    }
    add_ui(graph, *ImGui::GetDrawData(), textures, target, background_color());
    if (!take_window_.empty()) {
        add_answer(graph, target, [this, size, path = std::exchange(take_window_, {})](auto bytes) {
            trying([&] {
                write_png(path, image_of(bytes, size));
                message = window_ != nullptr ? "wrote " + path.string() : "";
            });
        });
    }
    if (image) {
        graph.add_pass(
            "present",
            [&](PassBuilder& pass) {
                pass.copy_from(target);
                pass.keep();
            },
            [this, size, image](Recorder& r) {
                if (r.vk() != VK_NULL_HANDLE) {
                    window_->copy(r.vk(), picture_->vk(), size, *image);
                    r.forget();
                }
            });
    }
    graph.record(frames_, commands);
}

void Viewer::finish() {
    // The slot in hand comes last, so that it stays in hand.
    for (const std::uint32_t slot : {1 - slot_, slot_}) {
        slots_[slot]->wait();
        frames_.begin(slot);
        for (const std::shared_ptr<Viewport>& viewport : viewports_) {
            viewport->begin(slot);
        }
    }
}

void Viewer::count_time() {
    const double now = seconds_now();
    // The first frames wait for compilers.
    if (drawn_ > 2) {
        recent_ms_.push_back(1e3 * (now - last_));
    }
    last_ = now;
    if (recent_ms_.size() > 10) {
        recent_ms_.erase(recent_ms_.begin());
    }
    frame_ms_ = recent_ms_.empty() ? 0.0
                                   : std::accumulate(recent_ms_.begin(), recent_ms_.end(), 0.0) /
                                         static_cast<double>(recent_ms_.size());
}

}  // namespace gn
