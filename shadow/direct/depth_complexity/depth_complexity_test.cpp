// SPDX-License-Identifier: MIT
// Depth complexity from edges against rays, one triangle after the other, and V against the traced points.
#include "shadow/direct/depth_complexity/depth_complexity.glsl"

#include "scenes/analytic.h"
#include "shadow/geometry/edges.h"
#include "shadow/scene/light_samples.h"
#include "tests/direct_scenes.h"
#include "tests/panels.h"

#include <gtest/gtest.h>

#include <random>

namespace gn::depth_complexity_test {
namespace {

using namespace by_hand;
using namespace glsl;

/// How many triangles that count lie between p and a point of the light (w = 0: a direction); nothing where rounding decides.
std::optional<int> hits(const Scene& scene, uint form, dvec3 p, dvec4 light) {
    const dvec3 way = dvec3(light) - p * light.w;
    int count = 0;
    for (const uvec3& t : scene.triangles) {
        const dvec3 a = dvec3(scene.positions_ws[t.x]) - p;
        const dvec3 b = dvec3(scene.positions_ws[t.y]) - p;
        const dvec3 c = dvec3(scene.positions_ws[t.z]) - p;
        const dvec3 n = glm::normalize(glm::cross(b - a, c - a));
        const double towards = glm::dot(n, way);
        const double at = glm::dot(n, a) / towards;
        dvec3 shares(glm::dot(way, glm::normalize(glm::cross(b, c))), glm::dot(way, glm::normalize(glm::cross(c, a))),
                     glm::dot(way, glm::normalize(glm::cross(a, b))));
        shares *= (towards > 0 ? 1 : -1) / glm::length(way);
        const double least = std::min({shares.x, shares.y, shares.z});
        const bool counts = form == GN_VOLUMES_ANY || towards > 0;
        if (least < -1e-4 || at < 0 || (light.w > 0 && at > 1) || !counts) {
            continue;
        }
        if (least < 1e-4 || at < 1e-4 || std::abs(towards) < 1e-4 * glm::length(way)) {
            return {};
        }
        ++count;
    }
    return count;
}

/// A point of the light as a receiver sees it: in the square, and in the world.
struct Point {
    vec2 at;
    dvec4 light;
};
std::vector<Point> points_of(const GnLight& light, vec3 p_ws, std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const GnSeenLight seen = gn_seen_light(light, p_ws);
    const dvec3 x = dvec3(seen.x_ws) / glm::dot(dvec3(seen.x_ws), dvec3(seen.x_ws));
    const dvec3 y = dvec3(seen.y_ws) / glm::dot(dvec3(seen.y_ws), dvec3(seen.y_ws));
    std::vector<Point> points;
    while (points.size() < 24) {
        const vec2 at(unit(random), unit(random));
        if (light.kind == GN_LIGHT_RECTANGLE || glm::dot(at, at) < 1) {
            const dvec3 way = dvec3(seen.centre_ws) + x * static_cast<double>(at.x) + y * static_cast<double>(at.y);
            points.push_back({at, light.kind == GN_LIGHT_DIRECTIONAL ? dvec4(way, 0) : dvec4(dvec3(p_ws) + way, 1)});
        }
    }
    return points;
}

std::vector<GnLight> area_lights() {
    GnLight light_of_sky = by_hand::sun({0.4F, -1, -0.3F});
    light_of_sky.angular_radius = 0.2F;
    GnLight disc = by_hand::spot({-1.5F, 5, 1}, {0, 0, 0}, 0.8F);
    disc.radius = 0.8F;
    GnLight sphere = by_hand::point({-1, 4.5F, 1});
    sphere.radius = 0.7F;
    GnLight panel = by_hand::rectangle({-1, 5, 1.5F}, {0, 0, 0});
    panel.half_size = vec2(1.1F, 0.6F);
    GnLight mirrored = panel;
    mirrored.right_ws = -mirrored.right_ws;
    return {light_of_sky, disc, sphere, panel, mirrored};
}

/// Edges of a scene's triangles, and of each triangle how it is drawn.
struct Mesh {
    Scene scene;
    EdgeList list;
    uint form = GN_VOLUMES_ANY;
    Mesh(Scene of, uint given) : scene(std::move(of)), form(given) {
        const std::vector<std::uint8_t> casts(scene.triangles.size(), casts_from_both_sides);
        list = build_edges(scene.positions_ws, scene.triangles, casts);
    }
    [[nodiscard]] std::array<vec3, 3> corners(std::uint32_t t) const {
        const uvec3 i = scene.triangles[t];
        return {scene.positions_ws[i.x], scene.positions_ws[i.y], scene.positions_ws[i.z]};
    }
    [[nodiscard]] int multiplicity(std::uint32_t t, vec3 p_ws, vec3 n_ws) const {
        const auto c = corners(t);
        return gn_depth_multiplicity(c[0], c[1], c[2], 0, form, p_ws, n_ws);
    }
    /// Whether the list of a light's edges has it.
    [[nodiscard]] bool listed(std::size_t edge, const GnLight& light) const {
        const vec2 size = gn_light_half_size(light);
        const bool square = light.kind == GN_LIGHT_RECTANGLE, of_sky = light.kind == GN_LIGHT_DIRECTIONAL;
        const vec4 light_ws = of_sky ? -light.direction_ws : vec4(vec3(light.position_ws), 1);
        const vec3 x = square ? vec3(light.right_ws) * size.x : vec3(0),
                   y = square ? vec3(light.up_ws) * size.y : vec3(0);
        int sum = 0;
        bool cuts = false;
        for (std::uint32_t i = list.first[edge]; i < list.first[edge + 1]; ++i) {
            const auto c = corners(list.around[i] >> 1);
            const int m = gn_volumes_multiplicity(gn_volumes_side(c[0], c[1], c[2], light_ws), static_cast<int>(form));
            sum += (list.around[i] & 1U) != 0 ? -m : m;
            cuts = cuts || gn_depth_cuts_light(c[0], c[1], c[2], light_ws, x, y, gn_depth_radius(light));
        }
        return sum != 0 || cuts;
    }
};

/// Counters of all points at a receiver, by the listed edges; `missed`: edges that add although the list has them not.
std::vector<int> counters_of(const Mesh& mesh, const GnLight& light, vec3 p_ws, vec3 n_ws,
                             const std::vector<Point>& points, int& missed) {
    std::vector<int> counters(points.size(), 0);
    const GnSeenLight seen = gn_seen_light(light, p_ws);
    for (std::size_t e = 0; e < mesh.list.edges.size(); ++e) {
        const vec3 from_a = mesh.scene.positions_ws[mesh.list.edges[e].x] - p_ws;
        const vec3 from_b = mesh.scene.positions_ws[mesh.list.edges[e].y] - p_ws;
        vec2 a, b;
        if (!gn_depth_edge(seen, light.kind == GN_LIGHT_DIRECTIONAL, from_a, from_b, a, b)) {
            continue;
        }
        int winding = 0;
        for (std::uint32_t i = mesh.list.first[e]; i < mesh.list.first[e + 1]; ++i) {
            const int m = mesh.multiplicity(mesh.list.around[i] >> 1, p_ws, n_ws);
            winding += (mesh.list.around[i] & 1U) != 0 ? -m : m;
        }
        // What adds the same to all points may be missed: it passes the light by.
        const int turned = winding * gn_depth_turn(seen), all = turned * gn_depth_crossings(a, b, points[0].at);
        bool differs = false;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const int added = turned * gn_depth_crossings(a, b, points[i].at);
            counters[i] += added;
            differs = differs || added != all;
        }
        missed += differs && !mesh.listed(e, light) ? 1 : 0;
    }
    return counters;
}

TEST(DepthComplexityLaws, EdgesCountTheSurfacesThatRaysMeetUpToOneConstant) {
    SceneBuilder solids, sheets;
    solids.box({-1, 0.5F, -1}, {0.2F, 1.4F, 0.3F})
        .torus({0.6F, 1.2F, 0}, 0.8F, 0.3F, 10)
        .torus({0, 2, 0}, 0.5F, 0.2F, 9);
    sheets.soup({{-2, 0.3F, -2}, {2, 2.8F, 2}}, 1.2F, 60, 4);
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::size_t judged = 0, differing = 0;
    int missed = 0;
    for (const Mesh& mesh : {Mesh(solids.scene(), GN_VOLUMES_FRONT), Mesh(sheets.scene(), GN_VOLUMES_ANY)}) {
        for (const GnLight& light : area_lights()) {
            for (int round = 0; round < 40; ++round) {
                const vec3 p_ws(2.5F * unit(random), 0.2F * unit(random), 2.5F * unit(random));
                // A surface that the light stands over in part: points below it show it nothing.
                const vec3 tilt(unit(random), unit(random), unit(random));
                const vec3 n_ws = glm::normalize(gn_to_light(light, p_ws) + 0.9F * tilt);
                const std::vector<Point> points = points_of(light, p_ws, random);
                const std::vector<int> counters = counters_of(mesh, light, p_ws, n_ws, points, missed);
                std::optional<int> constant;
                for (std::size_t i = 0; i < points.size(); ++i) {
                    const dvec3 way = dvec3(points[i].light) - dvec3(p_ws) * points[i].light.w;
                    if (glm::dot(way, dvec3(n_ws)) < 0) {
                        continue;
                    }
                    if (const auto met = hits(mesh.scene, mesh.form, dvec3(p_ws), points[i].light)) {
                        constant = constant.value_or(*met - counters[i]);
                        ASSERT_EQ(counters[i] + *constant, *met)
                            << "light " << light.kind << ", round " << round << ", point " << i;
                        ++judged;
                        differing += counters[i] != counters[0] ? 1 : 0;
                    }
                }
            }
        }
    }
    EXPECT_EQ(missed, 0) << "edges that sample and light see as silhouettes are not listed";
    EXPECT_GT(judged, 8000U);
    EXPECT_GT(differing, 1500U);
}

TEST(DepthComplexityLaws, ALoopWindsAroundAPointHoweverFarItsCornersAre) {
    // Of loops of three edges every other one has an edge through the corner of the point's way, to the last bit.
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::uniform_int_distribution<int> step(-8, 8), doublings(0, 17), row(-63, 63);
    int judged = 0, around = 0, wrong = 0;
    for (int round = 0; round < 40000; ++round) {
        const vec2 q(0.999F * unit(random), static_cast<float>(row(random)) / 64);
        const auto far = [&] {
            return std::exp2(static_cast<float>(doublings(random))) * vec2(unit(random), unit(random));
        };
        std::array<vec2, 3> corners{far(), far(), far()};
        if (round % 2 == 0) {
            const vec2 along(static_cast<float>(step(random)), static_cast<float>(step(random)));
            corners[0] = vec2(1, q.y) + std::exp2(static_cast<float>(doublings(random))) * along;
            corners[1] = vec2(1, q.y) - along / 4.0F;
        }
        int sum = 0;
        bool sure = true;
        int left = 0, right = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const vec2 a = corners.at(k), b = corners.at((k + 1) % 3);
            sum += gn_depth_crossings(a, b, q);
            const dvec2 d = dvec2(b) - dvec2(a), to_q = dvec2(q) - dvec2(a);
            const double side = (d.x * to_q.y - d.y * to_q.x) / glm::length(d);
            ++(side > 0 ? left : right);
            sure = sure && std::abs(side) > 4e-7 * (2 + std::min(glm::length(dvec2(a)), glm::length(dvec2(b))));
        }
        if (sure) {
            const int winding = left == 3 ? 1 : right == 3 ? -1 : 0;
            ++judged;
            around += winding != 0 ? 1 : 0;
            wrong += sum != winding ? 1 : 0;
        }
    }
    EXPECT_EQ(wrong, 0) << "of " << judged;
    EXPECT_GT(judged, 30000);
    EXPECT_GT(around, 3000);
}

TEST(DepthComplexityLaws, CountersOfAWordAddWhateverTheyHoldInBetween) {
    std::mt19937 random(2);
    for (const uint bits : {8U, 16U}) {
        const uint fields = 32 / bits;
        const int half = 1 << (bits - 1);
        for (int round = 0; round < 200; ++round) {
            // Numbers within the range, reached by steps that leave it again and again.
            std::vector<int> wanted, sum(fields, 0);
            uint word = 0;
            for (uint i = 0; i < fields; ++i) {
                wanted.push_back(std::uniform_int_distribution<int>(-half, half - 1)(random));
            }
            for (int step = 0; step < 300; ++step) {
                const uint i = static_cast<uint>(step) % fields;
                const int by = std::uniform_int_distribution<int>(-half, half)(random);
                sum[i] += by;
                word += gn_depth_packed(by, i, bits);
            }
            for (uint i = 0; i < fields; ++i) {
                word += gn_depth_packed(wanted[i] - sum[i], i, bits);
            }
            for (uint i = 0; i < fields; ++i) {
                ASSERT_EQ(gn_depth_unpacked(word, i, bits), wanted[i]) << bits << " bits, counter " << i;
            }
        }
    }
}

TEST(DepthComplexityLaws, TwoOfThreePointsDecideAndNoPointHasFewerSurfacesThanNone) {
    EXPECT_EQ(gn_depth_constant({2, 2, 5}, 0), 2);
    EXPECT_EQ(gn_depth_constant({2, 5, 2}, 0), 2);
    EXPECT_EQ(gn_depth_constant({5, 2, 2}, 0), 2);
    EXPECT_EQ(gn_depth_constant({2, 0, 1}, 0), 2) << "one vote";
    EXPECT_EQ(gn_depth_constant({2, 0, 1}, -3), 3);
}

/// A solid, turned and displaced so that its walls are known to rounding alone, and a board before one of them. The light is a panel
/// that the wall's plane cuts, or nearly does.
struct GrazedWall {
    Scene both, board;
    vec3 p_ws, n_ws;
    GnLight light;
};
GrazedWall grazed_wall(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto any = [&] { return vec3(unit(random), unit(random), unit(random)); };
    const vec3 x = glm::normalize(any()), y = glm::normalize(glm::cross(x, any())), origin_ws = 6.0F * any();
    const mat3 turn(x, y, glm::cross(x, y));
    const vec3 low(1.05F + 0.1F * unit(random), 1.6F, -0.4F + 0.3F * unit(random));
    SceneBuilder solid, board;
    solid.box({-1, -1, -1}, {1, 1, 1}).box(low, low + vec3(0.5F, 0.1F, 0.8F));
    board.box(low, low + vec3(0.5F, 0.1F, 0.8F));
    GrazedWall wall{.both = solid.scene(), .board = board.scene(), .p_ws = {}, .n_ws = turn[0], .light = {}};
    for (Scene* scene : {&wall.both, &wall.board}) {
        for (vec3& corner_ws : scene->positions_ws) {
            corner_ws = origin_ws + turn * corner_ws;
        }
    }
    const float across = 0.7F * unit(random);
    wall.p_ws = origin_ws + turn * vec3(1, 0.7F * unit(random), across);
    wall.light = rectangle(origin_ws + turn * vec3(1.1F + 0.25F * unit(random), 6, across),
                           origin_ws + turn * vec3(1, 0, across));
    wall.light.half_size = vec2(0.5F);
    return wall;
}

/// Points of the light; every other one is moved until it stands above the wall's horizon by rounding.
std::vector<Point> points_at_horizon(const GrazedWall& wall, std::mt19937& random) {
    std::uniform_real_distribution<double> power(-7.5, -5);
    const GnSeenLight seen = gn_seen_light(wall.light, wall.p_ws);
    const dvec3 x = dvec3(seen.x_ws) / glm::dot(dvec3(seen.x_ws), dvec3(seen.x_ws));
    const dvec3 y = dvec3(seen.y_ws) / glm::dot(dvec3(seen.y_ws), dvec3(seen.y_ws));
    const dvec3 n(wall.n_ws), p_ws(wall.p_ws);
    std::vector<Point> points = points_of(wall.light, wall.p_ws, random);
    for (std::size_t i = 0; i < points.size(); i += 2) {
        dvec2 at(points[i].at);
        const double height = std::pow(10.0, power(random)) * glm::length(dvec3(seen.centre_ws));
        const bool along_x = std::abs(glm::dot(n, x)) > std::abs(glm::dot(n, y));
        const double lacks = height - glm::dot(n, dvec3(seen.centre_ws) + x * at.x + y * at.y);
        (along_x ? at.x : at.y) += lacks / glm::dot(n, along_x ? x : y);
        if (std::max(std::abs(at.x), std::abs(at.y)) < 1) {
            points[i].at = vec2(at);
            points[i].light = dvec4(p_ws + dvec3(seen.centre_ws) + x * at.x + y * at.y, 1);
        }
    }
    return points;
}

TEST(DepthComplexityLaws, OnAGrazedWallReferencesBelowTheHorizonAreNotHeard) {
    std::mt19937 random(7);
    int judged = 0, wrong = 0, low_references = 0, missed = 0;
    for (int round = 0; round < 2000; ++round) {
        const GrazedWall wall = grazed_wall(random);
        const Mesh mesh(wall.both, GN_VOLUMES_FRONT);
        std::vector<Point> points = points_at_horizon(wall, random);
        const std::size_t samples = points.size();
        const GnSeenLight seen = gn_seen_light(wall.light, wall.p_ws);
        const vec3 x_ws = seen.x_ws / glm::dot(seen.x_ws, seen.x_ws), y_ws = seen.y_ws / glm::dot(seen.y_ws, seen.y_ws);
        for (const vec2 at : {vec2(0.42F, 0.15F), vec2(-0.34F, 0.29F), vec2(-0.08F, -0.44F)}) {
            points.push_back({at, dvec4(dvec3(wall.p_ws + seen.centre_ws + x_ws * at.x + y_ws * at.y), 1)});
        }
        const std::vector<int> counters = counters_of(mesh, wall.light, wall.p_ws, wall.n_ws, points, missed);

        // Volumes of the references: those below the wall's horizon are held by the solid too, or not, as rounding has it.
        ivec3 votes;
        vec3 heights;
        bool sure = true;
        for (int i = 0; i < 3; ++i) {
            const Point& point = points[samples + static_cast<std::size_t>(i)];
            const auto met = hits(wall.board, GN_VOLUMES_FRONT, dvec3(wall.p_ws), point.light);
            heights[i] = glm::dot(wall.n_ws, vec3(dvec3(point.light) - dvec3(wall.p_ws)));
            votes[i] = met.value_or(0) + (heights[i] < 1e-3F ? round % 2 : 0) -
                       counters[samples + static_cast<std::size_t>(i)];
            sure = sure && met.has_value();
            low_references += heights[i] < 1e-3F ? 1 : 0;
        }
        int least = 1 << 30;
        std::vector<float> above;
        for (std::size_t i = 0; i < samples; ++i) {
            above.push_back(glm::dot(wall.n_ws, seen.centre_ws + x_ws * points[i].at.x + y_ws * points[i].at.y));
            least = above[i] > 0 ? std::min(least, counters[i]) : least;
        }
        if (!sure || std::max({heights.x, heights.y, heights.z}) < 0.05F) {
            continue;
        }
        const int constant = gn_depth_constant(gn_depth_heard(votes, heights), least);

        // What stands clear of the horizon is hidden as rays say.
        for (std::size_t i = 0; i < samples; ++i) {
            const auto met = hits(wall.board, GN_VOLUMES_FRONT, dvec3(wall.p_ws), points[i].light);
            if (above[i] > 1e-3F && met) {
                ++judged;
                wrong += (counters[i] + constant <= 0) != (*met == 0) ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(wrong, 0) << "of " << judged;
    EXPECT_GT(judged, 10000);
    EXPECT_GT(low_references, 200);
}

/// Solids, a ring, boards one before the other, loose triangles and a leaf with holes over a ground.
SceneBuilder crowded_garden() {
    SceneBuilder b;
    Texture holes{.name = "holes",
                  .image = {2, 2, {255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 0, 255, 255, 255, 255}}};
    const int leaf = b.material({.name = "leaf", .alpha_mode = AlphaMode::mask}, &holes);
    b.ground(10).box({-1, 0, -1}, {0, 0.9F, 0.2F}).box({-0.8F, 1.2F, -1}, {0.3F, 1.4F, 0.4F});
    b.torus({1.2F, 0.8F, 0}, 0.6F, 0.2F, 10).soup({{-2, 0.3F, 0.6F}, {2, 1.6F, 2}}, 0.7F, 16, 4);
    b.quad({-2, 1.1F, -2}, {-0.6F, 1.2F, -2}, {-0.6F, 1.2F, -0.8F}, {-2, 1.1F, -0.8F}, leaf);
    b.camera({3, 4, 4}, {0, 0.3F, 0});
    return b;
}

struct Difference {
    std::size_t judged = 0, penumbra = 0;
    std::size_t one = 0;   ///< samples that differ by one point
    std::size_t more = 0;  ///< and by more
    double worst = 0;
    std::string first;  ///< of those
};
Difference from_traced_points(const Scene& scene, const std::string& recipe, int samples) {
    const test::ValidationGuard guard;
    constexpr uint width = 80, height = 60;
    SceneGpu gpu = upload_scene(device(), scene);
    const FrameResult frame = render_frame(device(), gpu, scene.cameras.front(), load_recipe(recipe),
                                           {.width = width, .height = height, .picture = false});
    EXPECT_EQ(frame.refused.front(), "");
    const LightSamples points = light_samples(scene.lights.front().shape, samples);
    const TruthResult truth = Truth(scene).trace(frame.samples.position_ws, frame.samples.normal_ws,
                                                 scene.lights.front(), {.exactly = &points, .width = width});
    Difference d;
    for (std::size_t i = 0; i < truth.visibility.size(); ++i) {
        if (truth.counted[i] != 0) {
            const double off = std::abs(static_cast<double>(truth.visibility[i] - frame.visibility.front().values[i]));
            ++d.judged;
            d.penumbra += truth.visibility[i] > 0 && truth.visibility[i] < 1 ? 1 : 0;
            d.one += off > 1e-4 && off < 1.5 / samples ? 1 : 0;
            if (off > 1.5 / samples && d.more++ == 0) {
                d.first = fmt::format("pixel {} {}: traced {}, counted {}", i % width, i / width, truth.visibility[i],
                                      frame.visibility.front().values[i]);
            }
            d.worst = std::max(d.worst, off);
        }
    }
    return d;
}

TEST(DepthComplexityRendered, EqualsTracingTheSamePoints) {
    for (const GnLight& light : area_lights()) {
        if (light.kind == GN_LIGHT_POINT) {
            continue;  // its points are those of the disc that each sample sees
        }
        const Scene scene = crowded_garden().light(light).scene();
        const Difference d = from_traced_points(scene, "depth-complexity,depth-complexity.samples=16", 16);
        EXPECT_GT(d.judged, 3000U);
        EXPECT_GT(d.penumbra, 400U);
        // A point on an edge to the last bit may be taken either way; the constant by two of three never is.
        EXPECT_LE(d.one, d.judged / 500) << light_kind_names.at(light.kind) << ", the worst " << d.worst;
        EXPECT_EQ(d.more, 0U) << light_kind_names.at(light.kind) << ", " << d.first;
    }
}

TEST(DepthComplexityRendered, APicturesPointsWeighWhatTheySend) {
    const test::ValidationGuard guard;
    Scene scene = crowded_garden().light(area_lights()[3]).scene();
    test::show_picture(scene, test::red_and_blue());
    SceneGpu gpu = upload_scene(device(), scene);
    const FrameResult frame =
        render_frame(device(), gpu, scene.cameras.front(), load_recipe("depth-complexity,depth-complexity.samples=16"),
                     {.width = 96, .height = 72, .picture = false});
    const Image& v = frame.visibility.front();
    ASSERT_EQ(v.channels, 3);
    const test::TracedPicture traced = test::trace_picture(scene, frame.samples, 16);
    std::size_t judged = 0, wrong = 0;
    for (std::size_t i = 0; i < v.pixels(); ++i) {
        const vec3 seen(v.values[3 * i], v.values[3 * i + 1], v.values[3 * i + 2]);
        judged += traced.counted[i];
        wrong += traced.counted[i] != 0 && glm::distance(seen, traced.visibility[i]) > 1e-4F ? 1 : 0;
    }
    EXPECT_GT(traced.coloured, 100);
    EXPECT_LE(wrong, judged / 500) << "points on an edge to the last bit, as of white lights";
}

TEST(DepthComplexityRendered, OneVoteErrsOnHardEdgesAlone) {
    const Scene scene = crowded_garden().light(area_lights()[3]).scene();
    const Difference d =
        from_traced_points(scene, "depth-complexity,depth-complexity.samples=16,depth-complexity.votes=one", 16);
    EXPECT_LE(d.more, 60U) << "one a row, " << d.first;
}

TEST(DepthComplexityRendered, OverlapIsRightWhereSoftVolumesAddUp) {
    const test::ComparisonOptions small{.width = 64, .height = 64, .samples = 16};
    const test::Comparison soft = test::compare("overlap", "soft-volumes", small);
    const test::Comparison counted = test::compare("overlap", "depth-complexity,depth-complexity.samples=64", small);
    // What the sheets hide of the light one by one, as the scene has them.
    const scenes::Sheet low{2, {-14, -14}, {0, 14}}, same{3, {-14, -14}, {0, 0}}, other{3, {0, 0}, {14, 14}};
    const GnLight& light = counted.scene.lights.front().shape;
    std::size_t twice = 0, wrong = 0, judged = 0, unlike = 0;
    double by_counts = 0, by_areas = 0;
    for (std::size_t i = 0; i < soft.truth.visibility.size(); ++i) {
        const dvec3 p_ws(soft.frame.samples.position_ws[i]);
        if (soft.truth.counted[i] == 0 || std::abs(p_ws.y) > 1e-5) {
            continue;
        }
        double sum = 0;
        for (const scenes::Sheet& s : {low, same, other}) {
            sum += 1 - *scenes::sheet_visibility(light, {&s, 1}, p_ws);
        }
        const double v = *counted.scene.closed_form(0, p_ws);
        by_counts += std::pow(v - static_cast<double>(counted.visibility().values[i]), 2);
        by_areas += std::pow(v - static_cast<double>(soft.visibility().values[i]), 2);
        // Away from z = 0 only edges along z cross the light: of 64 points of a (0,2)-sequence each strip of a 64th of the width
        // holds one, so that an edge errs by one point. One shows in front, two behind.
        if (std::abs(p_ws.z) > 0.8) {
            const double allowed = (p_ws.z < 0 ? 1 : 2) / 64.0 + 1e-3;
            wrong += std::abs(v - static_cast<double>(counted.visibility().values[i])) > allowed ? 1 : 0;
            ++judged;
        }
        // Beside all hard shadows soft-volumes take off what each hides, up to everything.
        if (p_ws.x > 0.02 && p_ws.z < -0.02) {
            const double predicted = std::max(1 - sum, 0.0);
            unlike += std::abs(predicted - static_cast<double>(soft.visibility().values[i])) > 1e-3 ? 1 : 0;
            twice += v - predicted > 0.1 ? 1 : 0;
        }
    }
    EXPECT_EQ(unlike, 0U) << "soft-volumes err by the sum";
    EXPECT_GT(twice, 100U) << "where more than a tenth of the light is taken off twice";
    EXPECT_EQ(wrong, 0U) << "of " << judged;
    EXPECT_GT(judged, 300U);
    EXPECT_LT(by_counts, 0.04 * by_areas) << "a fifth of the error";
}

/// Loose triangles between a ground and a wide light: hundreds of edges before each sample.
Scene crowd() {
    SceneBuilder b;
    b.ground(6).soup({{-1, 1, -1}, {1, 2.6F, 1}}, 0.25F, 700, 9).camera({0.4F, 0.6F, 1}, {0, 0, 0});
    GnLight panel = by_hand::rectangle({0, 3.4F, 0}, {0, 0, 0});
    panel.half_size = vec2(1.5F);
    return b.light(panel).scene();
}

TEST(DepthComplexityRendered, CountersThatMayWrapAreSaid) {
    const Scene scene = crowd();
    std::vector<std::string> said;
    std::array<std::vector<float>, 2> v;
    for (const int bits : {8, 16}) {
        const test::ValidationGuard guard;
        SceneGpu gpu = upload_scene(device(), scene);
        const FrameResult frame = render_frame(
            device(), gpu, scene.cameras.front(),
            load_recipe(fmt::format("depth-complexity,depth-complexity.samples=7,depth-complexity.bits={}", bits)),
            {.width = 32, .height = 24, .picture = false});
        std::string all;
        for (const std::string& remark : frame.remarks) {
            all += remark + "\n";
        }
        EXPECT_EQ(all.find("counters of 8 bits are sure to hold 127") != std::string::npos, bits == 8) << all;
        v.at(bits == 8 ? 0 : 1) = frame.visibility.front().values;
    }
    // Here no counter did: its edges begin surfaces as often as they end them.
    EXPECT_EQ(v[0], v[1]);
}

}  // namespace
}  // namespace gn::depth_complexity_test
