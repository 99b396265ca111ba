// SPDX-License-Identifier: MIT
// The texels that triangles touch, against clipping them exactly to each texel's square; lists per texel hold exactly what
// was added, and what has no room is counted.
#include "shadow/casters/conservative.h"

#include "shadow/casters/conservative.glsl"
#include "shadow/casters/texel_lists.h"
#include "shadow/frame/history.h"
#include "tests/rig.h"

#include <algorithm>
#include <random>

namespace gn::conservative_test {
namespace {

constexpr int side = 40;

/// What of a polygon of homogeneous places (x w, y w, w) lies where dot(plane, p) >= 0.
std::vector<dvec3> cut(const std::vector<dvec3>& polygon, dvec3 plane) {
    std::vector<dvec3> rest;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3& a = polygon[i];
        const dvec3& b = polygon[(i + 1) % polygon.size()];
        const double at_a = glm::dot(plane, a);
        const double at_b = glm::dot(plane, b);
        if (at_a >= 0) {
            rest.push_back(a);
        }
        if ((at_a >= 0) != (at_b >= 0)) {
            rest.push_back(a + (b - a) * (at_a / (at_a - at_b)));
        }
    }
    return rest;
}

/// The area of a triangle within the texel's square, grown by `more` on every side.
double area_within(const std::array<dvec3, 3>& triangle, int x, int y, double more) {
    std::vector<dvec3> polygon(triangle.begin(), triangle.end());
    polygon = cut(polygon, dvec3(0, 0, 1) - dvec3(0, 0, 1e-12));
    for (const dvec3& plane :
         {dvec3(1, 0, more - x), dvec3(-1, 0, x + 1 + more), dvec3(0, 1, more - y), dvec3(0, -1, y + 1 + more)}) {
        polygon = cut(polygon, plane);
    }
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3& a = polygon[i];
        const dvec3& b = polygon[(i + 1) % polygon.size()];
        twice += a.z > 0 && b.z > 0 ? (a.x * b.y - a.y * b.x) / (a.z * b.z) : 0.0;
    }
    return 0.5 * std::abs(twice);
}

bool before_the_eye(const std::array<dvec3, 3>& t) {
    return t[0].z > 1e-3 && t[1].z > 1e-3 && t[2].z > 1e-3;
}

/// Of slivers that rounding may leave out or in, nothing is asked; of triangles through the eye's plane no more than cover.
void expect_touched(const std::array<dvec3, 3>& triangle, int x, int y, bool touched, int& asked) {
    if (area_within(triangle, x, y, 0) > 1e-6) {
        EXPECT_TRUE(touched) << "texel " << x << ", " << y;
        ++asked;
    } else if (before_the_eye(triangle) && area_within(triangle, x, y, 0.01) == 0) {
        EXPECT_FALSE(touched) << "texel " << x << ", " << y;
        ++asked;
    }
}

TEST(Conservative, CoversExactlyTheTexelsThatATriangleTouches) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-10, side + 10);
    std::uniform_real_distribution<float> depth(-0.5F, 2);
    std::uniform_real_distribution<float> tiny(-0.3F, 0.3F);
    int asked = 0;
    for (int round = 0; round < 300; ++round) {
        // Triangles of all sizes, a third of them smaller than a texel, a third perspective and partly behind the eye.
        std::array<vec3, 3> t;
        const vec2 middle(place(random), place(random));
        for (vec3& corner : t) {
            const float w = round % 3 == 2 ? depth(random) : 1.0F;
            const vec2 at =
                round % 3 == 0 ? middle + vec2(tiny(random), tiny(random)) : vec2(place(random), place(random));
            corner = vec3(at * w, w);
        }
        const auto edges = glsl::gn_texel_edges(t[0], t[1], t[2], ivec4(0, 0, side, side));
        const std::array<dvec3, 3> exact{t[0], t[1], t[2]};
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                expect_touched(exact, x, y, glsl::gn_touches(edges, ivec2(x, y)), asked);
            }
        }
    }
    EXPECT_GT(asked, 200000);
}

/// Triangles around a light and below it, two objects.
Scene soup(uint light_kind) {
    Scene scene;
    scene.materials.emplace_back();
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-5, 5);
    std::uniform_real_distribution<float> height(0, 9);
    for (uint i = 0; i < 30; ++i) {
        const float size = i % 2 == 0 ? 1.0F : 0.05F;
        const vec3 middle(place(random), height(random), place(random));
        for (int corner = 0; corner < 3; ++corner) {
            scene.positions_ws.push_back(middle + size * vec3(place(random), place(random), place(random)));
            scene.normals_ws.emplace_back(0, 1, 0);
            scene.uvs.emplace_back(0);
        }
        scene.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    scene.objects.push_back({"a", 0, 12, 0, Box{vec3(-10), vec3(15)}});
    scene.objects.push_back({"b", 12, 18, 0, Box{vec3(-10), vec3(15)}});
    Light light{"light", {}};
    light.shape.kind = light_kind;
    light.shape.position_ws = vec4(0.1F, 8, 0.2F, 1);
    light.shape.direction_ws = vec4(glm::normalize(vec3(0.1F, -1, 0.05F)), 0);
    light.shape.cos_outer = 0.6F;
    scene.lights.push_back(light);
    scene.cameras.push_back({.position_ws = vec3(0, 12, 14), .forward_ws = glm::normalize(vec3(0, -12, -14))});
    finish_scene(scene);
    return scene;
}

struct Listed {
    GnLightView view;
    std::uint32_t capacity = 0, used = 0, stored = 0;
    std::vector<std::vector<std::uint32_t>> triangles;  ///< of each texel, ascending
    std::set<std::string> remarks;
};

/// The triangles that touch each texel of the first view, as lists of so much room hold them.
Listed list(const Scene& scene, std::uint32_t capacity, History* history = nullptr) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    FrameGraph graph(test::device());
    const SceneHandles handles = import_scene(graph, gpu);
    const ViewSamples samples{.width = 64, .height = 64, .camera = scene.cameras[0]};
    Listed result;
    const FrameInput input{test::device(),      graph, scene,   handles,        samples,
                           scene.lights.data(), 0,     history, &result.remarks};
    const Recipe recipe = load_recipe(fmt::format("hard,placement=single,resolution={}", side));
    const LightViews views = recipe.placement->place(input, recipe);
    result.view = views.views[0];
    const TexelLists lists = add_texel_lists(input, "triangles", uvec3(side, side, 1), capacity);
    result.capacity = lists.capacity;
    ConservativePass pass;
    pass.color = graph.create({.name = "touched", .format = VK_FORMAT_R8_UNORM, .width = side, .height = side});
    add_lists(pass.inputs, lists, ListAccess::add);
    pass.functions = list_functions(ListAccess::add);
    pass.body = "gn_list_add(texel, triangle);";
    add_conservative_passes(input, views, pass);
    graph.keep(pass.color);

    // Read as a shader does.
    constexpr std::uint32_t most = 64;
    const BufferHandle read =
        graph.create(BufferDesc{.name = "read", .bytes = std::size_t{side} * side * most * sizeof(std::uint32_t)});
    ShaderInputs inputs;
    add_lists(inputs, lists, ListAccess::read);
    inputs.buffer("writeonly buffer", "Read", "uint values[];", read);
    const std::string text = inputs.text() + list_functions(ListAccess::read) +
                             fmt::format(R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {{
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    uint at = uint(texel.y * {0} + texel.x) * {1}u;
    uint count = 0u;
    for (uint node = gn_list_first(ivec3(texel, 0)); node != 0u && count < {1}u - 1u; node = gn_list_next(node)) {{
        values[at + 1u + count] = gn_list_value(node);
        ++count;
    }}
    values[at] = count;
}}
)",
                                         side, most);
    graph.add_pass(
        "read", [&](PassBuilder& builder) { inputs.declare(builder); },
        [inputs, text](Recorder& r) {
            r.bind(ComputeDesc{{ShaderKind::compute, "read", text}, {}});
            inputs.set(r);
            r.dispatch_pixels(side, side);
        });
    graph.keep(read);
    graph.keep(lists.used);
    graph.execute(false);
    std::vector<std::uint32_t> values(std::size_t{side} * side * most);
    std::memcpy(values.data(), graph.download(read).data(), values.size() * sizeof(std::uint32_t));
    std::memcpy(&result.used, graph.download(lists.used).data(), sizeof result.used);
    for (std::size_t i = 0; i < std::size_t{side} * side; ++i) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(i * most);
        result.triangles.emplace_back(first + 1, first + 1 + *first);
        std::sort(result.triangles.back().begin(), result.triangles.back().end());
        result.stored += *first;
    }
    return result;
}

TEST(ConservativeRendered, ListsHoldTheTrianglesThatTouchTheirTexelsOnceEach) {
    for (const uint kind : {GN_LIGHT_DIRECTIONAL, GN_LIGHT_SPOT}) {
        const Scene scene = soup(kind);
        const Listed listed = list(scene, 20000);
        EXPECT_EQ(listed.remarks, std::set<std::string>{});
        EXPECT_EQ(listed.used, listed.stored);
        int asked = 0;
        for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
            std::array<dvec3, 3> exact;
            for (int corner = 0; corner < 3; ++corner) {
                const vec3 p_ws = scene.positions_ws[scene.triangles[i][corner]];
                const dvec4 p_cs = dmat4(listed.view.cs_from_ws) * dvec4(p_ws, 1);
                exact.at(static_cast<std::size_t>(corner)) =
                    dvec3(0.5 * side * (p_cs.x + p_cs.w), 0.5 * side * (p_cs.y + p_cs.w), p_cs.w);
            }
            for (int y = 0; y < side; ++y) {
                for (int x = 0; x < side; ++x) {
                    const auto& found = listed.triangles[static_cast<std::size_t>(y * side + x)];
                    const auto times = std::count(found.begin(), found.end(), i);
                    EXPECT_LE(times, 1);
                    expect_touched(exact, x, y, times > 0, asked);
                }
            }
        }
        EXPECT_GT(asked, 20000);
    }
}

TEST(TexelListsRendered, CountWhatHasNoRoomAndHaveRoomInTheNextFrame) {
    const Scene scene = soup(GN_LIGHT_DIRECTIONAL);
    const Listed whole = list(scene, 20000);
    const Listed alone = list(scene, 100);
    EXPECT_EQ(alone.used, whole.used);
    EXPECT_EQ(alone.stored, 100U);
    ASSERT_EQ(alone.remarks.size(), 1U);
    EXPECT_NE(alone.remarks.begin()->find(fmt::format("{} are left out", whole.used - 100)), std::string::npos)
        << *alone.remarks.begin();

    History history(test::device());
    const Listed first = list(scene, 100, &history);
    EXPECT_EQ(first.stored, 100U);
    EXPECT_EQ(first.remarks.size(), 1U);
    history.advance();
    const Listed second = list(scene, 100, &history);
    EXPECT_GE(second.capacity, whole.used);
    EXPECT_EQ(second.triangles, whole.triangles);
    EXPECT_EQ(second.remarks, std::set<std::string>{});
}

TEST(TexelListsRendered, AreNoLargerThanAStorageBlock) {
    const Listed lists = list(soup(GN_LIGHT_DIRECTIONAL), 0xFFFFFFFF);
    EXPECT_LE(std::uint64_t{lists.capacity} * sizeof(uvec2), test::device().properties().limits.maxStorageBufferRange);
    EXPECT_GT(lists.stored, 100U);
    EXPECT_EQ(lists.remarks, std::set<std::string>{});
}

}  // namespace
}  // namespace gn::conservative_test
