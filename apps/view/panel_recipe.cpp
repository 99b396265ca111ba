// SPDX-License-Identifier: MIT
// The recipe of the chosen viewport: its parts, and every parameter of every part, from the rows.
#include "apps/view/panel.h"
#include "apps/view/viewer.h"
#include "apps/view/widgets.h"

#include <imgui.h>

#include <algorithm>
#include <array>

namespace gn {
namespace {

/// Names of a stage's parts, the word for none of them first.
std::vector<std::string> names_of(Stage stage) {
    std::vector<std::string> names{stage == Stage::placement ? "auto" : "none"};
    for (const Part* part : all_parts()) {
        if (part->stage == stage) {
            names.emplace_back(part->id);
        }
    }
    return names;
}

void stage_row(Viewer& viewer, const Recipe& recipe, Stage stage) {
    const std::string key(stage_names.at(static_cast<std::size_t>(stage)));
    std::string value = value_of(recipe, key);
    static const std::array<std::string, 6> tips{"Splits a light into several, each served by the stages behind.",
                                                 "Where the light looks from; auto chooses by the light's kind.",
                                                 "What a texel of the map stores.",
                                                 "How a receiver reads the map.",
                                                 "V without any map.",
                                                 "What is made of V: denoised, reprojected."};
    if (choice_row(key.c_str(), key.c_str(), value, names_of(stage),
                   tips.at(static_cast<std::size_t>(stage)).c_str())) {
        viewer.set_key(viewer.selected, key, value);
    }
}

void refusals(const Viewport& viewport, const Scene& scene) {
    for (std::size_t i = 0; i < viewport.refused().size(); ++i) {
        if (!viewport.refused()[i].empty()) {
            sentence(fmt::format("'{}': {}", scene.lights.at(i).name, viewport.refused()[i]), true);
        }
    }
    for (const std::string& remark : viewport.remarks()) {
        sentence(remark, false);
    }
}

void parameter(Viewer& viewer, const Recipe& recipe, const std::string& group, const ParamRow& row) {
    const std::string key = group + "." + std::string(row.name);
    std::string value = value_of(recipe, key);
    if (parameter_row(key, row, value)) {
        viewer.set_key(viewer.selected, key, value);
    }
}

void heading(std::string_view title, std::string_view id) {
    ImGui::Dummy({0, 2});
    ImGui::TextUnformatted(std::string(title).c_str());
    ImGui::SameLine();
    ImGui::TextDisabled("%s", std::string(id).c_str());
}

}  // namespace

void draw_recipe_section(Viewer& viewer) {
    if (!section("Recipe", true)) {
        return;
    }
    // Viewports: one more, one less, one camera or several.
    if (button("viewport.add", "Add viewport", "One more, which looks as this one does.")) {
        viewer.add_viewport();
    }
    ImGui::SameLine();
    if (button("viewport.remove", "Remove", "This viewport.")) {
        viewer.remove_viewport(viewer.selected);
    }
    ImGui::SameLine();
    bool linked = viewer.linked;
    if (ImGui::Checkbox("one camera", &linked)) {
        viewer.linked = linked;
        viewer.set_camera(viewer.selected, viewer.viewport(viewer.selected).camera, false);
    }
    Viewport& viewport = viewer.viewport(viewer.selected);
    std::string name = viewport.recipe.text().base;
    if (choice_row("recipe", "recipe", name, recipe_names(), "A shipped recipe, without overrides.")) {
        viewer.set_recipe(viewer.selected, name);
    }
    std::string text = viewport.recipe.text().text();
    static std::string typed;
    static bool typing = false;
    std::string& field = typing ? typed : text;
    if (text_row("recipe.text", "as text", field,
                 "A recipe's name or .toml file with overrides: pcf,pcf.size=5; Enter takes it.")) {
        viewer.set_recipe(viewer.selected, field);
    }
    typing = ImGui::IsItemActive();
    typed = typing ? field : "";
    const Recipe recipe = viewport.recipe.asked();
    for (const Stage stage :
         {Stage::light, Stage::placement, Stage::map, Stage::lookup, Stage::direct, Stage::visibility}) {
        stage_row(viewer, recipe, stage);
    }
    refusals(viewport, viewer.world().scene);
}

void draw_parameter_section(Viewer& viewer) {
    if (!section("Parameters", true)) {
        return;
    }
    const Recipe recipe = viewer.viewport(viewer.selected).recipe.asked();
    // What the map has of its own: texels along a side, in powers of two, and what it keeps of the casters.
    const bool reads_resolution =
        recipe.map != nullptr || (recipe.direct != nullptr && holds(recipe.direct->reads, "resolution"));
    if (reads_resolution) {
        std::vector<std::string> sizes;
        for (int texels = 64; texels <= 8192; texels *= 2) {
            sizes.push_back(fmt::format("{}", texels));
        }
        std::string resolution = value_of(recipe, "resolution");
        if (choice_row("resolution", "resolution", resolution, sizes,
                       "Texels along a side of the map; of each view where it has several.")) {
            viewer.set_key(viewer.selected, "resolution", resolution);
        }
    }
    if (recipe.map != nullptr) {
        const std::vector<std::string> kinds(caster_names.begin(), caster_names.end());
        std::string casters = value_of(recipe, "casters");
        if (choice_row("casters", "casters", casters, kinds,
                       "What the map keeps of what casts: all, faces, or what lies between.")) {
            viewer.set_key(viewer.selected, "casters", casters);
        }
    }
    for (const Part* part : serving_parts(recipe, viewer.world().scene.lights)) {
        if (part->params.rows.empty()) {
            continue;
        }
        heading(part->title, part->id);
        for (const ParamRow& row : part->params.rows) {
            parameter(viewer, recipe, std::string(part->id), row);
        }
    }
    if (recipe.map != nullptr) {
        heading("Bias", "bias");
        for (const ParamRow& row : bias_params.rows) {
            parameter(viewer, recipe, "bias", row);
        }
    }
}

}  // namespace gn
