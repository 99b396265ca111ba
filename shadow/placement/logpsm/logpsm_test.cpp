// SPDX-License-Identifier: MIT
// The error that is the same everywhere, texels that find their own point of a triangle, and what a warp may not break.
#include "shadow/placement/faces.glsl"
#include "shadow/placement/warp.h"
#include "shadow/receiver/logarithm.glsl"
#include "shadow/receiver/map_access.glsl"
#include "shadow/receiver/receiver.glsl"
#include "tests/direct_scenes.h"
#include "tests/warp_scene.h"

#include <random>

namespace gn::logpsm_test {
namespace {

constexpr const char* logarithmic = "hard,placement=logpsm,resolution=4096";

/// C 3.2.2.2: ds = dz / z over [z_n, z_f] makes dp/ds = ln(z_f / z_n) at every z under a light overhead; and with the camera's own
/// perspective the error across the view is the same everywhere as well.
TEST(Logpsm, ErrorIsTheSameAtEveryDistanceUnderALightOverhead) {
    const double near = 2;
    const double far = 200;
    const GnLightView view = test::place(test::long_floor(near, far), logarithmic).views[0];
    EXPECT_NEAR(-static_cast<double>(view.paraboloid), std::log(far / near), 0.01);
    const double across = test::error_along(view, {0, 0, -20}, {1, 0, 0}, 20);
    for (double z = 1.001 * near; z < 0.999 * far; z *= 1.1) {
        const double along = test::error_along(view, {0, 0, -z}, {0, 0, 1}, z);
        EXPECT_NEAR(along, std::log(far / near), 0.01 * std::log(far / near)) << z;
        EXPECT_NEAR(test::error_along(view, {0, 0, -z}, {1, 0, 0}, z), across, 0.02 * across) << z;
    }
}

/// eta runs from the fitted map over the even warp's perspective to the camera's; on each the rows follow ln(w).
TEST(Logpsm, EtaIsTheStrengthOfThePerspective) {
    const Scene scene = test::long_floor(2, 200);
    const GnLightView fitted = test::place(scene, "hard,placement=fit,resolution=4096").views[0];
    const auto at = [&](const char* eta) {
        return test::place(scene, fmt::format("{},logpsm.eta={}", logarithmic, eta)).views[0];
    };
    EXPECT_EQ(at("-1").cs_from_ws, fitted.cs_from_ws);
    // w = 1 + (z - z_n) / n.
    const double n = warp::optimal_distance(2, 200);
    EXPECT_NEAR(-static_cast<double>(at("0").paraboloid), std::log((n + 198) / n), 0.02);
    EXPECT_NEAR(-static_cast<double>(at("1").paraboloid), std::log(100.0), 0.02);
}

struct Corners {
    std::mt19937 random{17};
    std::uniform_real_distribution<float> uniform{-1, 1};
    vec3 operator()(float size) {
        // y alike, as a sun's, or not.
        return {4 * size * uniform(random), 0.6F + 0.3F * uniform(random), 1 + 3 * size * uniform(random)};
    }
};

TEST(Logpsm, PlaceAndPointOfClipSpaceAreInverse) {
    for (const float rate : {0.0F, 0.05F, 1.0F, 6.0F, 11.0F}) {
        for (float y = -1; y <= 1; y += 0.125F) {
            const vec2 p_ndc = glsl::gn_log_ndc(vec2(0.3F, y), rate);
            const vec2 place = glsl::gn_log_place(vec3(2.0F * p_ndc.x, 2.0F * p_ndc.y, 2), rate);
            EXPECT_NEAR(place.x, 0.3F, 1e-6F);
            EXPECT_NEAR(place.y, y, 1e-5F) << rate;
        }
    }
    EXPECT_NEAR(glsl::gn_log_ndc(vec2(0, 1), 2).y, std::exp(-2.0F), 1e-6F);
    EXPECT_EQ(glsl::gn_log_ndc(vec2(0, -1), 2).y, 1.0F);
}

TEST(Logpsm, StepsOverRowsAreExactAndInverse) {
    for (const double rate : {0.0, 0.5, 3.0, 12.0}) {
        for (const double step : {-0.4, -0.02, -1e-4, 0.0, 1e-5, 3e-3, 0.05, 0.6}) {
            const double expected = rate > 0 ? (1 - std::exp(-rate * step)) / rate : step;
            const float found = glsl::gn_log_step(static_cast<float>(step), static_cast<float>(rate));
            EXPECT_NEAR(found, expected, 3e-6 * std::abs(expected)) << rate << " " << step;
            EXPECT_NEAR(glsl::gn_log_unstep(found, static_cast<float>(rate)), step, 1e-4 * std::abs(step) + 1e-6);
        }
    }
}

/// The bounding rectangle holds every point of a triangle that the map shows.
TEST(Logpsm, BoundsHoldWhatTheMapShowsOfATriangle) {
    Corners corner;
    std::uniform_real_distribution<float> uniform(0, 1);
    int asked = 0;
    int small = 0;
    for (int i = 0; i < 4000; ++i) {
        const float rate = i % 3 == 0 ? 0.0F : 0.1F + 2.0F * static_cast<float>(i % 5);
        const float size = i % 2 == 0 ? 0.1F : 1.0F;
        // Some pass the light, where y is 0.
        const vec3 down(0, i % 4 == 0 ? 0.5F : 0.0F, 0);
        const vec3 a = corner(size) - down;
        const vec3 b = corner(size) - down * uniform(corner.random);
        const vec3 c = corner(size);
        const vec4 box = glsl::gn_log_bounds(a, b, c, rate);
        for (int j = 0; j < 50; ++j) {
            float s = uniform(corner.random);
            float t = uniform(corner.random);
            s = s + t > 1 ? 1 - s : s;
            t = s + t > 1 ? 1 - t : t;
            const vec3 p = a + s * (b - a) + t * (c - a);
            const vec2 place = p.z > 0 ? glsl::gn_log_place(p, rate) : vec2(9);
            if (std::max(std::abs(place.x), std::abs(place.y)) < 1) {
                ++asked;
                ASSERT_TRUE(place.x >= box.x && place.x <= box.z && place.y >= box.y && place.y <= box.w)
                    << "triangle " << i << " rate " << rate << " at " << place.x << ", " << place.y;
            }
        }
        small += box.x > box.z || (box.z - box.x) * (box.w - box.y) < 3.9F ? 1 : 0;
    }
    EXPECT_GT(asked, 20000);
    EXPECT_GT(small, 2000) << "most rectangles are smaller than the map";
}

/// A texel meets the triangle where it does, of triangles too that end behind the centre of projection; what lies there is not
/// shown; and of two triangles with a common edge one takes its points.
TEST(Logpsm, HitIsThePointOfTheTriangle) {
    Corners corner;
    std::uniform_real_distribution<float> uniform(0, 1);
    int behind = 0;
    for (int i = 0; i < 3000; ++i) {
        const vec3 a = corner(1);
        const vec3 b = corner(1);
        const vec3 c = corner(1);
        const float s = uniform(corner.random);
        const float t = (1 - s) * uniform(corner.random);
        const vec3 p = a + s * (b - a) + t * (c - a);
        if (std::abs(glm::dot(a, glm::cross(b, c))) < 0.1F || std::abs(p.z) < 0.2F || std::min(s, t) < 0.01F ||
            s + t > 0.99F) {
            continue;
        }
        const vec4 hit = glsl::gn_log_hit(vec2(p) / p.z, a, b, c);
        if (p.z < 0) {
            ++behind;
            EXPECT_LT(hit.w, 0.0F) << i;
            continue;
        }
        EXPECT_GT(hit.w, 0.0F) << i;
        EXPECT_NEAR(hit.x, 1 - s - t, 2e-3F) << i;
        EXPECT_NEAR(hit.y, s, 2e-3F) << i;
        const vec3 on_edge = a + s * (b - a);
        if (on_edge.z > 0.2F) {
            const vec3 d = a + b - c;
            const bool apart = glsl::gn_log_facing(a, b, c) * glsl::gn_log_facing(b, a, d) > 0;
            const bool first = glsl::gn_log_hit(vec2(on_edge) / on_edge.z, a, b, c).w > 0;
            const bool second = glsl::gn_log_hit(vec2(on_edge) / on_edge.z, b, a, d).w > 0;
            EXPECT_TRUE(!apart || first || second) << i;
        }
    }
    EXPECT_GT(behind, 100);
}

TEST(Logpsm, SlopeIsTheChangeOverThePlace) {
    Corners corner;
    constexpr float step = 1.0F / 256;
    int compared = 0;
    for (int i = 0; i < 4000; ++i) {
        const vec3 a = corner(0.3F);
        const vec3 b = corner(0.3F);
        const vec3 c = corner(0.3F);
        const vec3 depths(0.2F, 0.5F, 0.9F);
        const float rate = i % 2 == 0 ? 1.0F : 4.0F;
        const vec2 place = glsl::gn_log_place((a + b + c) / 3.0F, rate);
        std::array<float, 4> around{};
        bool all = true;
        for (std::size_t j = 0; j < 4; ++j) {
            const vec2 beside = place + (j < 2 ? vec2(j == 0 ? -step : step, 0) : vec2(0, j == 2 ? -step : step));
            const vec4 hit = glsl::gn_log_hit(glsl::gn_log_ndc(beside, rate), a, b, c);
            all = all && hit.w > 0;
            around[j] = glm::dot(vec3(hit), depths);
        }
        if (all && std::abs(around[1] - around[0]) < 0.02F && std::abs(around[3] - around[2]) < 0.02F) {
            const vec2 slope = glsl::gn_log_slope(glsl::gn_log_ndc(place, rate), a, b, c, depths, rate);
            EXPECT_NEAR(slope.x, (around[1] - around[0]) / (2 * step), 0.03F) << i;
            EXPECT_NEAR(slope.y, (around[3] - around[2]) / (2 * step), 0.03F) << i;
            ++compared;
        }
    }
    EXPECT_GT(compared, 300);
}

const GnBias no_bias{.constant = 0, .slope = 0, .normal = 0, .receiver_plane = 1, .cone = 0};

GnLightView some_view(bool sun) {
    Scene scene = test::long_floor(2, 60, vec3(0.3F, 1, 0.2F));
    scene.bounds_ws.max.y = 2;
    if (!sun) {
        scene.lights[0].shape.kind = GN_LIGHT_POINT;
        scene.lights[0].shape.position_ws = vec4(4, 60, -20, 1);
    }
    return test::place(scene, "pcf,placement=logpsm,resolution=512").views[0];
}

/// A receiver's plane keeps its depth at every tap, and taps beside it lie where its points are.
TEST(Logpsm, DepthOfThePlaneIsExact) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (const bool sun : {true, false}) {
        const GnLightView view = some_view(sun);
        ASSERT_LT(view.paraboloid, 0);
        int compared = 0;
        for (int i = 0; i < 500; ++i) {
            glsl::GnReceiver receiver{};
            receiver.p_ws = vec3(2 * uniform(random), 1 + uniform(random), -20 + 10 * uniform(random));
            receiver.n_ws = glm::normalize(vec3(uniform(random), uniform(random), uniform(random)));
            const auto projected = glsl::gn_project(receiver, view, no_bias);
            if (std::abs(glm::dot(receiver.n_ws, glsl::gn_to_eye(view, receiver.p_ws))) < 0.3F) {
                continue;
            }
            vec3 x;
            vec3 y;
            complete_frame(receiver.n_ws, x, y);
            glsl::GnReceiver other = receiver;
            other.p_ws += 1.5F * x - 1.0F * y;
            const auto there = glsl::gn_project(other, view, no_bias);
            EXPECT_NEAR(glsl::gn_depth_at(projected, there.uv_ts, no_bias), there.depth, 1e-4F) << i;
            for (const float gap : {-3e-4F, 3e-4F}) {
                const auto lit = glsl::gn_lit_at(projected, vec4(there.uv_ts.x), vec4(there.uv_ts.y),
                                                 vec4(there.depth + gap), no_bias);
                EXPECT_EQ(lit.x, gap > 0) << i;
            }
            const vec3 way_ws = glsl::gn_way_ws(receiver, view, there.uv_ts - projected.uv_ts);
            EXPECT_LT(glm::distance(way_ws, other.p_ws - receiver.p_ws), 2e-2F) << i;
            ++compared;
        }
        EXPECT_GT(compared, 200);
    }
}

TEST(Logpsm, TexelSizeIsTheWorldLengthOfATexel) {
    for (const bool sun : {true, false}) {
        const GnLightView view = some_view(sun);
        for (const float z : {3.0F, 10.0F, 50.0F}) {
            glsl::GnReceiver receiver{};
            receiver.p_ws = vec3(0.5F, 0.2F, -z);
            receiver.n_ws = glsl::gn_to_eye(view, receiver.p_ws);
            const auto projected = glsl::gn_project(receiver, view, no_bias);
            for (int axis = 0; axis < 2; ++axis) {
                const vec3 gradient = axis == 0 ? projected.du_ws : projected.dv_ws;
                const double step = 1e-3 * static_cast<double>(z);
                const dvec3 way = step * glm::normalize(dvec3(gradient));
                const dvec2 change =
                    test::uv_of(view, dvec3(receiver.p_ws) + way) - test::uv_of(view, dvec3(receiver.p_ws) - way);
                EXPECT_NEAR(change[axis] / (2 * step), glm::length(gradient), 0.01F * glm::length(gradient))
                    << z << " axis " << axis;
            }
        }
    }
}

/// Wherever the light stands, no receiver beyond the pseudo-near plane gets a coarser texel on screen than the coarsest of the
/// unwarped map.
TEST(Logpsm, WorstTexelOnScreenIsNeverWorseThanFits) {
    Scene scene = test::long_floor(2, 60);
    scene.bounds_ws.max.y = 3;
    std::mt19937 random(9);
    std::normal_distribution<float> normal;
    int warped = 0;
    for (int i = 0; i < 100; ++i) {
        const vec3 to_light = glm::normalize(vec3(normal(random), std::abs(normal(random)) + 0.1F, normal(random)));
        scene.lights[0].shape.direction_ws = vec4(-to_light, 0);
        const auto worst = [&](const char* placement) {
            const GnLightView view =
                test::place(scene, fmt::format("hard,resolution=4096,placement={}", placement)).views[0];
            double most = 0;
            for (const float z : {2.1F, 5.0F, 20.0F, 59.0F}) {
                for (const float x : {-1.2F, 0.0F, 1.2F}) {
                    glsl::GnReceiver receiver{};
                    receiver.p_ws = vec3(0.5F * x * z, 0, -z);
                    most = std::max(most, static_cast<double>(glsl::gn_project(receiver, view, {}).texel_ws / z));
                }
            }
            return std::pair(most, view.paraboloid < 0);
        };
        const auto [of_log, is_warped] = worst("logpsm");
        // A few points of the body stand for it.
        EXPECT_LE(of_log, 1.5 * worst("fit").first) << to_light.x << " " << to_light.y << " " << to_light.z;
        warped += is_warped ? 1 : 0;
    }
    EXPECT_GT(warped, 60);
}

TEST(Logpsm, EveryViewSampleProjectsInsideTheMap) {
    std::size_t asked = 0;
    for (const char* name : {"contact", "corridor", "duel", "duel:light=spot", "slab"}) {
        const Scene scene = load_scene(name);
        SceneGpu gpu = upload_scene(test::device(), scene);
        const CpuSamples cpu = render_samples(test::device(), gpu, scene.cameras[0], 64, 64);
        const LightViews views = test::place(scene, "pcf,pcf.size=7,placement=logpsm,resolution=512", 64, 64);
        for (std::size_t i = 0; i < cpu.position_ws.size(); ++i) {
            const vec3 p_ws(cpu.position_ws[i]);
            if (cpu.position_ws[i].w < 0.5F || !gn_counted(scene.lights[0].shape, p_ws, vec3(cpu.normal_ws[i]))) {
                continue;
            }
            glsl::GnReceiver receiver{};
            receiver.p_ws = p_ws;
            const auto view =
                static_cast<std::size_t>(glsl::gn_face_choice(receiver, views.data_as<glsl::GnFacesData>()).first);
            const dvec2 uv = test::uv_of(views.views[view], dvec3(p_ws));
            const double reach = 3.5 / 512;
            ASSERT_TRUE(std::min(uv.x, uv.y) >= reach && std::max(uv.x, uv.y) <= 1 - reach)
                << name << " sample " << i << " at " << uv.x << " " << uv.y;
            ++asked;
        }
    }
    EXPECT_GT(asked, 5U * 500U);
}

const test::ComparisonOptions small{.width = 128, .height = 128, .samples = 1, .view = ""};

/// Wrong samples of a hard shadow are those within half a texel of an edge.
TEST(LogpsmRendered, FewerWrongPixelsThanAPlainMapInTheCorridor) {
    const auto plain = test::compare("corridor", "hard,placement=fit,resolution=512", small);
    const auto rows = test::compare("corridor", "hard,placement=logpsm,resolution=512", small);
    EXPECT_LT(*rows.errors.mismatch, 0.4 * *plain.errors.mismatch);
}

/// Two samples away from every edge the shadow is the traced one: texels see their own points, whatever the triangles' size.
TEST(LogpsmRendered, EqualsTheTracedShadowAwayFromEdges) {
    for (const char* scene : {"corridor", "contact", "duel:light=spot,elevation=50", "contact:light=spot"}) {
        const auto c = test::compare(scene, "hard,placement=logpsm,resolution=2048", small);
        int judged = 0;
        int wrong = 0;
        for (int y = 2; y < 126; ++y) {
            for (int x = 2; x < 126; ++x) {
                const auto at = static_cast<std::size_t>(y * 128 + x);
                bool inside = true;
                for (int i = 0; i < 25; ++i) {
                    const auto near = static_cast<std::size_t>((y + i / 5 - 2) * 128 + x + i % 5 - 2);
                    inside = inside && c.truth.counted[near] != 0 && c.truth.visibility[near] == c.truth.visibility[at];
                }
                judged += inside ? 1 : 0;
                wrong += inside && std::abs(c.visibility().values[at] - c.truth.visibility[at]) > 0.5F ? 1 : 0;
            }
        }
        EXPECT_GT(judged, 1500) << scene;
        EXPECT_LE(wrong, 2e-3 * judged) << scene;
    }
}

TEST(LogpsmRendered, NoAcneWithTheDefaultBias) {
    for (const char* scene : {"tilted", "tilted:angle=85", "tilted:light=spot"}) {
        for (const char* recipe : {"hard", "pcf,pcf.size=7"}) {
            const auto c = test::compare(scene, fmt::format("{},placement=logpsm", recipe), small);
            EXPECT_LE(*c.errors.acne, 1e-3) << scene << " " << recipe;
        }
    }
}

/// Culling by facing means the same as in any other view.
TEST(LogpsmRendered, FacesOfCastersAreThoseOfAFittedMap) {
    for (const char* casters : {"front", "back"}) {
        const auto fit = test::compare("contact", fmt::format("hard,placement=fit,casters={}", casters), small);
        const auto rows = test::compare("contact", fmt::format("hard,placement=logpsm,casters={}", casters), small);
        EXPECT_NEAR(*rows.errors.mismatch, *fit.errors.mismatch, 0.01) << casters;
    }
}

/// A board without a back side is drawn with the faces that the light sees first or with the others, never with both.
TEST(LogpsmRendered, ABoardHasOneSide) {
    GnLight sun = by_hand::sun({0.3F, -1, -0.2F});
    const Scene scene = by_hand::SceneBuilder()
                            .ground(4)
                            .quad({-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}, {1, 1, -1})
                            .light(sun)
                            .camera({0.5F, 3, 6}, {0, 0, 0})
                            .scene();
    const auto dark = [&](const char* placement, const char* casters) {
        const auto c = test::compare(scene, fmt::format("hard,placement={},casters={}", placement, casters), small);
        const std::vector<float>& v = c.visibility().values;
        return static_cast<int>(std::count(v.begin(), v.end(), 0.0F));
    };
    const int front = dark("fit", "front"), back = dark("fit", "back");
    ASSERT_GT(std::abs(front - back), 100);
    // Half a texel along the board's edge.
    EXPECT_NEAR(dark("logpsm", "front"), front, 60);
    EXPECT_NEAR(dark("logpsm", "back"), back, 60);
}

/// A slab high above all that the camera sees is nearer to the light than the map's near plane.
TEST(LogpsmRendered, CasterBeforeTheNearPlaneStillCasts) {
    // Of 64 points of its light none is seen: that is half a penumbra inside the hard edge.
    const auto c =
        test::compare("slab", "hard,placement=logpsm", {.width = 128, .height = 128, .samples = 64, .view = ""});
    EXPECT_EQ(*c.errors.leak, 0.0);
}

/// What follows straight edges through its views says so by name.
TEST(LogpsmRendered, WhatFollowsStraightEdgesIsRefusedByName) {
    const Scene& scene = test::built_in("contact");
    for (const char* recipe :
         {"irregular-z", "forward", "silhouette", "backprojection", "smoothies", "penumbra-deep"}) {
        try {
            Scene copy = scene;
            SceneGpu gpu = upload_scene(test::device(), copy);
            const FrameResult frame = render_frame(test::device(), gpu, copy.camera(""),
                                                   load_recipe(std::string(recipe) + ",placement=logpsm"),
                                                   {.width = 16, .height = 16, .only_light = 0, .picture = false});
            EXPECT_NE(frame.refused.front().find("logpsm"), std::string::npos)
                << recipe << ": " << frame.refused.front();
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("logpsm"), std::string::npos) << recipe << ": " << error.what();
        }
    }
}

}  // namespace
}  // namespace gn::logpsm_test
