// SPDX-License-Identifier: MIT
#include "shadow/geometry/volumes.glsl"
#include "shadow/geometry/volume_passes.h"
#include "tests/direct_scenes.h"

#include <gtest/gtest.h>

#include <map>

namespace gn {
namespace parts {
const Part& direct_volumes();
}
namespace volumes_test {
namespace {

using namespace by_hand;

EdgeList edges_of(const Scene& scene) {
    const std::vector<std::uint8_t> casts(scene.triangles.size(), 1);
    return build_edges(scene.positions_ws, scene.triangles, casts);
}

// What the silhouette pass leaves at each edge, from the same formulas.
std::vector<int> edge_sums(const Scene& scene, const EdgeList& list, vec4 light_ws, int form) {
    std::vector<int> multiplicity;
    for (const uvec3 t : scene.triangles) {
        multiplicity.push_back(gn_volumes_multiplicity(
            gn_volumes_side(scene.positions_ws[t.x], scene.positions_ws[t.y], scene.positions_ws[t.z], light_ws),
            form));
    }
    std::vector<int> sums(list.edges.size(), 0);
    for (std::size_t e = 0; e < sums.size(); ++e) {
        for (std::uint32_t i = list.first[e]; i < list.first[e + 1]; ++i) {
            const int m = multiplicity[list.around[i] / 2];
            sums[e] += (list.around[i] & 1U) != 0U ? -m : m;
        }
    }
    return sums;
}

TEST(VolumeEdges, a_box_is_one_closed_component_though_its_faces_share_no_vertex) {
    for (const bool inverted : {false, true}) {
        const EdgeList list = edges_of(SceneBuilder().box(vec3(10), vec3(11, 12, 13), inverted).scene());
        EXPECT_EQ(list.edges.size(), 18U);
        ASSERT_EQ(list.components.size(), 1U);
        EXPECT_TRUE(list.components[0].closed);
        EXPECT_EQ(list.components[0].outward, inverted ? -1 : 1);
        EXPECT_EQ(list.components[0].triangles, 12U);
        for (std::size_t e = 0; e < list.edges.size(); ++e) {
            EXPECT_EQ(list.first[e + 1] - list.first[e], 2U);
        }
    }
}

TEST(VolumeEdges, open_and_fanned_sheets_are_not_closed) {
    // Three triangles on one edge, and a quad apart from them.
    const Scene scene =
        SceneBuilder()
            .mesh({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 1}, {-1, 0, -1}}, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}})
            .quad({5, 0, 0}, {6, 0, 0}, {6, 1, 0}, {5, 1, 0})
            .scene();
    const EdgeList list = edges_of(scene);
    ASSERT_EQ(list.components.size(), 2U);
    EXPECT_FALSE(list.components[0].closed);
    EXPECT_FALSE(list.components[1].closed);
    std::map<std::uint32_t, int> edges_with;
    for (std::size_t e = 0; e < list.edges.size(); ++e) {
        ++edges_with[list.first[e + 1] - list.first[e]];
    }
    EXPECT_EQ(edges_with, (std::map<std::uint32_t, int>{{1, 6 + 4}, {2, 1}, {3, 1}}));
}

TEST(VolumeEdges, lines_and_non_casters_are_left_out_and_minus_zero_is_zero) {
    const Scene scene =
        SceneBuilder()
            .mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0F, -0.0F, 0}}, {{0, 1, 2}, {0, 3, 1}, {3, 2, 1}})
            .scene();
    EXPECT_EQ(weld(scene.positions_ws), (std::vector<std::uint32_t>{0, 1, 2, 0}));
    const std::vector<std::uint8_t> casts{1, 1, 0};
    const EdgeList list = build_edges(scene.positions_ws, scene.triangles, casts);
    EXPECT_EQ(list.edges.size(), 3U);
    EXPECT_EQ(list.component_of, (std::vector<std::uint32_t>{0, EdgeList::no_component, EdgeList::no_component}));
}

TEST(VolumeLaws, the_sides_of_any_mesh_leave_no_loose_end) {
    // A border has no border: at every vertex as many sides arrive as depart, whatever the mesh and the form.
    const Scene scene = SceneBuilder()
                            .torus({0, 0, 0}, 2, 0.7F, 13)
                            .box({-3, -3, -3}, {-2, -1, -2})
                            .quad({0, 3, 0}, {1, 3, 0}, {1, 3, 1}, {0, 3.5F, 1})
                            .soup({{-3, -3, -3}, {3, 3, 3}}, 1.0F, 40, 7)
                            .scene();
    const EdgeList list = edges_of(scene);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> at(-5.0F, 5.0F);
    for (int round = 0; round < 100; ++round) {
        const vec4 light(at(random), at(random), at(random), static_cast<float>(round % 2));
        for (const int form : {GN_VOLUMES_ANY, GN_VOLUMES_FRONT, GN_VOLUMES_BACK}) {
            const std::vector<int> sums = edge_sums(scene, list, light, form);
            std::vector<int> balance(scene.positions_ws.size(), 0);
            for (std::size_t e = 0; e < sums.size(); ++e) {
                balance[list.edges[e].x] -= sums[e];
                balance[list.edges[e].y] += sums[e];
            }
            EXPECT_EQ(balance, std::vector<int>(balance.size(), 0)) << "round " << round << " form " << form;
        }
    }
}

TEST(VolumeLaws, a_solid_has_each_silhouette_edge_once_in_its_own_form_and_twice_in_the_general_one) {
    const Scene scene = SceneBuilder().torus({0, 0, 0}, 2, 0.7F, 16).scene();
    const EdgeList list = edges_of(scene);
    const vec4 light(4, 7, 1, 1);
    const std::vector<int> front = edge_sums(scene, list, light, GN_VOLUMES_FRONT);
    const std::vector<int> back = edge_sums(scene, list, light, GN_VOLUMES_BACK);
    const std::vector<int> any = edge_sums(scene, list, light, GN_VOLUMES_ANY);
    int silhouettes = 0;
    for (std::size_t e = 0; e < any.size(); ++e) {
        EXPECT_EQ(any[e], 2 * front[e]);
        EXPECT_EQ(back[e], front[e]);
        silhouettes += std::abs(front[e]);
    }
    EXPECT_GT(silhouettes, 16);
    EXPECT_LT(silhouettes, 200);
}

TEST(VolumeLaws, the_hexagon_of_a_cube) {
    const Scene scene = SceneBuilder().box(vec3(-1), vec3(1)).scene();
    const EdgeList list = edges_of(scene);
    int sides = 0;
    for (const int sum : edge_sums(scene, list, vec4(1, 2, 3, 0), GN_VOLUMES_FRONT)) {
        sides += std::abs(sum);
    }
    EXPECT_EQ(sides, 6);
    // Straight above, the light lies in the planes of the four walls: only the top's own border remains.
    int top = 0;
    for (const int sum : edge_sums(scene, list, vec4(0, 1, 0, 0), GN_VOLUMES_FRONT)) {
        top += std::abs(sum);
    }
    EXPECT_EQ(top, 4);
}

TEST(VolumeLaws, the_side_of_a_plane_is_exact_far_from_the_origin) {
    // One unit in the last place above and below a slanted plane, 2 km away; 32-bit arithmetic cannot tell.
    const vec3 a(2000, 0, 0), b(2001, 1, 0), c(2001, 1, 1);
    const vec3 light(2000.5F, 0.5F, 0.3F);
    EXPECT_EQ(gn_volumes_side(a, b, c, vec4(light, 1)), 0);
    vec3 above = light, below = light;
    above.y = std::nextafter(above.y, 1.0F);
    below.y = std::nextafter(below.y, 0.0F);
    EXPECT_EQ(gn_volumes_side(a, b, c, vec4(above, 1)), -gn_volumes_side(a, b, c, vec4(below, 1)));
    EXPECT_NE(gn_volumes_side(a, b, c, vec4(above, 1)), 0);
    EXPECT_EQ(gn_volumes_side(a, b, c, vec4(b, 1)), 0);
}

TEST(VolumeForms, follow_the_solid_and_the_light) {
    const Scene scene = SceneBuilder()
                            .box({0, 0, 0}, {1, 1, 1})
                            .box({2, 0, 0}, {3, 1, 1}, true)
                            .quad({5, 0, 0}, {6, 0, 0}, {6, 1, 0}, {5, 1, 0})
                            .scene();
    const EdgeList list = edges_of(scene);
    using Forms = std::vector<std::uint32_t>;
    const VolumeOptions params;
    EXPECT_EQ(component_forms(list.components, sun({0, -1, 0}), params, nullptr),
              (Forms{GN_VOLUMES_FRONT, GN_VOLUMES_BACK, GN_VOLUMES_ANY}));
    EXPECT_EQ(component_forms(list.components, point({0.5F, 0.5F, 0.5F}), params, nullptr),
              (Forms{GN_VOLUMES_ANY, GN_VOLUMES_BACK, GN_VOLUMES_ANY}));
    // A range of 3 m reaches the first two, a narrow cone along the third axis nothing.
    GnLight near = point({0, 0.5F, 0.5F});
    near.range = 3;
    EXPECT_EQ(component_forms(list.components, near, params, nullptr)[2], static_cast<uint>(GN_VOLUMES_NONE));
    EXPECT_EQ(component_forms(list.components, spot({0, 5, 0}, {0, 5, 9}, 0.3F), params, nullptr),
              (Forms{GN_VOLUMES_NONE, GN_VOLUMES_NONE, GN_VOLUMES_NONE}));
    EXPECT_EQ(component_forms(list.components, spot({0, 5, 0}, {0, 5, 9}, 0.3F), {.culling = false}, nullptr),
              (Forms{GN_VOLUMES_FRONT, GN_VOLUMES_BACK, GN_VOLUMES_ANY}));
}

// ---- Rendered, against the traced hard shadow. ----

struct Case {
    const char* name;
    Scene (*make)();
    bool darkness = true;  ///< some judged samples are in shadow
    bool light = true;     ///< some are lit
};

SceneBuilder yard() {
    SceneBuilder b;
    b.ground(10).box({-1, 0, -1}, {1, 1.5F, 1}).camera({4, 3.3F, 5.2F}, {0.2F, 0.4F, 0});
    return b;
}
SceneBuilder lit_from_all_kinds(SceneBuilder b) {
    b.light(sun({-0.4F, -1, 0.33F})).light(point({2.3F, 3.1F, 0.7F})).light(spot({-3, 4, 1.2F}, {0, 0.3F, 0}, 0.6F));
    b.light(rectangle({0.3F, 5, -3.2F}, {0, 0, 0}));
    return b;
}

const Case cases[] = {
    {"box_on_ground", [] { return lit_from_all_kinds(yard()).scene(); }},
    {"inverted_box",
     [] {
         SceneBuilder b;
         b.ground(10).box({-1, 0.3F, -1}, {1, 1.5F, 1}, true).camera({4, 3.3F, 5.2F}, {0.2F, 0.4F, 0});
         return lit_from_all_kinds(b).scene();
     }},
    {"open_quad",
     [] {
         SceneBuilder b;
         b.ground(10).quad({-1, 1, -1}, {1, 1.3F, -1}, {1, 1.3F, 1}, {-1, 1, 1}).camera({4, 3.3F, 5.2F}, {0, 0.4F, 0});
         return lit_from_all_kinds(b).scene();
     }},
    {"quad_wound_downwards",
     [] {
         SceneBuilder b;
         b.ground(10).quad({-1, 1, 1}, {1, 1.3F, 1}, {1, 1.3F, -1}, {-1, 1, -1}).camera({4, 3.3F, 5.2F}, {0, 0.4F, 0});
         return lit_from_all_kinds(b).scene();
     }},
    {"fan_with_three_sheets",
     [] {
         SceneBuilder b;
         b.ground(10).mesh({{0, 0.2F, 0}, {0, 2, 0}, {1.5F, 1, 0.2F}, {-1, 1, 1}, {-1, 0.7F, -1}},
                           {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}});
         b.camera({4, 3.3F, 5.2F}, {0.2F, 0.4F, 0});
         return lit_from_all_kinds(b).scene();
     }},
    {"ring",
     [] {
         return lit_from_all_kinds(SceneBuilder(yard()).torus({0.3F, 2.6F, 0.2F}, 1.1F, 0.4F, 20)).scene();
     }},
    {"two_boxes_sharing_an_edge",
     [] {
         return lit_from_all_kinds(SceneBuilder(yard()).box({1, 1.5F, -1}, {2, 2.5F, 1})).scene();
     }},
    {"leaf_with_two_faces",
     [] {
         SceneBuilder b;
         b.ground(10).mesh({{-1, 1, -1}, {1, 1.3F, -1}, {1, 1.3F, 1}, {-1, 1, 1}},
                           {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}});
         b.camera({4, 3.3F, 5.2F}, {0, 0.4F, 0});
         return lit_from_all_kinds(b).scene();
     }},
    {"triangle_soup",
     [] {
         SceneBuilder b;
         b.ground(10).soup({{-3, 0.2F, -3}, {3, 3, 3}}, 1.3F, 80, 3).camera({4, 3.3F, 5.2F}, {0, 0.6F, 0});
         return lit_from_all_kinds(b).scene();
     }},
    {"triangle_soup_around_the_camera",
     [] {
         SceneBuilder b;
         b.ground(10).soup({{-3, 0.2F, -3}, {3, 3, 3}}, 1.3F, 80, 5).camera({0.1F, 1.2F, 0.2F}, {1.4F, 0.2F, -1.6F});
         return lit_from_all_kinds(b).scene();
     }},
    {"camera_in_the_shadow",
     [] {
         SceneBuilder b;
         b.ground(10).box({-1, 1.5F, -1}, {1, 1.7F, 1}).camera({0.1F, 0.6F, 0.2F}, {2.5F, 0, -1.8F});
         return b.light(sun({0.05F, -1, 0.1F})).light(point({0.2F, 4, 0})).scene();
     }},
    {"camera_in_the_shadow_of_many",
     [] {
         SceneBuilder b;
         b.ground(10).camera({0.1F, 0.6F, 0.2F}, {2.5F, 0, -1.8F});
         for (int i = 0; i < 8; ++i) {
             const float y = 1.5F + 0.2F * static_cast<float>(i);
             b.box({-1, y, -1}, {1, y + 0.1F, 1}).quad({-1, y + 3, -1}, {1, y + 3, -1}, {1, y + 3, 1}, {-1, y + 3, 1});
         }
         return b.light(sun({0.05F, -1, 0.1F})).light(point({0.2F, 9, 0})).scene();
     }},
    {"light_inside_a_closed_box_seen_from_outside",
     [] {
         SceneBuilder b;
         b.ground(10).box({-1, 0.2F, -1}, {1, 2, 1}).camera({4, 3.3F, 5.2F}, {0.2F, 0.4F, 0});
         return b.light(point({0.2F, 1, 0.1F})).scene();
     },
     true, false},
    {"light_and_camera_inside_a_room",
     [] {
         SceneBuilder b;
         b.box({-4, 0, -4}, {4, 3, 4}).box({-1, 0, -1}, {0, 1, 0.5F}).camera({3, 2, 3.3F}, {-1, 0.2F, -1});
         return b.light(point({1.2F, 2.4F, -1.7F})).scene();
     }},
    {"camera_in_a_room_the_sun_outside",
     [] {
         SceneBuilder b;
         b.box({-4, 0, -4}, {4, 3, 4}).camera({3, 2, 3.3F}, {-1, 0.2F, -1});
         return b.light(sun({-0.3F, -1, 0.2F})).light(point({9, 8, 7})).scene();
     },
     true, false},
    {"open_room_with_a_window",
     [] {
         SceneBuilder b;
         b.quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}).quad({-4, 3, 4}, {4, 3, 4}, {4, 3, -4}, {-4, 3, -4});
         b.quad({-4, 0, -4}, {4, 0, -4}, {4, 3, -4}, {-4, 3, -4})
             .quad({-4, 0, 4}, {-4, 3, 4}, {-4, 3, -4}, {-4, 0, -4});
         b.camera({3, 1.7F, 3.3F}, {-2, 0.2F, -1});
         return b.light(sun({-1, -0.8F, -0.3F})).scene();
     }},
    {"near_plane_cuts_the_caster",
     [] {
         SceneBuilder b;
         b.ground(10)
             .box({-1, 0.5F, -1}, {1, 1.5F, 1})
             .quad({-2, 1, 1.8F}, {2, 1, 1.8F}, {2, 1.1F, 3.2F}, {-2, 1.1F, 3.2F});
         b.camera({0.3F, 1.12F, 2.6F}, {0.1F, 0.3F, -1}, 0.4F);
         return lit_from_all_kinds(b).scene();
     }},
    {"caster_beyond_the_far_plane",
     [] {
         SceneBuilder b;
         b.ground(30).box({-2, 0, -12}, {2, 3, -11}).camera({0.3F, 1.5F, 3}, {0.1F, 0.3F, -3}, 0.1F, 9);
         return b.light(sun({0.1F, -0.3F, 1})).light(point({0.3F, 8, -22})).scene();
     }},
    {"light_in_the_planes_of_faces",
     [] {
         return SceneBuilder(yard())
             .light(sun({0, -1, 0}))
             .light(point({1, 4, 0.25F}))
             .light(point({3, 1.5F, 1}))
             .scene();
     }},
    {"light_at_a_vertex",
     [] {
         SceneBuilder b;
         b.ground(10).mesh({{0, 3, 0}, {-1, 1, -1}, {1, 1, -0.5F}, {0, 1, 1}}, {{0, 1, 2}, {0, 2, 3}});
         b.box({1, 0, 1}, {2, 1, 2}).camera({4, 3.3F, 5.2F}, {0.2F, 0.4F, 0});
         return b.light(point({0, 3, 0})).scene();
     }},
    {"camera_at_the_light",
     [] {
         return SceneBuilder(yard()).light(point({4, 3.3F, 5.2F})).light(point({4.01F, 3.3F, 5.2F})).scene();
     },
     false, true},
    {"light_faces_the_camera",
     [] {
         SceneBuilder b;
         b.ground(20).box({-1, 0, -1}, {1, 1.5F, 1}).torus({0, 2.5F, 0}, 1, 0.3F, 16).camera({0, 1, 5}, {0, 0.9F, 0});
         return b.light(sun({0.02F, -0.25F, 1})).light(point({0, 4, -9})).scene();
     }},
    {"far_from_the_origin",
     [] {
         SceneBuilder b;
         const vec3 o(1500, 0, -900);
         b.quad(o + vec3(-9, 0, 9), o + vec3(9, 0, 9), o + vec3(9, 0, -9), o + vec3(-9, 0, -9));
         b.box(o + vec3(-1, 0, -1), o + vec3(1, 1.5F, 1)).camera(o + vec3(4, 3.3F, 5.2F), o + vec3(0, 0.4F, 0));
         return b.light(sun({-0.4F, -1, 0.33F})).light(point(o + vec3(2.3F, 3.1F, 0.7F))).scene();
     }},
};

class VolumesRendered : public testing::TestWithParam<Case> {};

TEST_P(VolumesRendered, equals_the_traced_hard_shadow_away_from_edges) {
    const Scene scene = GetParam().make();
    const char* switches[][4] = {
        {"auto", "1", "1", "silhouette"}, {"z-fail", "0", "0", "brute-force"}, {"zp+", "1", "0", "silhouette"}};
    for (const auto& [mode, closed, culling, extrude] : switches) {
        const Recipe recipe = direct_recipe(
            parts::direct_volumes(), {{"mode", mode}, {"closed", closed}, {"culling", culling}, {"extrude", extrude}});
        std::size_t lit = 0, shadowed = 0;
        const std::vector<Comparison> results = render_and_judge(scene, recipe);
        for (std::size_t i = 0; i < results.size(); ++i) {
            EXPECT_EQ(results[i].wrong, 0U) << scene.lights[i].name << " mode=" << mode << " closed=" << closed << ", "
                                            << results[i].judged << " judged: " << results[i].first;
            EXPECT_GT(results[i].judged, 500U);
            lit += results[i].lit;
            shadowed += results[i].shadowed;
        }
        EXPECT_TRUE(!GetParam().darkness || shadowed > 50) << shadowed << " samples in shadow";
        EXPECT_TRUE(!GetParam().light || lit > 50) << lit << " samples lit";
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, VolumesRendered, testing::ValuesIn(cases),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(VolumesMasked, a_masked_quad_casts_as_a_whole_or_not_at_all) {
    const test::ValidationGuard guard;
    // A quad whose texture is a hole above the ground; the truth sees through it entirely where alpha is zero.
    SceneBuilder b;
    Texture holes{.name = "holes",
                  .image = {2, 2, {255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 0, 255, 255, 255, 255}}};
    Material leaf{.name = "leaf", .alpha_mode = AlphaMode::mask, .alpha_cutoff = 0.5F};
    const int material = b.material(leaf, &holes);
    b.ground(10).quad({-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}, material).camera({0, 4, 0.1F}, {0, 0, 0});
    b.light(sun({1, -1, 0}));
    const Scene scene = b.scene();
    SceneGpu uploaded = upload_scene(device(), scene);
    std::map<std::string, std::size_t> dark;
    for (const char* masked : {"opaque", "skip"}) {
        const FrameResult frame = render_frame(device(), uploaded, scene.cameras.front(),
                                               direct_recipe(parts::direct_volumes(), {{"masked", masked}}),
                                               {.width = 128, .height = 128, .picture = false});
        for (std::size_t i = 0; i < frame.samples.position_ws.size(); ++i) {
            const vec4 p = frame.samples.position_ws[i];
            const bool on_ground = p.w > 0.0F && std::abs(p.y) < 1e-3F;
            const vec3 up = vec3(p) + vec3(-1, 1, 0);  // where the ray to the sun meets the quad's plane
            const float distance = std::max(std::abs(up.x), std::abs(up.z)) - 1.0F;
            if (on_ground && std::abs(distance) > 0.05F) {
                EXPECT_EQ(frame.visibility[0].values[i],
                          distance < 0.0F && std::string(masked) == "opaque" ? 0.0F : 1.0F)
                    << masked << " at " << p.x << ", " << p.z;
            }
            dark[masked] += p.w > 0.0F && frame.visibility[0].values[i] == 0.0F ? 1 : 0;
        }
    }
    EXPECT_GT(dark["opaque"], 500U);
    EXPECT_EQ(dark["skip"], 0U);
}

TEST(VolumesMasked, each_sample_is_decided_by_the_texel_that_its_ray_meets) {
    // Loose cards with holes of all kinds of wrapping, some with one side only, over a ground that shows what they let through.
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    SceneBuilder b;
    b.ground(10).box({-1, 0, -1}, {1, 0.7F, 1});
    std::array<int, 4> materials{};
    for (int i = 0; i < 4; ++i) {
        Texture holes{.name = "holes", .image = {8, 4, {}}, .repeat_u = i % 2 == 0, .repeat_v = i < 2};
        for (int texel = 0; texel < 32; ++texel) {
            const auto alpha = static_cast<std::uint8_t>(127.5F + 127.5F * unit(random));
            holes.image.rgba.insert(holes.image.rgba.end(), {255, 255, 255, alpha});
        }
        Material leaf{
            .name = "leaf", .alpha_mode = i == 3 ? AlphaMode::blend : AlphaMode::mask, .double_sided = i != 1};
        leaf.alpha_cutoff = 0.4F;
        materials[static_cast<std::size_t>(i)] = b.material(leaf, &holes);
    }
    for (int i = 0; i < 60; ++i) {
        const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
        const vec3 o = vec3(0, 1.8F, 0) + vec3(2.5F, 1, 2.5F) * any(), x = 0.8F * any(), y = 0.8F * any();
        b.mesh({o, o + x, o + x + y, o + y}, {{0, 1, 2}, {0, 2, 3}}, materials[static_cast<std::size_t>(i % 4)],
               {{-0.7F, -0.3F}, {1.6F, 0}, {1.9F, 1.4F}, {0, 1}});
    }
    b.camera({4, 3.3F, 5.2F}, {0.2F, 0.6F, 0});
    b.light(sun({-0.4F, -1, 0.33F})).light(point({2.3F, 4.1F, 0.7F})).light(spot({-3, 4, 1.2F}, {0, 0.3F, 0}, 0.6F));
    for (const Comparison& result : render_and_judge(b.scene(), direct_recipe(parts::direct_volumes()), 160, 120)) {
        EXPECT_EQ(result.wrong, 0U) << result.judged << " judged: " << result.first;
        EXPECT_GT(result.lit, 300U);
        EXPECT_GT(result.shadowed, 200U);
    }
}

TEST(VolumesNested, hundreds_of_volumes_over_a_sample_are_shadow) {
    // Sheets above each other: every one hides the light from the ground once more. 256 and 512 are 0 in eight bits.
    for (const int sheets : {255, 256, 257, 512, 1100}) {
        SceneBuilder b;
        b.ground(10);
        for (int i = 0; i < sheets; ++i) {
            const float y = 1.0F + 0.001F * static_cast<float>(i);
            b.quad({-1, y, 1}, {1, y, 1}, {1, y, -1}, {-1, y, -1});
        }
        b.light(sun({1, -1, 0})).camera({0, 4, 5}, {0, 0, 0});
        const std::vector<Comparison> results =
            render_and_judge(b.scene(), direct_recipe(parts::direct_volumes(), {{"covered", "0"}}), 96, 96);
        EXPECT_EQ(results[0].wrong, 0U) << sheets << " sheets: " << results[0].first;
        EXPECT_GT(results[0].shadowed, 100U);
    }
}

TEST(VolumesAnalytic, built_in_scenes_with_points_for_lights_have_no_mismatch) {
    for (const char* name :
         {"half-plane", "slab", "stack", "overlap", "tilted", "contact", "fence", "corridor", "duel"}) {
        Scene scene = make_builtin_scene(name);
        for (Light& light : scene.lights) {
            light.shape.radius = light.shape.angular_radius = 0.0F;
            light.shape.half_size = vec2(0);
        }
        const std::vector<Comparison> results =
            render_and_judge(scene, direct_recipe(parts::direct_volumes()), 256, 192);
        for (std::size_t i = 0; i < results.size(); ++i) {
            EXPECT_EQ(results[i].wrong, 0U)
                << name << ", light " << i << ", " << results[i].judged << " judged: " << results[i].first;
        }
    }
}

}  // namespace
}  // namespace volumes_test
}  // namespace gn
