// SPDX-License-Identifier: MIT
// Two occluders at different heights: where z < 0 both cover the left half of the light, where z > 0 one covers the
// left and one the right half. Adding areas is wrong in both places.
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"

namespace gn::scenes {
namespace {

constexpr float light_height = 5.0F, low_height = 2.0F, high_height = 3.0F, far_away = 14.0F;

struct GnOverlapParams {
    GnOverheadLightParams light;
    int arrangement = 0;
};

Scene make_overlap(const ParamBlock& block) {
    const auto params = block.as<GnOverlapParams>();
    // The low occluder covers x < 0 everywhere; the high one covers the same half, or the other.
    std::vector<Sheet> sheets{{low_height, {-far_away, -far_away}, {0, far_away}}};
    const double same_from = params.arrangement == 2 ? far_away : -far_away;
    const double same_to = params.arrangement == 0 ? 0 : far_away;
    if (params.arrangement != 2) {
        sheets.push_back({high_height, {-far_away, same_from}, {0, same_to}});
    }
    if (params.arrangement != 1) {
        sheets.push_back({high_height, {0, params.arrangement == 0 ? 0 : -far_away}, {far_away, far_away}});
    }

    Scene scene;
    MeshBuilder builder(scene);
    const int floor = builder.material("chalk", {0.58F, 0.58F, 0.55F});
    const int board = builder.material("board", {0.45F, 0.25F, 0.2F});
    builder.begin("receiver (sheet)", floor);
    builder.sheet({-8, 0, 8}, {16, 0, 0}, {0, 0, -16});
    for (std::size_t i = 0; i < sheets.size(); ++i) {
        const Sheet& s = sheets[i];
        const dvec2 size = s.high - s.low;
        builder.begin(fmt::format("occluder {} (sheet)", i), board);
        builder.sheet(vec3(s.low.x, s.y, s.high.y), vec3(size.x, 0, 0), vec3(0, 0, -size.y));
    }
    builder.finish();

    scene.lights.push_back(overhead_light(params.light, light_height));
    scene.cameras.push_back(look_at("main", {0, 1.9F, 0.3F}, {0, 0, 0}, 70, 0.1F, 40));

    // Both occluders project onto the light; V is what their union leaves: at x = 0 one half where they coincide,
    // nothing where they complement each other, whatever their heights.
    scene.closed_form = [light = scene.lights[0].shape, sheets](std::size_t, dvec3 p_ws) {
        return sheet_visibility(light, sheets, p_ws);
    };
    return scene;
}

ParamTable params() {
    // The light's rows keep their offsets: it is the first member.
    std::vector<ParamRow> rows = overhead_light_rows();
    rows.push_back(GN_CHOICE(
        GnOverlapParams, arrangement,
        "Which halves the second occluder covers: the same for z < 0 and the other for z > 0, or one of both.", "both",
        "same", "opposite"));
    return param_table<GnOverlapParams>(std::move(rows));
}

}  // namespace

const Generator& overlap() {
    static const Generator row{
        "overlap",
        "Two occluders hide the same half of the light, or both halves: occluder fusion; breaks added areas.", params(),
        make_overlap};
    return row;
}

}  // namespace gn::scenes
