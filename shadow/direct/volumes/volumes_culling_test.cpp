// SPDX-License-Identifier: MIT
// What is left out of volumes: components in another's shadow, slices without samples, triangles of simpler bodies. The first two
// change no sample.
#include "shadow/geometry/caster_proxies.h"
#include "shadow/geometry/covered_components.h"
#include "shadow/geometry/volume_passes.h"
#include "shadow/geometry/volumes.glsl"
#include "shadow/show/show.h"
#include "tests/direct_scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace gn {
namespace parts {
const Part& direct_volumes();
}
namespace volumes_culling_test {
namespace {

using namespace by_hand;
using Values = std::vector<std::pair<std::string, std::string>>;

// ---- Components in another's shadow. ----

/// Per object of a scene without grounds whether another covers it; every object is one component here.
std::vector<std::uint8_t> covered(const Scene& scene, vec4 light_ws) {
    const std::vector<std::uint8_t> casts(scene.triangles.size(), casts_from_both_sides);
    const EdgeList list = build_edges(scene.positions_ws, scene.triangles, casts);
    EXPECT_EQ(list.components.size(), scene.objects.size());
    std::vector<std::uint32_t> forms;
    for (const Component& component : list.components) {
        forms.push_back(!component.closed       ? GN_VOLUMES_ANY
                        : component.outward > 0 ? GN_VOLUMES_FRONT
                                                : GN_VOLUMES_BACK);
    }
    return covered_components({scene.positions_ws, scene.triangles, casts, list, forms}, light_ws, 1e-3);
}

using Found = std::vector<std::uint8_t>;

TEST(VolumeCovered, is_what_stands_wholly_in_anothers_shadow) {
    // A wall; boxes behind it, jutting out of its shadow, before it, and through it.
    const Scene wall = SceneBuilder()
                           .quad({0, -2, -2}, {0, 2, -2}, {0, 2, 2}, {0, -2, 2})
                           .box({-2, -0.5F, -0.5F}, {-1, 0.5F, 0.5F})
                           .box({-2, 1.5F, -0.5F}, {-1, 2.5F, 0.5F})
                           .box({1, -0.5F, -0.5F}, {2, 0.5F, 0.5F})
                           .box({-0.5F, -1.5F, -0.5F}, {0.5F, -1.2F, 0.5F})
                           .scene();
    EXPECT_EQ(covered(wall, vec4(1, 0, 0, 0)), (Found{0, 1, 0, 0, 0})) << "the sun before it";
    EXPECT_EQ(covered(wall, vec4(-1, 0, 0, 0)), (Found{0, 0, 0, 1, 0})) << "the sun behind it";
    EXPECT_EQ(covered(wall, vec4(0, 1, 0, 0)), (Found{0, 0, 0, 0, 0})) << "the sun in its plane";
    EXPECT_EQ(covered(wall, vec4(9, 0, 0, 1)), (Found{0, 1, 0, 0, 0})) << "a lamp far before it";
    EXPECT_EQ(covered(wall, vec4(0.5F, 0, 0, 1)), (Found{0, 1, 1, 0, 0})) << "a lamp next to it, whose shadow widens";
    EXPECT_EQ(covered(wall, vec4(-1.5F, 0, 0, 1)), (Found{0, 0, 0, 1, 0})) << "a lamp inside a box behind it";
}

TEST(VolumeCovered, looks_through_holes_and_into_solids) {
    // A frame around a hole that a ray to the box's middle passes, and one that lies off all rays to it.
    const auto frame = [](float side) {
        std::vector<vec3> corners;
        for (const float half : {side, 3.0F}) {
            corners.insert(corners.end(), {{0, -half, -half}, {0, half, -half}, {0, half, half}, {0, -half, half}});
        }
        std::vector<uvec3> triangles;
        for (uint i = 0; i < 4; ++i) {
            const uint next = (i + 1) % 4;
            triangles.insert(triangles.end(), {{i, next, 4 + next}, {i, 4 + next, 4 + i}});
        }
        return SceneBuilder().mesh(corners, triangles);
    };
    EXPECT_EQ(covered(frame(0.2F).box({-2, -0.5F, -0.5F}, {-1, 0.5F, 0.5F}).scene(), vec4(1, 0, 0, 0)), (Found{0, 0}));
    EXPECT_EQ(covered(frame(0.2F).box({-2, 0.5F, 0.5F}, {-1, 1.5F, 1.5F}).scene(), vec4(1, 0, 0, 0)), (Found{0, 1}));
    // A closed room keeps the sun off what stands in it, whichever way its walls are wound, and a lamp inside does not.
    for (const bool inverted : {false, true}) {
        const Scene room = SceneBuilder().box(vec3(-3), vec3(3), inverted).box({-1, -2, -1}, {1, 0, 1}).scene();
        EXPECT_EQ(covered(room, vec4(0.3F, 1, 0.2F, 0)), (Found{0, 1})) << inverted;
    }
}

TEST(VolumeCovered, is_seen_by_no_ray_of_the_light) {
    // Whatever random cards and boxes are told to be covered, no ray from the light reaches.
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
    int found = 0;
    for (int round = 0; round < 60; ++round) {
        SceneBuilder b;
        for (int i = 0; i < 6; ++i) {
            const vec3 centre = 2.0F * any(), half = vec3(0.1F) + 0.9F * glm::abs(any());
            b.box(centre - half, centre + half, i % 2 == 0);
            const vec3 o = 2.0F * any(), x = 2.5F * any(), y = 2.5F * any();
            b.quad(o, o + x, o + x + y, o + y);
        }
        for (int i = 0; i < 8; ++i) {
            const vec3 centre = 2.0F * any();
            b.box(centre - vec3(0.1F), centre + vec3(0.1F));
        }
        const Scene scene = b.scene();
        const vec4 light_ws = round % 2 == 0 ? vec4(glm::normalize(any()), 0) : vec4(6.0F * glm::normalize(any()), 1);
        const Found told = covered(scene, light_ws);
        for (std::size_t c = 0; c < told.size(); ++c) {
            if (told[c] == 0) {
                continue;
            }
            ++found;
            Scene others = scene;
            others.objects[c].casts = false;
            const Truth truth(others);
            const Box& box = scene.objects[c].bounds_ws;
            for (int i = 0; i < 200; ++i) {
                const dvec3 p_ws(box.centre() + 0.5F * box.extent() * any());
                const dvec3 to_light = dvec3(light_ws) - p_ws * static_cast<double>(light_ws.w);
                EXPECT_TRUE(truth.blocked(p_ws, p_ws + to_light * (light_ws.w > 0 ? 1.0 : 100.0)))
                    << "round " << round << ", object " << c;
            }
        }
    }
    EXPECT_GT(found, 100);
}

// ---- Rendered. ----

struct Drawn {
    std::vector<std::vector<float>> v;
    double fragments = 0;
};

/// V of all lights, and the fragments that the first one's volumes took.
Drawn draw(const Scene& scene, const Values& values, uint width = 160, uint height = 120) {
    const test::ValidationGuard guard;
    const Recipe recipe = direct_recipe(parts::direct_volumes(), values);
    SceneGpu uploaded = upload_scene(device(), scene);
    const FrameResult frame = render_frame(device(), uploaded, scene.cameras.front(), recipe,
                                           {.width = width, .height = height, .picture = false});
    Drawn drawn;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        EXPECT_EQ(frame.refused[i], "");
        drawn.v.push_back(frame.visibility[i].values);
    }
    const std::string asked = "volume-fragments";
    const Image shown =
        show_hidden(device(), uploaded, scene.cameras.front(), recipe, {&asked, 1}, {.width = width, .height = height})
            .front()
            .values;
    for (std::size_t i = 0; i < shown.values.size(); i += static_cast<std::size_t>(shown.channels)) {
        drawn.fragments += static_cast<double>(shown.values[i]);
    }
    return drawn;
}

// A house's wall and roof before many boxes and rings, some of them not wholly in its shadow.
Scene yard_behind_a_house() {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    SceneBuilder b;
    b.ground(12).box({2, 0, -4}, {2.3F, 3, 4});
    for (int i = 0; i < 40; ++i) {
        const vec3 at(0.3F + 1.4F * unit(random), 0.2F + 0.5F * std::abs(unit(random)), 4.5F * unit(random));
        const vec3 half = vec3(0.08F) + 0.15F * glm::abs(vec3(unit(random), unit(random), unit(random)));
        if (i % 4 == 0) {
            b.torus(at, 0.25F, 0.08F, 8);
        } else {
            b.box(at - half, at + half);
        }
    }
    b.camera({-5, 4, 5}, {0.5F, 0.3F, 0}).light(sun({-1, -0.7F, 0.1F})).light(point({6, 5, 0}));
    return b.scene();
}

TEST(VolumeCovered, changes_no_sample_and_takes_fragments_away) {
    const Scene scene = yard_behind_a_house();
    for (const char* mode : {"auto", "z-fail", "zp+"}) {
        const Drawn all = draw(scene, {{"mode", mode}, {"covered", "0"}}), few = draw(scene, {{"mode", mode}});
        EXPECT_EQ(all.v, few.v) << mode;
        EXPECT_LT(few.fragments, 0.7 * all.fragments) << mode;
    }
    // Inside two volumes z-pass is wrong by two, whatever hides what.
    EXPECT_EQ(draw(scene, {{"mode", "z-pass"}, {"covered", "0"}}).fragments,
              draw(scene, {{"mode", "z-pass"}}).fragments);
}

// ---- Slices. ----

TEST(VolumeSlices, hold_whatever_sees_the_light_through_a_box) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
    int met = 0, apart = 0;
    for (int round = 0; round < 20000; ++round) {
        const vec3 centre = 2.0F * any(), half = vec3(0.02F) + 0.7F * glm::abs(any());
        const vec3 middle = 4.0F * any(), reach = 0.5F * glm::abs(any());
        const vec4 light_ws = round % 2 == 0 ? vec4(any(), 0) : vec4(4.0F * any(), 1);
        const bool told = gn_volumes_may_hold(centre - half, centre + half, middle - reach, middle + reach, light_ws);
        bool hit = false;
        for (int i = 0; i < 40 && !hit; ++i) {
            const dvec3 from(middle + reach * any()), way = dvec3(light_ws) - from * static_cast<double>(light_ws.w);
            const dvec3 a = (dvec3(centre - half) - from) / way, b = (dvec3(centre + half) - from) / way;
            const dvec3 low = glm::min(a, b), high = glm::max(a, b);
            const double enter = std::max({low.x, low.y, low.z, 0.0}), leave = std::min({high.x, high.y, high.z});
            hit = enter <= leave && (light_ws.w == 0.0F || enter <= 1.0);
        }
        EXPECT_TRUE(told || !hit) << round;
        met += hit ? 1 : 0;
        apart += told ? 0 : 1;
    }
    EXPECT_GT(met, 300);
    EXPECT_GT(apart, (20000 - met) / 2) << "most that are apart are told to be";
}

TEST(VolumeSlices, cut_a_picture_between_its_pixels) {
    // The run of columns 4 to 6 and rows 10 to 10 of 160 x 48 pixels.
    const uvec4 run(12, 7, 6, 11);
    const auto within = [&](float x, float y) {
        const vec4 inside = gn_volumes_within_run(run, uvec2(160, 48), vec4(2 * x / 160 - 1, 2 * y / 48 - 1, 0.5F, 1));
        return std::min({inside.x, inside.y, inside.z, inside.w}) >= 0;
    };
    EXPECT_TRUE(within(40.5F, 30.5F));
    EXPECT_TRUE(within(69.5F, 32.5F));
    EXPECT_FALSE(within(39.5F, 31.5F));
    EXPECT_FALSE(within(70.5F, 31.5F));
    EXPECT_FALSE(within(50, 29.5F));
    EXPECT_FALSE(within(50, 33.5F));
    EXPECT_LT(gn_volumes_within_run(uvec4(0), uvec2(160, 48), vec4(0, 0, 0.5F, 1)).x, 0) << "no sample";
}

TEST(VolumeSlices, change_no_sample_and_take_fragments_away) {
    for (const char* name : {"fence", "stack", "contact:light=point", "grid:objects=25"}) {
        Scene scene = make_builtin_scene(name);
        for (Light& light : scene.lights) {
            light.shape.radius = light.shape.angular_radius = 0.0F;
        }
        const Drawn whole = draw(scene, {{"clamp", "0"}}), sliced = draw(scene, {{"clamp", "0"}, {"slices", "1"}});
        EXPECT_EQ(whole.v, sliced.v) << name;
        EXPECT_LT(sliced.fragments, 0.97 * whole.fragments) << name << ": a floor to the horizon leaves little to cut";
        const Drawn clamped = draw(scene, {}), both = draw(scene, {{"slices", "1"}});
        EXPECT_EQ(clamped.v, both.v) << name;
        EXPECT_LE(both.fragments, 1.01 * clamped.fragments) << name;
    }
    // With caps that are compared: cards with one side, cut as their sides are.
    SceneBuilder b;
    const int one = b.material({.name = "one side", .double_sided = false});
    b.ground(10).quad({-1, 1, -1}, {1, 1.3F, -1}, {1, 1.3F, 1}, {-1, 1, 1}, one);
    b.quad({-2, 2, 1}, {-1, 2, 1}, {-1, 2.2F, 2}, {-2, 2.2F, 2}, one).camera({4, 3.3F, 5.2F}, {0, 0.4F, 0});
    const Scene cards = b.light(sun({-0.4F, -1, 0.33F})).light(sun({0.4F, 1, 0.33F})).light(point({0, 4, 0})).scene();
    EXPECT_EQ(draw(cards, {}).v, draw(cards, {{"slices", "1"}}).v);
}

// ---- Simpler bodies. ----

/// Silhouette edges, over suns from all around.
double sides(std::span<const vec3> positions_ws, std::span<const uvec3> triangles, const EdgeList& list) {
    double found = 0;
    for (int i = 0; i < 24; ++i) {
        const vec4 light_ws(std::cos(2.4F * static_cast<float>(i)), 1.3F - 0.1F * static_cast<float>(i),
                            std::sin(2.4F * static_cast<float>(i)), 0);
        for (std::size_t e = 0; e < list.edges.size(); ++e) {
            int sum = 0;
            for (std::uint32_t k = list.first[e]; k < list.first[e + 1]; ++k) {
                const uvec3 t = triangles[list.around[k] / 2];
                const int m = gn_volumes_side(positions_ws[t.x], positions_ws[t.y], positions_ws[t.z], light_ws);
                sum += (list.around[k] & 1U) != 0U ? -m : m;
            }
            found += sum != 0 ? 1 : 0;
        }
    }
    return found;
}

TEST(VolumeProxies, lie_within_the_solids_that_they_cast_for) {
    SceneBuilder b;
    b.torus({0, 0, 0}, 2, 0.7F, 40).box({5, 0, 0}, {6, 1, 1}).quad({0, 3, 0}, {1, 3, 0}, {1, 3, 1}, {0, 3, 1});
    const Scene scene = b.scene();
    const std::vector<std::uint8_t> casts(scene.triangles.size(), casts_from_both_sides);
    const std::vector<std::uint8_t> masked(scene.triangles.size(), 0);
    const EdgeList list = build_edges(scene.positions_ws, scene.triangles, casts);
    const ProxyMesh mesh = make_proxies({scene.positions_ws, scene.triangles, casts, masked, list}, 0.25F);
    EXPECT_EQ(mesh.solids, 1U) << "a box of twelve triangles and a sheet cast as they are";
    EXPECT_EQ(mesh.replaced, 1U);
    EXPECT_EQ(mesh.triangles_before, 3200U);
    EXPECT_LT(mesh.triangles_after, 1000U);
    EXPECT_EQ(mesh.triangles.size(), mesh.triangles_after + 14);
    const EdgeList bodies = build_edges(mesh.positions_ws, mesh.triangles, mesh.casts);
    EXPECT_LT(sides(mesh.positions_ws, mesh.triangles, bodies), 0.8 * sides(scene.positions_ws, scene.triangles, list));
    float outermost = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.is_proxy[t] == 0) {
            continue;
        }
        EXPECT_TRUE(bodies.components[bodies.component_of[t]].closed);
        for (int i = 0; i < 3; ++i) {
            for (const float share : {0.0F, 0.25F, 0.5F}) {
                const vec3 p = glm::mix(mesh.positions_ws[mesh.triangles[t][i]],
                                        mesh.positions_ws[mesh.triangles[t][(i + 1) % 3]], share);
                const float off_axis = std::hypot(p.x, p.z) - 2;
                outermost = std::max(outermost, std::hypot(off_axis, p.y));
            }
        }
    }
    // The facets of a ring of 40 by 40 lie up to 0.3 % of its tube within it.
    EXPECT_LT(outermost, 0.7F * std::cos(pi / 40)) << "within the ring's facets";
    EXPECT_GT(outermost, 0.6F);
}

TEST(VolumeProxies, cast_no_shadow_where_the_solid_casts_none) {
    SceneBuilder b;
    b.ground(10).torus({0, 1, 0}, 1, 0.4F, 40).box({-3, 0, -1}, {-2, 1, 0}).camera({4, 3.3F, 5.2F}, {0.2F, 0.4F, 0});
    const Scene scene = b.light(sun({-0.4F, -1, 0.33F})).light(point({2.3F, 3.1F, 0.7F})).scene();
    const Drawn solid = draw(scene, {{"clamp", "0"}}), body = draw(scene, {{"clamp", "0"}, {"proxies", "0.1"}});
    for (std::size_t light = 0; light < 2; ++light) {
        std::size_t early = 0, shadowed = 0, lost = 0;
        for (std::size_t i = 0; i < solid.v[light].size(); ++i) {
            early += solid.v[light][i] > body.v[light][i] ? 1 : 0;
            shadowed += body.v[light][i] == 0 ? 1 : 0;
            lost += solid.v[light][i] < body.v[light][i] ? 1 : 0;
        }
        EXPECT_EQ(early, 0U) << "of light " << light;
        EXPECT_GT(shadowed, 2000U);
        EXPECT_GT(lost, 20U) << "they are smaller";
    }
}

}  // namespace
}  // namespace volumes_culling_test
}  // namespace gn
