// SPDX-License-Identifier: MIT
// The panel as a table of contents, and the sections that are of the whole.
#include "apps/view/panel.h"

#include "apps/terminal.h"
#include "apps/view/viewer.h"
#include "apps/view/widgets.h"
#include "shadow/show/show.h"

#include <imgui.h>

#include <algorithm>

namespace gn {

void draw_panel(Viewer& viewer, vec2 window) {
    ImGui::SetNextWindowPos({std::max(window.x - panel_width, 0.0F), 0});
    ImGui::SetNextWindowSize({panel_width, window.y});
    ImGui::Begin("panel", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse);
    ImGui::TextUnformatted("gnomon");
    if (viewer.frame_ms() > 0) {
        ImGui::SameLine();
        const std::string rate =
            fmt::format("{:.1f} ms a frame, {:.3g} a second", viewer.frame_ms(), 1e3 / viewer.frame_ms());
        ImGui::TextDisabled("%s", rate.c_str());
    }
    sentence(viewer.message, true);
    draw_recipe_section(viewer);
    draw_parameter_section(viewer);
    draw_look_section(viewer);
    draw_light_section(viewer);
    draw_camera_section(viewer);
    draw_animation_section(viewer);
    draw_cost_section(viewer);
    draw_scene_section(viewer);
    draw_keep_section(viewer);
    ImGui::End();
}

void draw_scene_section(Viewer& viewer) {
    if (!section("Scene", false)) {
        return;
    }
    std::vector<std::string> names;
    for (const BuiltinScene& scene : builtin_scenes()) {
        names.push_back(scene.name);
    }
    std::string chosen = viewer.world().name;
    if (choice_row("scene", "built in", chosen, names, "A scene that Gnomon makes itself.")) {
        viewer.load(chosen, {});
        return;
    }
    if (text_row("scene.file", "name or file", viewer.scene_field,
                 "A built-in scene with parameters (tilted:angle=85), or a .glb, .gltf, .obj or .toml file; Enter "
                 "loads it.")) {
        viewer.load(viewer.scene_field, viewer.world().file);
        return;
    }
    const Scene& scene = viewer.world().scene;
    told_row("triangles", fmt::format("{}", scene.triangles.size()));
    told_row("lights", fmt::format("{}", scene.lights.size()));
    for (const std::string& note : scene.notes) {
        sentence(note, false);
    }
}

void draw_look_section(Viewer& viewer) {
    if (!section("Look", true)) {
        return;
    }
    // What it is held against.
    const std::vector<std::string> kinds(against_names.begin(), against_names.end());
    std::string against = kinds[static_cast<std::size_t>(viewer.against)];
    if (choice_row(
            "against", "beside it", against, kinds,
            "What stands right of the split: another recipe, or the truth, which is traced while nothing moves.")) {
        viewer.against = static_cast<Against>(std::find(kinds.begin(), kinds.end(), against) - kinds.begin());
        if (viewer.against == Against::recipe) {
            viewer.set_other(viewer.other_text);
        }
    }
    if (viewer.against == Against::recipe) {
        std::string other = viewer.other_text;
        if (choice_row("other", "recipe", other, recipe_names(), "The recipe right of the split.")) {
            viewer.set_other(other);
        }
    }
    if (viewer.against != Against::nothing) {
        slider_row("split", "split", viewer.split, 0, 1, "%.2f", "How much of the picture stands left of the line.");
        check_row(
            "error", "signed error", viewer.error,
            "Left of the line, V of the chosen light less what stands beside it: blue where it is too dark, orange "
            "where it is too light.");
    }
    if (viewer.truth() != nullptr) {
        told_row("traced",
                 fmt::format("{} samples, error {:.4f}", viewer.truth()->samples, viewer.truth()->standard_error));
    }

    // What it hides.
    Viewport& viewport = viewer.viewport(viewer.selected);
    std::vector<std::string> names{"the picture"};
    for (const std::span<const HiddenPicture> pictures : {hidden_pictures(), side_pictures()}) {
        for (const HiddenPicture& picture : pictures) {
            names.emplace_back(picture.name);
        }
    }
    std::string shown = viewport.show.empty() ? names.front() : viewport.show;
    const std::string tip = viewport.show.empty()
                                ? "The picture, or what the recipe hides: light views, texels, the map."
                                : std::string(find_hidden(viewport.show).sentence);
    if (choice_row("show", "shown", shown, names, tip.c_str())) {
        viewport.show = shown == names.front() ? "" : shown;
    }
    slider_row("stops", "exposure", viewer.stops, -6, 6, "%+.1f stops",
               "Beside the automatic exposure, which all viewports share.");
    if (!viewer.picture) {
        slider_row("scale", "resolution", viewer.scale, 0.125F, 1, "%.3f",
                   "Pixels that are drawn for one that is shown, along a side.");
    }
}

void draw_keep_section(Viewer& viewer) {
    if (!section("Keep", false)) {
        return;
    }
    text_row("pictures.folder", "folder", viewer.pictures_field, "Where pictures go.");
    if (button("pictures", "Pictures", "The picture of every viewport, as gnomon render --antialias 1 writes it.")) {
        viewer.take_pictures(viewer.pictures_field, viewer.world().scene.name);
    }
    ImGui::SameLine();
    if (button("window", "Window", "The window as it is. F12 does the same.")) {
        viewer.take_window("window.png");
    }
    text_row("session.file", "session", viewer.session_field, "A .toml file.");
    if (button("save", "Save", "Scene, cameras, lights and settings.")) {
        viewer.save_session(viewer.session_field);
    }
    ImGui::SameLine();
    if (button("load", "Load", "What Save wrote.")) {
        viewer.load_session(viewer.session_field);
        return;
    }
    ImGui::SameLine();
    if (button("command", "Copy command", "The command line that shows the same again.")) {
        const std::string command = command_of(viewer.setup());
        ImGui::SetClipboardText(command.c_str());
        viewer.message = command;
    }
}

}  // namespace gn
