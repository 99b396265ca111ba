// SPDX-License-Identifier: MIT
#include "apps/view/widgets.h"

#include "apps/view/panel.h"

#include <imgui.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace gn {
namespace {

std::map<std::string, Place, std::less<>>& places() {
    static std::map<std::string, Place, std::less<>> noted;
    return noted;
}

/// Notes where the item that was drawn last stands, and shows its tip.
void finish_item(const char* key, const char* tip) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    places()[key] = {{low.x, low.y}, {high.x, high.y}};
    if (tip[0] != '\0' && ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(320.0F);
        ImGui::TextUnformatted(tip);
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
}

/// The name, and room for its widget.
void begin_row(const char* name) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(name);
    ImGui::SameLine(0.42F * ImGui::GetWindowWidth());
    ImGui::SetNextItemWidth(-1.0F);
}

struct Id {
    explicit Id(const char* key) { ImGui::PushID(key); }
    ~Id() { ImGui::PopID(); }
    Id(const Id&) = delete;
    Id& operator=(const Id&) = delete;
};

/// A unit behind a number, as formats of printf have it.
std::string unit_format(std::string_view unit) {
    std::string text = unit.empty() ? "" : " ";
    for (const char c : unit) {
        text += c == '%' ? "%%" : std::string(1, c);
    }
    return text;
}

double number_of(const std::string& text) {
    double value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

}  // namespace

const Place* place_of(const char* key) {
    const auto found = places().find(std::string_view(key));
    return found != places().end() ? &found->second : nullptr;
}

bool section(const char* title, bool open) {
    ImGui::Dummy({0, 3});
    const bool shown = ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    finish_item(title, "");
    return shown;
}

bool slider_row(const char* key, const char* name, float& value, float low, float high, const char* format,
                const char* tip, bool logarithmic) {
    const Id id(key);
    begin_row(name);
    const bool changed = ImGui::SliderFloat("##value", &value, low, high, format,
                                            logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    finish_item(key, tip);
    return changed;
}

bool slider_row(const char* key, const char* name, int& value, int low, int high, const char* format, const char* tip) {
    const Id id(key);
    begin_row(name);
    const bool changed = ImGui::SliderInt("##value", &value, low, high, format,
                                          high - low > 256 ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    finish_item(key, tip);
    return changed;
}

bool check_row(const char* key, const char* name, bool& value, const char* tip) {
    const Id id(key);
    begin_row(name);
    const bool changed = ImGui::Checkbox("##value", &value);
    finish_item(key, tip);
    return changed;
}

bool choice_row(const char* key, const char* name, std::string& value, std::span<const std::string> choices,
                const char* tip) {
    const Id id(key);
    begin_row(name);
    bool changed = false;
    const bool open = ImGui::BeginCombo("##value", value.c_str(), ImGuiComboFlags_HeightLarge);
    finish_item(key, open ? "" : tip);
    if (open) {
        for (const std::string& choice : choices) {
            if (ImGui::Selectable(choice.c_str(), choice == value) && choice != value) {
                value = choice;
                changed = true;
            }
            places()[std::string(key) + ":" + choice] = {{ImGui::GetItemRectMin().x, ImGui::GetItemRectMin().y},
                                                         {ImGui::GetItemRectMax().x, ImGui::GetItemRectMax().y}};
        }
        ImGui::EndCombo();
    }
    return changed;
}

bool text_row(const char* key, const char* name, std::string& value, const char* tip) {
    const Id id(key);
    begin_row(name);
    value.resize(std::max<std::size_t>(value.size(), 1) + 1024, '\0');
    const bool ended = ImGui::InputText("##value", value.data(), value.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    value.resize(value.find('\0'));
    finish_item(key, tip);
    return ended;
}

void told_row(const char* name, const std::string& value, const char* tip) {
    begin_row(name);
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextUnformatted(value.c_str());
    ImGui::PopStyleColor();
    finish_item(name, tip);
}

void bar(const std::string& name, const std::string& figure, float share, bool warm) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight() + 4.0F;
    const float length = std::clamp(share, 0.0F, 1.0F) * width;
    list.AddRectFilled(at, {at.x + width, at.y + height}, IM_COL32(255, 255, 255, 9), 3.0F);
    list.AddRectFilled(at, {at.x + length, at.y + height},
                       warm ? IM_COL32(196, 138, 62, 130) : IM_COL32(84, 124, 178, 120), 3.0F);
    const float right = ImGui::CalcTextSize(figure.c_str()).x;
    ImGui::PushClipRect(at, {at.x + width - right - 12.0F, at.y + height}, true);
    list.AddText({at.x + 6.0F, at.y + 2.0F}, ImGui::GetColorU32(ImGuiCol_Text), name.c_str());
    ImGui::PopClipRect();
    list.AddText({at.x + width - right - 6.0F, at.y + 2.0F}, ImGui::GetColorU32(ImGuiCol_Text), figure.c_str());
    ImGui::Dummy({width, height});
}

bool button(const char* key, const char* name, const char* tip) {
    const Id id(key);
    const bool pressed = ImGui::Button(name);
    finish_item(key, tip);
    return pressed;
}

void sentence(const std::string& text, bool warn) {
    if (text.empty()) {
        return;
    }
    ImGui::PushStyleColor(ImGuiCol_Text,
                          warn ? ImVec4(0.94F, 0.70F, 0.36F, 1) : ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
}

bool parameter_row(const std::string& key, const ParamRow& row, std::string& value) {
    const std::string name(row.name), unit(row.unit.empty() ? "" : " " + std::string(row.unit));
    const std::string tip = fmt::format("{}\n{}{}", row.sentence, key,
                                        row.choices.empty() && row.type != ParamType::boolean
                                            ? fmt::format(", {} to {}{}", row.min, row.max, unit)
                                            : "");
    switch (row.type) {
        case ParamType::boolean: {
            bool on = value == "true";
            const bool changed = check_row(key.c_str(), name.c_str(), on, tip.c_str());
            value = on ? "true" : "false";
            return changed;
        }
        case ParamType::choice: {
            const std::vector<std::string> choices(row.choices.begin(), row.choices.end());
            return choice_row(key.c_str(), name.c_str(), value, choices, tip.c_str());
        }
        case ParamType::integer: {
            int number = static_cast<int>(number_of(value));
            const bool changed =
                slider_row(key.c_str(), name.c_str(), number, static_cast<int>(row.min), static_cast<int>(row.max),
                           ("%d" + unit_format(row.unit)).c_str(), tip.c_str());
            value = fmt::format("{}", number);
            return changed;
        }
        case ParamType::real: break;
    }
    // Ranges that hold several powers of ten are logarithmic.
    auto number = static_cast<float>(number_of(value));
    const bool wide = row.max >= 50.0 && row.min >= 0.0;
    const bool changed =
        slider_row(key.c_str(), name.c_str(), number, static_cast<float>(row.min), static_cast<float>(row.max),
                   ("%.4g" + unit_format(row.unit)).c_str(), tip.c_str(), wide);
    number = std::clamp(number, static_cast<float>(row.min), static_cast<float>(row.max));
    value = changed ? fmt::format("{}", number) : value;
    return changed;
}

}  // namespace gn
