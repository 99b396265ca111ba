// SPDX-License-Identifier: MIT
#include "shadow/receiver/known.h"

#include "shadow/receiver/parallel_views.h"
#include "shadow/receiver/sample_pass.h"

#include <algorithm>

namespace gn {
namespace {

/// What an array holds at an index. Software reads an array that is indexed by a variable one pixel at a time; so of a few all
/// are read, and one of them is taken.
std::string taken(std::string_view type, std::string_view name, std::string_view array, std::size_t count) {
    std::string text = fmt::format("    {} {} = {}[0];\n", type, name, array);
    for (std::size_t i = 1; i < count; ++i) {
        text += fmt::format("    if (index == {2}) {{ {0} = {1}[{2}]; }}\n", name, array, i);
    }
    return text;
}

/// The view of an index: of views that look one way, the rows that lookups read are made of what differs, 6 numbers for 12.
std::string read_view(const Device& device, const LightViews& views) {
    const std::size_t count = views.views.size();
    if (count > 1 && (!device.info().cpu || count > most_taken)) {
        return "    GnLightView view = views[index];\n";
    }
    const std::string text = taken("GnLightView", "view", "views", count);
    return !parallel_views(views) ? text
                                  : text + taken("GnViewPlace", "place", "view_places", count) +
                                        "    view = gn_along_axes(view, view_axes, place);\n";
}

/// What all views agree in, where the CPU knows them.
std::string shared_by_views(const LightViews& views) {
    std::string text;
    if (views.kind == ViewKind::affine) {
        for (const char* column : {"0].w = 0.0", "1].w = 0.0", "2].w = 0.0", "3].w = 1.0"}) {
            text += fmt::format("    view.cs_from_ws[{};\n", column);
        }
    }
    if (views.buffer.valid()) {
        return text;
    }
    const auto all = [&](auto is) { return std::all_of(views.views.begin(), views.views.end(), is); };
    const GnLightView& first = views.views.front();
    // What follows the light is not told, for the shader would be another in every frame: it is read of one view for all.
    if (views.views.size() > 1 && all([&](const GnLightView& view) { return view.eye_ws == first.eye_ws; })) {
        text += "    view.eye_ws = views[0].eye_ws;\n";
    }
    if (views.views.size() > 1 && all([&](const GnLightView& view) { return view.resolution == first.resolution; })) {
        text += "    view.resolution = views[0].resolution;\n";
    }
    // More than a few are packed as the camera sees them: what they agree in would be another thing in every frame.
    if (views.views.size() > most_taken) {
        return text;
    }
    if (all([&](const GnLightView& view) { return view.grid == first.grid; })) {
        text += fmt::format("    view.grid = {:#};\n", first.grid);
    }
    if (all([&](const GnLightView& view) { return view.eye_ws.w == first.eye_ws.w; })) {
        text += fmt::format("    view.eye_ws.w = {:#};\n", first.eye_ws.w);
    }
    if (all([](const GnLightView& view) { return view.rect_ts == vec4(0, 0, 1, 1); })) {
        text += "    view.rect_ts = vec4(0.0, 0.0, 1.0, 1.0);\n";
    }
    if (all([&](const GnLightView& view) { return view.layer == static_cast<int>(&view - &first); })) {
        text += "    view.layer = index;\n";
    }
    return text;
}

/// Biases that are zero.
std::string absent(const GnBias& bias) {
    std::string text;
    const auto name = [&](const char* member, float value) {
        text += value == 0 ? fmt::format("    bias.{} = 0.0;\n", member) : "";
    };
    name("constant", bias.constant);
    name("constant_world", bias.constant_world);
    name("slope", bias.slope);
    name("normal", bias.normal);
    name("normal_world", bias.normal_world);
    name("view", bias.view);
    name("view_world", bias.view_world);
    name("reach", bias.reach);
    name("reach_world", bias.reach_world);
    name("reach_pixels", bias.reach_pixels);
    return text + fmt::format("    bias.receiver_plane = {};\n", bias.receiver_plane);
}

}  // namespace

std::string known_text(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    return "GnLightView known_view(int index) {\n" + read_view(input.device, views) + shared_by_views(views) +
           "    return view;\n}\n" +  //
           "GnBias known_bias() {\n    GnBias bias = u.bias;\n" + absent(applied_bias(input, recipe)) +
           "    return bias;\n}\n" +
           fmt::format(
               "GnLight known_whole() {{\n    GnLight light = u.whole;\n    light.kind = {}u;\n"
               "    return light;\n}}\n",
               input.whole_light().shape.kind);
}

}  // namespace gn
