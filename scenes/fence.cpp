// SPDX-License-Identifier: MIT
// Rows of thin bars, seen from near and far: shadows that fall below a pixel, and maps whose texels miss the bars.
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"

namespace gn::scenes {
namespace {

struct GnFenceParams {
    float distance = 35;
    float bar = 0.02F;
    float radius = 0;
};

constexpr double fence_half_width = 22, fence_height = 1.4, bar_spacing = 0.14, post_spacing = 2.8;

// One fence along x at depth z: posts on the ground, two rails, bars that stop short of the ground.
std::vector<SolidBox> fence_row(double z, double bar) {
    std::vector<SolidBox> row;
    const auto upright = [&](double x, double half, double low, double high) {
        row.push_back({{x - half, low, z - half}, {x + half, high, z + half}});
    };
    for (const double y : {0.2, fence_height - 0.2}) {
        row.push_back({{-fence_half_width, y - 0.02, z - 0.75 * bar}, {fence_half_width, y + 0.02, z + 0.75 * bar}});
    }
    const int posts = static_cast<int>(2 * fence_half_width / post_spacing);
    for (int i = 0; i <= posts; ++i) {
        upright(-0.5 * posts * post_spacing + i * post_spacing, 0.04, 0, fence_height + 0.1);
    }
    const int bars = static_cast<int>(2 * fence_half_width / bar_spacing);
    for (int i = 0; i < bars; ++i) {
        upright((i + 0.5 - 0.5 * bars) * bar_spacing, 0.5 * bar, 0.08, fence_height);
    }
    return row;
}

Scene make_fence(const ParamBlock& block) {
    const auto params = block.as<GnFenceParams>();
    Scene scene;
    MeshBuilder builder(scene);
    builder.begin("ground (sheet)", builder.material("gravel", {0.52F, 0.50F, 0.44F}));
    builder.sheet({-150, 0, 150}, {300, 0, 0}, {0, 0, -300});
    const int iron = builder.material("iron", {0.10F, 0.13F, 0.12F}, 0.5F);
    std::vector<SolidBox> solids;
    for (int k = 0; k < 3; ++k) {
        const std::vector<SolidBox> row = fence_row(-6.0 * k, params.bar);
        builder.begin(fmt::format("fence {}", k), iron);
        add_boxes(builder, row);
        solids.insert(solids.end(), row.begin(), row.end());
    }
    builder.finish();

    scene.lights.push_back(directional_light("sun", {0.35F, 0.62F, -0.75F}, 20000, params.radius, {1, 0.93F, 0.82F}));
    const float d = params.distance;
    scene.cameras.push_back(look_at("main", {-0.1F * d, 0.32F * d, d}, {0, 0, -5.0F}, 17, 0.1F, 500));
    scene.cameras.push_back(look_at("near", {-1.5F, 1.7F, 3.2F}, {0.4F, 0.2F, 0.2F}, 50, 0.05F, 500));

    // A point is dark exactly when its ray towards the sun meets a bar, a rail or a post.
    scene.closed_form = [shape = scene.lights[0].shape, solids](std::size_t, dvec3 p_ws) {
        return box_visibility(shape, solids, p_ws);
    };
    return scene;
}

}  // namespace

const Generator& fence() {
    static const Generator row{
        "fence", "Thin iron bars seen from far away: breaks filters and maps by minification.",
        param_table<GnFenceParams>({
            GN_PARAM(GnFenceParams, distance, real, 5, 200, "m",
                     "Distance of the main camera: thinner shadows on screen."),
            GN_PARAM(GnFenceParams, bar, real, 0.002, 0.1, "m", "Thickness of a bar."),
            GN_PARAM(GnFenceParams, radius, real, 0, 5, "degrees", "Angular radius of the sun: 0 is a hard shadow."),
        }),
        make_fence};
    return row;
}

}  // namespace gn::scenes
