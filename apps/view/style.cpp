// SPDX-License-Identifier: MIT
#include "apps/view/panel.h"

#include <imgui.h>

#include <array>
#include <filesystem>

namespace gn {
namespace {

ImVec4 grey(float value, float alpha = 1.0F) {
    // A little blue keeps the greys cool beside the warm accent.
    return {value * 0.94F, value * 0.98F, value * 1.06F, alpha};
}

void set_font() {
    ImFontConfig config;
    config.OversampleH = 3;
    config.OversampleV = 2;
    for (const char* file : {"/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf",
                             "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                             "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"}) {
        std::error_code code;
        if (std::filesystem::is_regular_file(file, code) &&
            ImGui::GetIO().Fonts->AddFontFromFileTTF(file, 15.0F, &config) != nullptr) {
            return;
        }
    }
    // Dear ImGui's own bitmap font where the machine has none of them.
    ImGui::GetIO().Fonts->AddFontDefault();
}

}  // namespace

vec4 background_color() {
    return vec4(0.062F, 0.066F, 0.074F, 1.0F);
}

void set_style() {
    set_font();
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 0;
    style.WindowBorderSize = 0;
    style.FrameRounding = style.GrabRounding = style.PopupRounding = style.ScrollbarRounding = 4;
    style.WindowPadding = {14, 10};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 5};
    style.ItemInnerSpacing = {6, 4};
    style.ScrollbarSize = 10;
    style.GrabMinSize = 10;
    const ImVec4 accent(0.80F, 0.58F, 0.30F, 1.0F), accent_low(0.80F, 0.58F, 0.30F, 0.32F),
        accent_mid(0.80F, 0.58F, 0.30F, 0.50F);
    ImVec4* colors = static_cast<ImVec4*>(style.Colors);
    colors[ImGuiCol_Text] = ImVec4(0.88F, 0.87F, 0.85F, 1);
    colors[ImGuiCol_TextDisabled] = ImVec4(0.58F, 0.60F, 0.63F, 1);
    colors[ImGuiCol_WindowBg] = grey(0.095F);
    colors[ImGuiCol_PopupBg] = grey(0.125F, 0.99F);
    colors[ImGuiCol_Border] = grey(0.24F, 0.6F);
    colors[ImGuiCol_FrameBg] = grey(0.160F);
    colors[ImGuiCol_FrameBgHovered] = grey(0.205F);
    colors[ImGuiCol_FrameBgActive] = grey(0.235F);
    colors[ImGuiCol_Header] = grey(0.150F);
    colors[ImGuiCol_HeaderHovered] = grey(0.200F);
    colors[ImGuiCol_HeaderActive] = grey(0.230F);
    colors[ImGuiCol_Button] = grey(0.185F);
    colors[ImGuiCol_ButtonHovered] = accent_low;
    colors[ImGuiCol_ButtonActive] = accent_mid;
    colors[ImGuiCol_SliderGrab] = ImVec4(accent.x, accent.y, accent.z, 0.60F);
    colors[ImGuiCol_SliderGrabActive] = accent;
    colors[ImGuiCol_CheckMark] = accent;
    colors[ImGuiCol_ScrollbarBg] = grey(0.0F, 0.0F);
    colors[ImGuiCol_ScrollbarGrab] = grey(0.24F);
    colors[ImGuiCol_Separator] = grey(0.20F);
    colors[ImGuiCol_TextSelectedBg] = accent_low;
}

}  // namespace gn
