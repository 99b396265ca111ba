// SPDX-License-Identifier: MIT
// The viewports in the window, and the mouse and the keyboard over them.
#include "apps/view/camera_control.h"
#include "apps/view/panel.h"
#include "apps/view/viewer.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

constexpr float gap = 6;
constexpr ImU32 label_color = IM_COL32(232, 230, 224, 255), quiet_color = IM_COL32(168, 172, 180, 255),
                warn_color = IM_COL32(240, 178, 92, 255), box_color = IM_COL32(14, 16, 20, 176),
                frame_color = IM_COL32(222, 170, 92, 255);

ImVec2 to_im(vec2 v) {
    return {v.x, v.y};
}
vec2 from_im(ImVec2 v) {
    return {v.x, v.y};
}

struct Cell {
    vec2 low{0}, size{0};
};

/// Cell i of n, in rows as long as they are many.
Cell cell_of(std::size_t i, std::size_t n, vec2 area) {
    const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(n))));
    const std::size_t rows = (n + columns - 1) / columns;
    const vec2 cells(static_cast<float>(columns), static_cast<float>(rows));
    const vec2 size = (area - gap * (cells + 1.0F)) / cells;
    const vec2 at(static_cast<float>(i % columns), static_cast<float>(i / columns));
    return {glm::floor(gap + at * (size + gap)), glm::max(glm::floor(size), vec2(1))};
}

/// As large as fits into the cell with the picture's own proportions.
Cell fitted(const Cell& cell, vec2 picture) {
    const float factor = std::min(cell.size.x / picture.x, cell.size.y / picture.y);
    const vec2 size = glm::max(glm::floor(picture * factor), vec2(1));
    return {glm::floor(cell.low + 0.5F * (cell.size - size)), size};
}

/// Keys that fly: metres along right, up and forward in this frame.
vec3 flight(const Viewer& viewer, float size) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || viewer.plays) {
        return vec3(0);
    }
    const auto key = [](int plus, int minus) {
        return (ImGui::IsKeyDown(plus) ? 1.0F : 0.0F) - (ImGui::IsKeyDown(minus) ? 1.0F : 0.0F);
    };
    // A scene's length takes five seconds, or one with Shift.
    const float speed = (io.KeyShift ? 1.0F : 0.2F) * size * std::min(io.DeltaTime, 0.1F);
    return speed * vec3(key(GLFW_KEY_D, GLFW_KEY_A), key(GLFW_KEY_E, GLFW_KEY_Q), key(GLFW_KEY_W, GLFW_KEY_S));
}

/// Moves the camera, the light or the split by what the mouse did over a viewport.
void move_by_mouse(Viewer& viewer, std::size_t index, const Cell& shown) {
    static bool drags_split = false;
    Viewport& viewport = viewer.viewport(index);
    World& world = viewer.world();
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsItemHovered(), active = ImGui::IsItemActive();
    if (ImGui::IsItemActivated()) {
        const float line = shown.low.x + viewer.split * shown.size.x;
        viewer.selected = index;
        drags_split = viewer.against != Against::nothing && std::abs(io.MousePos.x - line) < 8.0F;
    }
    const vec2 delta = active ? from_im(io.MouseDelta) : vec2(0);
    if (active && drags_split) {
        viewer.split = std::clamp((io.MousePos.x - shown.low.x) / shown.size.x, 0.0F, 1.0F);
        return;
    }
    const float focus =
        std::max(glm::distance(world.scene.bounds_ws.centre(), viewport.camera.position_ws), 1e-3F * world.size());
    const vec2 radians = delta * (viewport.camera.yfov / shown.size.y);
    if (active && io.KeyCtrl && !world.scene.lights.empty()) {
        if (delta != vec2(0)) {
            const vec2 metres = vec2(delta.x, -delta.y) * (focus * viewport.camera.yfov / shown.size.y);
            drag_light(world.scene.lights.at(viewer.light).shape, viewport.camera, 3.0F * radians, metres);
            ++world.lights_version;
        }
        return;
    }
    CameraInput input{.focus = focus};
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        input.look = vec2(-radians.x, radians.y);
    } else if (ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
        input.orbit = vec2(4.0F * radians.x, -4.0F * radians.y);
    } else {
        input.move = vec3(-radians.x, radians.y, 0) * focus;
    }
    input.move.z += hovered ? 0.05F * io.MouseWheel * world.size() : 0.0F;
    input.move += index == viewer.selected ? flight(viewer, world.size()) : vec3(0);
    Camera camera = viewport.camera;
    if (move_camera(camera, input, world.scene.bounds_ws)) {
        viewer.plays = false;
        viewer.set_camera(index, camera, false);
    }
}

/// A line of text on a dark box, its lower left corner at `at`; gives the height that it took.
float label(vec2 at, float width, const std::string& text, ImU32 color) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, width - 16.0F);
    list.AddRectFilled({at.x, at.y - size.y - 6.0F}, {at.x + size.x + 16.0F, at.y}, box_color, 4.0F);
    list.AddText(nullptr, 0.0F, {at.x + 8.0F, at.y - size.y - 3.0F}, color, text.c_str(), nullptr, width - 16.0F);
    return size.y + 10.0F;
}

std::string against_text(const Viewer& viewer) {
    if (viewer.against == Against::recipe) {
        return viewer.other_text;
    }
    const std::shared_ptr<TruthPictures>& truth = viewer.truth();
    return truth == nullptr ? "truth: waiting until nothing moves" : fmt::format("truth, {} samples", truth->samples);
}

void write_labels(Viewer& viewer, std::size_t index, const Cell& shown) {
    const Viewport& viewport = viewer.viewport(index);
    vec2 at = shown.low + vec2(6, shown.size.y - 6);
    const float width = shown.size.x - 12.0F;
    const std::string recipe = viewport.recipe.text().text() + (viewport.recipe.awaits() ? "  ..." : "");
    at.y -= label(at, width, viewport.show.empty() ? recipe : recipe + "  |  " + viewport.show, label_color);
    if (!viewport.legend.empty()) {
        at.y -= label(at, width, viewport.legend, quiet_color);
    }
    if (!viewport.trouble.empty()) {
        label(at, width, viewport.trouble, warn_color);
    }
    if (viewer.against != Against::nothing && viewport.show.empty()) {
        const std::string text = against_text(viewer);
        const float size = ImGui::CalcTextSize(text.c_str()).x + 16.0F;
        label(shown.low + vec2(shown.size.x - size - 6.0F, shown.size.y - 6.0F), size + 1.0F, text, label_color);
    }
}

void draw_one(Viewer& viewer, std::size_t index, const Cell& cell) {
    // The picture's size in pixels, whatever it is shown at.
    Viewport& viewport = viewer.viewport(index);
    const vec2 wanted = viewer.picture ? vec2(viewer.picture->width, viewer.picture->height) : cell.size * viewer.scale;
    viewport.width = static_cast<uint>(std::max(wanted.x, 8.0F));
    viewport.height = static_cast<uint>(std::max(wanted.y, 8.0F));
    vec2 proportions(viewport.width, viewport.height);
    if (!viewport.show.empty() && viewport.drawn()) {
        proportions = vec2(viewport.shown().desc().width, viewport.shown().desc().height);
    }
    const Cell shown = fitted(cell, proportions);

    ImGui::SetCursorScreenPos(to_im(cell.low));
    ImGui::PushID(static_cast<int>(index));
    ImGui::InvisibleButton(
        "viewport", to_im(cell.size),
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
    ImGui::PopID();
    move_by_mouse(viewer, index, shown);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t{index + 2}), to_im(shown.low),
                  to_im(shown.low + shown.size));
    if (index == viewer.selected && viewer.viewports() > 1) {
        list.AddRect(to_im(shown.low - 2.0F), to_im(shown.low + shown.size + 2.0F), frame_color, 3.0F, 0, 1.5F);
    }
    write_labels(viewer, index, shown);
}

/// Keys that are no flight.
void take_keys(Viewer& viewer) {
    if (ImGui::GetIO().WantTextInput) {
        return;
    }
    if (ImGui::IsKeyPressed(GLFW_KEY_TAB, false)) {
        viewer.panel = !viewer.panel;
    }
    if (ImGui::IsKeyPressed(GLFW_KEY_SPACE, false)) {
        const bool stood = !viewer.plays && !viewer.animates;
        viewer.plays = viewer.animates = stood;
    }
    if (ImGui::IsKeyPressed(GLFW_KEY_F12, false)) {
        viewer.take_window("window.png");
    }
}

}  // namespace

void draw_stage(Viewer& viewer, vec2 window) {
    take_keys(viewer);
    const vec2 area = glm::max(window - vec2(viewer.panel ? panel_width : 0.0F, 0.0F), vec2(64));
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(to_im(area));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::Begin("stage", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoNav);
    for (std::size_t i = 0; i < viewer.viewports(); ++i) {
        draw_one(viewer, i, cell_of(i, viewer.viewports(), area));
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

}  // namespace gn
