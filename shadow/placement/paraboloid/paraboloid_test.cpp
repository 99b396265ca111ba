// SPDX-License-Identifier: MIT
// Laws of the mirror on the CPU, and its pictures against traced truth and against a cube's.
#include "shadow/placement/paraboloid/paraboloid.h"
#include "shadow/receiver/paraboloid.glsl"
#include "shadow/recipe/guard.h"

#include "shadow/receiver/receiver.glsl"
#include "tests/warp_scene.h"

#include <random>

namespace gn::paraboloid_test {
namespace {

struct Directions {
    std::mt19937 random{11};
    std::normal_distribution<float> normal;
    vec3 operator()() { return glm::normalize(vec3(normal(random), normal(random), normal(random))); }
};

TEST(Paraboloid, RayAndImageAreInverse) {
    Directions direction;
    int asked = 0;
    for (int i = 0; i < 1000; ++i) {
        const vec3 d = direction();
        if (d.z > -0.9F) {
            ++asked;
            EXPECT_LT(glm::length(glsl::gn_paraboloid_ray(glsl::gn_paraboloid(7.0F * d)) - d), 1e-5F);
            // The hemisphere is the unit disc.
            EXPECT_EQ(glm::length(glsl::gn_paraboloid(d)) < 1, d.z > 0) << d.z;
        }
    }
    EXPECT_GT(asked, 900);
}

GnLightView some_view() {
    const LightViews views = test::place(load_scene("contact:light=point"), "pcf,pcf.size=9,placement=paraboloid");
    return views.views[0];
}

/// The bounding rectangle holds every direction of the triangle, and no more than its corners ask for.
TEST(Paraboloid, BoundsHoldTheCurvedTriangle) {
    Directions direction;
    std::uniform_real_distribution<float> uniform(0, 1);
    int asked = 0;
    int small = 0;
    for (int i = 0; i < 4000; ++i) {
        const float size = i % 2 == 0 ? 0.1F : 2.0F;
        const vec3 a = 3.0F * direction();
        const vec3 b = a + size * direction();
        const vec3 c = a + size * direction();
        const vec4 box = glsl::gn_paraboloid_bounds(a, b, c, 1.1F);
        for (int j = 0; j < 50; ++j) {
            float s = uniform(direction.random);
            float t = uniform(direction.random);
            if (s + t > 1) {
                s = 1 - s;
                t = 1 - t;
            }
            const vec2 u = glsl::gn_paraboloid(a + s * (b - a) + t * (c - a));
            if (std::max(std::abs(u.x), std::abs(u.y)) < 1.1F) {
                ++asked;
                ASSERT_TRUE(u.x >= box.x && u.x <= box.z && u.y >= box.y && u.y <= box.w)
                    << "triangle " << i << " u = " << u.x << ", " << u.y;
            }
        }
        if (size < 1 && std::min({a.z, b.z, c.z}) > 0) {
            ++small;
            EXPECT_LT(std::max(box.z - box.x, box.w - box.y), 0.2F) << "triangle " << i;
        }
    }
    EXPECT_GT(asked, 50000);
    EXPECT_GT(small, 500);
}

/// A texel's ray meets the triangle where it does, and neighbours leave no gap.
TEST(Paraboloid, HitIsThePointOnTheTriangle) {
    Directions direction;
    std::uniform_real_distribution<float> uniform(0, 1);
    for (int i = 0; i < 2000; ++i) {
        const vec3 a = 3.0F * direction();
        const vec3 b = 3.0F * direction();
        const vec3 c = 3.0F * direction();
        const float s = uniform(direction.random);
        const float t = (1 - s) * uniform(direction.random);
        const vec3 p = a + s * (b - a) + t * (c - a);
        if (p.z < -0.8F * glm::length(p) || std::abs(glm::dot(a, glm::cross(b, c))) < 2) {
            continue;
        }
        const vec2 u = glsl::gn_paraboloid(p);
        const vec4 hit = glsl::gn_paraboloid_hit(u, a, b, c);
        EXPECT_NEAR(hit.w, glm::length(p), 1e-3F) << i;
        EXPECT_LT(glm::length(hit.x * a + hit.y * b + hit.z * c - p), 2e-3F) << i;
        // On the common edge of two triangles one of both is hit.
        const vec2 on_edge = glsl::gn_paraboloid(a + s * (b - a));
        const bool first = glsl::gn_paraboloid_hit(on_edge, a, b, c).w > 0;
        const bool second = glsl::gn_paraboloid_hit(on_edge, b, a, a + b - c).w > 0;
        const float apart = glm::dot(glm::cross(a, b), c) * glm::dot(glm::cross(a, b), a + b - c);
        EXPECT_TRUE(apart > 0 || first || second) << i;
    }
}

const GnBias no_bias{.constant = 0, .slope = 0, .normal = 0, .receiver_plane = 1, .cone = 0};

TEST(Paraboloid, SlopeIsTheChangeOfTheHit) {
    // Against differences over 2^-7 on either side, which err by a sixth of the third derivative times that squared.
    std::mt19937 random(23);
    std::uniform_real_distribution<float> uniform(-1, 1);
    constexpr float step = 1.0F / 128;
    int compared = 0;
    for (int i = 0; i < 4000; ++i) {
        const auto corner = [&] { return vec3(3 * uniform(random), 3 * uniform(random), 2 + uniform(random)); };
        const vec3 a = corner(), b = corner(), c = corner();
        const vec2 u = glsl::gn_paraboloid((a + b + c) / 3.0F);
        const auto at = [&](float x, float y) { return glsl::gn_paraboloid_hit(u + vec2(x, y), a, b, c).w; };
        const std::array<float, 4> around{at(-step, 0), at(step, 0), at(0, -step), at(0, step)};
        const float steepest = std::max(std::abs(around[1] - around[0]), std::abs(around[3] - around[2]));
        // Planes that are seen edge-on bend too fast for differences.
        if (*std::min_element(around.begin(), around.end()) > 0 && steepest < 0.1F) {
            const vec2 slope = glsl::gn_paraboloid_slope(u, a, b, c);
            EXPECT_NEAR(slope.x, (around[1] - around[0]) / (2 * step), 0.02F) << i;
            EXPECT_NEAR(slope.y, (around[3] - around[2]) / (2 * step), 0.02F) << i;
            ++compared;
        }
    }
    EXPECT_GT(compared, 300);
}

TEST(Paraboloid, DepthOfThePlaneIsExact) {
    const GnLightView view = some_view();
    const vec3 eye_ws(view.eye_ws);
    Directions direction;
    for (int i = 0; i < 500; ++i) {
        glsl::GnReceiver receiver{};
        receiver.p_ws = eye_ws + 4.0F * glm::normalize(vec3(view.depth_from_ws)) + 2.0F * direction();
        receiver.n_ws = direction();
        const auto projected = glsl::gn_project(receiver, view, no_bias);
        if (std::abs(glm::dot(receiver.n_ws, glsl::gn_to_eye(view, receiver.p_ws))) < 0.2F) {
            continue;
        }
        vec3 x;
        vec3 y;
        complete_frame(receiver.n_ws, x, y);
        glsl::GnReceiver other = receiver;
        other.p_ws += 0.4F * x + 0.3F * y;
        const auto there = glsl::gn_project(other, view, no_bias);
        EXPECT_NEAR(glsl::gn_depth_at(projected, there.uv_ts, no_bias), there.depth, 5e-6F) << i;
        // And in the form without a division: lit exactly where the occluder is farther.
        for (const float gap : {-1e-4F, 1e-4F}) {
            const auto lit =
                glsl::gn_lit_at(projected, vec4(there.uv_ts.x), vec4(there.uv_ts.y), vec4(there.depth + gap), no_bias);
            EXPECT_EQ(lit.x, gap > 0) << i;
        }
    }
}

TEST(Paraboloid, TexelSizeIsTheWorldLengthOfATexel) {
    const GnLightView view = some_view();
    Directions direction;
    for (int i = 0; i < 200; ++i) {
        glsl::GnReceiver receiver{};
        receiver.p_ws = vec3(view.eye_ws) + 5.0F * direction();
        receiver.n_ws = glsl::gn_to_eye(view, receiver.p_ws);
        const auto projected = glsl::gn_project(receiver, view, no_bias);
        if (!projected.inside) {
            continue;
        }
        glsl::GnReceiver moved = receiver;
        const float step = 0.01F;
        moved.p_ws += step * glm::normalize(projected.du_ws);
        const auto there = glsl::gn_project(moved, view, no_bias);
        EXPECT_NEAR((there.uv_ts.x - projected.uv_ts.x) / step, glm::length(projected.du_ws),
                    0.01F * glm::length(projected.du_ws));
        // Angles are kept, so that texels are square.
        EXPECT_NEAR(glm::length(projected.du_ws), glm::length(projected.dv_ws), 1e-4F * glm::length(projected.du_ws));
        EXPECT_NEAR(glm::dot(projected.du_ws, receiver.n_ws), 0, 1e-4F * glm::length(projected.du_ws));
    }
}

TEST(Paraboloid, BothHemispheresHoldTheirKernels) {
    const Scene scene = load_scene("contact:light=point");
    const Recipe recipe = load_recipe("pcf,pcf.size=9,placement=paraboloid,resolution=256");
    const LightViews views = test::place(scene, "pcf,pcf.size=9,placement=paraboloid,resolution=256");
    ASSERT_EQ(views.views.size(), 2U);
    const float guard = guard_of(recipe, {}, {}).texels / 256;
    Directions direction;
    for (int i = 0; i < 2000; ++i) {
        const vec3 d_ws = direction();
        const GnLightView& view =
            views.views[glm::dot(d_ws, vec3(views.data_as<GnParaboloidData>().axis_ws)) < 0 ? 1 : 0];
        glsl::GnReceiver receiver{};
        receiver.p_ws = vec3(view.eye_ws) + 4.0F * d_ws;
        receiver.n_ws = -d_ws;
        const auto projected = glsl::gn_project(receiver, view, no_bias);
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_GE(projected.uv_ts[axis], guard - 1e-4F);
            EXPECT_LE(projected.uv_ts[axis], 1 - guard + 1e-4F);
        }
    }
}

/// Floors of two large triangles, across the border of both hemispheres: as right as a cube's maps, at texels that are
/// nowhere much coarser than a cube's in its corners.
TEST(Paraboloid, AsRightAsACube) {
    for (const char* scene : {"contact:light=point", "overlap:light=point,hard=1", "duel:light=point"}) {
        const auto cube = test::compare(scene, "hard,placement=cube,resolution=512");
        const auto mirror = test::compare(scene, "hard,placement=paraboloid,resolution=2048");
        EXPECT_LE(*mirror.errors.mismatch, *cube.errors.mismatch) << scene;
    }
}

TEST(Paraboloid, NoAcneWithTheDefaultBias) {
    for (const char* scene : {"tilted:light=point", "tilted:light=point,angle=80", "tilted:light=spot,angle=60"}) {
        for (const char* recipe : {"hard", "pcf,pcf.size=7"}) {
            const auto c = test::compare(scene, fmt::format("{},placement=paraboloid", recipe));
            EXPECT_LE(*c.errors.acne, 1e-3) << scene << " " << recipe;
        }
    }
}

/// Culling by facing means the same as in any other view.
TEST(Paraboloid, FacesOfCastersAreThoseOfACube) {
    for (const char* casters : {"front", "back"}) {
        const auto cube =
            test::compare("contact:light=point", fmt::format("hard,placement=cube,resolution=512,casters={}", casters));
        const auto mirror = test::compare("contact:light=point",
                                          fmt::format("hard,placement=paraboloid,resolution=1024,casters={}", casters));
        EXPECT_NEAR(*mirror.errors.mismatch, *cube.errors.mismatch, 0.01) << casters;
    }
}

}  // namespace
}  // namespace gn::paraboloid_test
