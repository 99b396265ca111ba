// SPDX-License-Identifier: MIT
#include "tests/random_meshes.h"

#include "tests/near_edges.h"
#include "tests/thorough.h"

#include <array>
#include <cmath>
#include <random>

namespace gn::by_hand {

const char* mesh_kind_name(unsigned kind) {
    constexpr std::array<const char*, mesh_kinds> names{"boxes", "rings", "loose", "fans", "double"};
    return names.at(kind);
}

Scene random_meshes(unsigned kind, unsigned seed) {
    std::mt19937 random(mesh_kinds * seed + kind);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
    const auto place = [&] { return vec3(0, 1.5F, 0) + vec3(3, 1.2F, 3) * any(); };
    SceneBuilder b;
    b.ground(10);
    for (int i = 0; i < 12 && kind == 0; ++i) {
        const vec3 centre = place(), half = vec3(0.1F) + 0.5F * glm::abs(any());
        b.box(centre - half, centre + half, i % 2 == 0);
    }
    for (int i = 0; i < 4 && kind == 1; ++i) {
        b.torus(vec3(0, 1.5F, 0) + 2.0F * any() * vec3(1, 0.5F, 1), 0.6F + 0.4F * unit(random), 0.2F, 10 + seed % 11);
    }
    if (kind == 2) {
        b.soup({{-3, 0.2F, -3}, {3, 3, 3}}, 1.3F, 80, seed);
    }
    for (int i = 0; i < 10 && kind == 3; ++i) {
        const vec3 o = place();
        b.mesh({o, o + any(), o + any(), o + any(), o + any(), o + any()},
               {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {0, 5, 1}});
    }
    for (int i = 0; i < 10 && kind == 4; ++i) {
        const vec3 o = place();
        b.mesh({o, o + any(), o + any()}, i % 2 == 0 ? std::vector<uvec3>{{0, 1, 2}, {0, 2, 1}}
                                                     : std::vector<uvec3>{{0, 1, 2}, {0, 1, 2}, {1, 2, 0}});
    }
    const vec3 eye = vec3(0, 1.7F, 0) + vec3(5, 1.6F, 5) * any(), at = vec3(0, 0.8F, 0) + vec3(1.5F, 0, 1.5F) * any();
    b.camera(eye, at, seed % 5 == 0 ? 0.5F : 0.1F);
    b.light(sun(vec3(0, -1.1F, 0) + any())).light(point(vec3(0, 2.5F, 0) + vec3(3, 2, 3) * any()));
    b.light(point(eye + 0.3F * any())).light(sun(at - eye + 0.02F * any()));
    return b.scene();
}

namespace {

// Where wrong samples lie.
struct Places {
    std::size_t by_shadow = 0;  ///< within a sixteenth of a pixel of an edge of the shadow, which falls between samples
    std::size_t on_triangle = 0;  ///< else within a step of the rasterizer of an edge of a triangle
    std::size_t elsewhere = 0;
};

void find_places(const Scene& scene, const FrameResult& frame, std::size_t light, const std::string& which,
                 Places& places) {
    const Truth truth(scene);
    const CpuSamples& samples = frame.samples;
    const GnLight& shape = scene.lights[light].shape;
    const TruthResult traced = truth.trace(samples.position_ws, samples.normal_ws, shape, {.samples = 1});
    const auto edges = edge_pixels(traced.visibility, traced.counted, static_cast<int>(samples.width),
                                   static_cast<int>(samples.height));
    const float step = std::ldexp(1.0F, -static_cast<int>(device().properties().limits.subPixelPrecisionBits));
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const float v = frame.visibility[light].values[i];
        const vec3 p_ws(samples.position_ws[i]), n_ws(samples.normal_ws[i]);
        const float slant = glm::dot(n_ws, gn_to_light(shape, p_ws));
        if (traced.counted[i] == 0 || edges[i] != 0 || v == traced.visibility[i] || std::abs(slant) < 1e-5F) {
            continue;
        }
        const float to_shadow = test::pixels_to_shadow(truth, scene, samples, i, shape, traced.visibility[i]);
        const float to_triangle = test::pixels_to_triangle(scene, samples, i);
        ++(to_shadow <= 1.0F / 16 ? places.by_shadow : to_triangle <= step ? places.on_triangle : places.elsewhere);
        if (test::thorough()) {
            fmt::print(
                "{}, light {}, pixel {}, {}: V = {}, traced {}; light at a slant of {:.4f}, {:.4f} steps from a "
                "shadow, {:.4f} from a triangle\n",
                which, light, i % samples.width, i / samples.width, v, traced.visibility[i], slant, to_shadow / step,
                to_triangle / step);
        }
    }
}

}  // namespace

void expect_random_meshes_as_traced(unsigned kind, const std::function<Recipe(unsigned seed)>& recipe_of,
                                    const std::function<std::string(unsigned seed)>& described) {
    const test::ValidationGuard guard;
    const unsigned seeds = test::thorough() ? 300 : 10;
    std::size_t lit = 0, shadowed = 0, wrong = 0, judged = 0;
    Places places;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        const Scene scene = random_meshes(kind, seed);
        SceneGpu uploaded = upload_scene(device(), scene);
        const FrameResult frame = render_frame(device(), uploaded, scene.cameras.front(), recipe_of(seed),
                                               {.width = 120, .height = 90, .picture = false});
        for (std::size_t light = 0; light < scene.lights.size(); ++light) {
            const Comparison result = judge(scene, frame, light);
            if (result.wrong > 0) {
                find_places(scene, frame, light, fmt::format("seed {}, {}", seed, described(seed)), places);
            }
            EXPECT_TRUE(result.wrong == 0 || test::thorough())
                << "seed " << seed << ", " << described(seed) << ", " << result.judged << " judged: " << result.first;
            wrong += result.wrong;
            judged += result.judged;
            lit += result.lit;
            shadowed += result.shadowed;
        }
    }
    // Of millions of samples some lie beside a shadow narrower than a pixel, which their neighbours do not tell, or on the border of a
    // triangle: the parts' pages count them.
    EXPECT_LE(static_cast<double>(wrong), 1e-5 * static_cast<double>(judged)) << wrong << " of " << judged;
    EXPECT_EQ(places.elsewhere, 0U) << "neither a shadow's edge nor a triangle's explains them";
    if (test::thorough()) {
        fmt::print("{}: {} of {} wrong: {} beside a shadow, {} on a triangle's border, {} elsewhere\n",
                   mesh_kind_name(kind), wrong, judged, places.by_shadow, places.on_triangle, places.elsewhere);
    }
    // There is something to see. Ten double sheets shade least: 483 samples a picture, as the mean of 300.
    EXPECT_GT(lit, 500U * seeds);
    EXPECT_GT(shadowed, (kind == mesh_kinds - 1 ? 450U : 500U) * seeds);
}

Scene hinge(float angle, bool closed_by_a_wall) {
    SceneBuilder b;
    b.ground(10, -1);
    const vec3 low(0, 0.5F, -1.5F), high(0, 0.5F, 1.5F), out(2.5F, 0.5F, 0.1F),
        raised(2.5F, 0.5F + 2.5F * angle, -0.1F);
    std::vector<uvec3> triangles{{0, 1, 2}, {1, 0, 3}};
    if (closed_by_a_wall) {
        triangles.push_back({0, 1, 4});
    }
    b.mesh({low, high, out, raised, vec3(-1, -0.5F, 0)}, triangles);
    b.camera({-2.5F, 3.2F, 0.6F}, {0.4F, 0.5F, 0});
    return b.light(sun({0.2F, -1, 0.1F})).light(point({-1, 4, 1})).light(point({3, 2.5F, -1})).scene();
}

}  // namespace gn::by_hand
