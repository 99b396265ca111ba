// SPDX-License-Identifier: MIT
#include "shadow/lookup/silhouette/silhouette.glsl"

#include "gpu/shader_inputs.h"
#include "shadow/view/read_back.h"
#include "tests/rig.h"

#include <random>

namespace gn::silhouette_test {
namespace {

using namespace gn::glsl;

/// A line through cell (0, 0) and its surroundings.
struct Line {
    vec2 a, b;
    [[nodiscard]] float side(vec2 p) const { return gn_silhouette_cross(normalize(b - a), p - a); }
};

Line random_line(std::mt19937& random) {
    std::uniform_real_distribution<float> uniform(0, 1);
    const vec2 through(uniform(random), uniform(random));
    const float angle = 6.2831853F * uniform(random);
    return {through - 10.0F * vec2(std::cos(angle), std::sin(angle)),
            through + 9.0F * vec2(std::cos(angle), std::sin(angle))};
}

/// What the map stores in the cell at `at`: the line's point or the middle; in the space of cell (0, 0).
vec2 stored(const Line& line, vec2 at) {
    const float t = gn_silhouette_point(line.a - at, line.b - at);
    const vec2 p_cell = t < 0 ? vec2(0.5F) : mix(line.a - at, line.b - at, t);
    return gn_silhouette_unpack(gn_silhouette_pack(p_cell)) + at;
}

TEST(Silhouette, StraightEdgesAreExact) {
    // The chosen corner lies on the receiver's side of the line: its depth is the right one.
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    int asked = 0;
    for (int i = 0; i < 20000; ++i) {
        const Line line = random_line(random);
        const vec2 p(uniform(random), uniform(random));
        const ivec2 corner =
            gn_silhouette_corner(p, stored(line, vec2(0)), stored(line, vec2(1, 0)), stored(line, vec2(0, 1)),
                                 stored(line, vec2(-1, 0)), stored(line, vec2(0, -1)));
        // Rounding to 12 bits moves the edge where points lie close together, and hides lines that pass a corner.
        const float corner_distance = line.side(vec2(corner));
        if (std::abs(line.side(p)) > 0.01F && std::abs(corner_distance) > 0.01F) {
            ++asked;
            ASSERT_GT(line.side(p) * corner_distance, 0)
                << i << ": p " << p.x << ", " << p.y << ", corner " << corner.x << ", " << corner.y;
        }
    }
    EXPECT_GT(asked, 15000);
}

TEST(SilhouetteLookup, TapsStayInTheirViewsRectangle) {
    // Two views share a layer of 8 x 4 cells: to the left nothing casts, to the right everything does. The receiver lies in
    // the last column of the left view, beyond its cell's point: the corner there belongs to the other view.
    std::vector<vec2> cells;
    for (int i = 0; i < 32; ++i) {
        cells.emplace_back(i % 8 < 4 ? 1.0F : 0.0F, gn_silhouette_pack(vec2(0.1F, 0.5F)));
    }
    Texture2D map = upload_texture(test::device(),
                                   {.name = "cells",
                                    .format = VK_FORMAT_R32G32_SFLOAT,
                                    .width = 8,
                                    .height = 4,
                                    .layers = 1,
                                    .usage = VK_IMAGE_USAGE_SAMPLED_BIT},
                                   std::as_bytes(std::span(cells)));
    const std::string text = R"(
#include "shadow/lookup/silhouette/silhouette.glsl"
layout(local_size_x = 1) in;
void main() {
    GnReceiver receiver;
    GnProjected p;
    p.uv_ts = vec2(3.9 / 8.0, 2.2 / 8.0);
    p.texel_ts = 1.0 / 8.0;
    p.layer = 0;
    p.depth = 0.5;
    p.bounds_ts = vec4(0.0, 0.0, 0.5, 0.5);
    p.plane_slope = p.plane_fall = p.plane_curve = vec2(0.0);
    p.rows = 0.0;
    p.cone = p.cone_share = 0.0;
    GnBias bias;
    bias.receiver_plane = 0;
    GnLight light;
    GnLightView view;
    imageStore(result, ivec2(0), vec4(gn_silhouette_visibility(GnLookup(receiver, p, bias, light, view), map)));
}
)";
    FrameGraph graph(test::device());
    const TextureHandle source = graph.import(map);
    const TextureHandle result =
        graph.create({.name = "result", .format = VK_FORMAT_R32_SFLOAT, .width = 1, .height = 1});
    ShaderInputs inputs;
    inputs.texture("sampler2DArray", "map", source).image("r32f", "writeonly", "image2D", "result", result);
    graph.add_pass(
        "look up", [&](PassBuilder& pass) { inputs.declare(pass); },
        [=](Recorder& r) {
            r.bind(ComputeDesc{{ShaderKind::compute, "silhouette-lookup", inputs.text() + text}, {}});
            inputs.set(r);
            r.dispatch(1, 1);
        });
    graph.keep(result);
    graph.execute(false);
    EXPECT_EQ(read_image(graph, result).values.at(0), 1.0F);
}

TEST(SilhouetteRendered, StraightEdgesMatchTheTraceWhereHardIsAStaircase) {
    for (const char* scene : {"half-plane:hard=1", "slab:hard=1", "half-plane:light=directional,hard=1"}) {
        const test::ComparisonOptions size{.width = 384, .height = 384, .samples = 1};
        const auto hard = test::compare(scene, "hard,resolution=128", size);
        const auto silhouette = test::compare(scene, "silhouette,resolution=128", size);
        EXPECT_LT(*silhouette.errors.mismatch, 0.2 * *hard.errors.mismatch) << scene;
    }
}

TEST(SilhouetteRendered, NoWorseThanHardOnFineGeometryAndUnderEveryLight) {
    for (const char* scene : {"fence", "contact:light=point", "contact", "overlap:hard=1"}) {
        const test::ComparisonOptions size{.width = 192, .height = 192, .samples = 1};
        const auto hard = test::compare(scene, "hard,resolution=256", size);
        const auto silhouette = test::compare(scene, "silhouette,resolution=256", size);
        const double noise = 2 * std::sqrt(*hard.errors.mismatch / static_cast<double>(hard.errors.samples));
        EXPECT_LE(*silhouette.errors.mismatch, *hard.errors.mismatch + noise) << scene;
        EXPECT_LE(*silhouette.errors.acne, *hard.errors.acne + noise) << scene;
    }
}

}  // namespace
}  // namespace gn::silhouette_test
