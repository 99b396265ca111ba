// SPDX-License-Identifier: MIT
// What a person sees and touches: viewports, and the panel beside them.
#pragma once

#include "base/math.h"

namespace gn {

class Viewer;

/// A calm dark theme, and a font that is legible at 1280 x 720. Of the current ImGui context.
void set_style();
/// The window's background, sRGB-encoded.
vec4 background_color();

/// Lays the viewports out in what the panel leaves of the window, gives each its size, and moves cameras and lights.
void draw_stage(Viewer& viewer, vec2 window);
void draw_panel(Viewer& viewer, vec2 window);
inline constexpr float panel_width = 372;

// Sections of the panel.
void draw_scene_section(Viewer& viewer);
void draw_recipe_section(Viewer& viewer);
void draw_parameter_section(Viewer& viewer);
void draw_light_section(Viewer& viewer);
void draw_camera_section(Viewer& viewer);
void draw_animation_section(Viewer& viewer);
void draw_look_section(Viewer& viewer);
void draw_cost_section(Viewer& viewer);
void draw_keep_section(Viewer& viewer);

/// Where a widget stood in the latest frame, pixels: its key is the recipe's ("pcf.size") or the section's name. Null where it
/// was not drawn.
struct Place {
    vec2 low{0}, high{0};
};
const Place* place_of(const char* key);

}  // namespace gn
