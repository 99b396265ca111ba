// SPDX-License-Identifier: MIT
// Pages are as fine as pixels, are drawn where something changed and nowhere else, and where one is missing a coarser one serves.
#include "shadow/placement/virtual/virtual.glsl"

#include "shadow/frame/history.h"
#include "shadow/placement/virtual/virtual_passes.h"
#include "shadow/scene/move.h"
#include "shadow/show/show.h"
#include "tests/direct_scenes.h"
#include "tests/rescaled.h"
#include "tests/rig.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <set>

namespace gn::virtual_test {
namespace {

constexpr uint width = 96, height = 64;

TEST(Virtual, PagesHavePlacesOfTheirOwn) {
    EXPECT_EQ(glsl::gn_virtual_page(glsl::gn_virtual_tag(ivec2(2047, 1031))), ivec2(2047, 1031));
    EXPECT_NE(glsl::gn_virtual_tag(ivec2(0)), 0U);
    std::set<int> slots;
    for (int level = 0; level < 3; ++level) {
        for (int face = 0; face < 6; ++face) {
            for (const ivec2 page : {ivec2(0), ivec2(1, 0), ivec2(0, 1), ivec2(63, 63)}) {
                const int slot = glsl::gn_virtual_slot(6, level, face, page);
                EXPECT_TRUE(slots.insert(slot).second);
                EXPECT_EQ(glsl::gn_virtual_level(6, slot), level);
                EXPECT_EQ(glsl::gn_virtual_face(6, slot), face);
                EXPECT_EQ(glsl::gn_virtual_slot(6, level, face, page + GN_VIRTUAL_SIDE), slot) << "windows wrap around";
            }
        }
    }
}

/// The list of what samples ask for has an entry for every place that pages can take, and no more.
TEST(Virtual, EveryPlaceThatPagesTakeCanBeListed) {
    for (const int faces : {1, 6}) {
        virtual_pages::PageJob job;
        job.data.faces = faces;
        std::set<int> slots;
        for (int level = 0; level < 8; ++level) {
            for (int face = 0; face < faces; ++face) {
                for (int i = 0; i < 1 << (2 * level); ++i) {
                    const ivec2 page(i & ((1 << level) - 1), i >> level);
                    slots.insert(glsl::gn_virtual_slot(faces, level, face, page));
                }
            }
            job.data.levels = level + 1;
            EXPECT_EQ(job.most_listed(), slots.size()) << faces << " faces, " << job.data.levels << " levels";
        }
    }
}

/// The level asked for is the coarsest whose texels are no larger than a pixel in any direction.
TEST(Virtual, ATexelIsAtMostAPixel) {
    GnVirtualData data;
    data.levels = 12;
    data.stretch = 1000;
    for (int i = 1; i < 200; ++i) {
        const float size = std::pow(2.0F, -0.05F * static_cast<float>(i));
        const float turn = 0.37F * static_cast<float>(i);
        const vec2 right = size * vec2(std::cos(turn), std::sin(turn));
        const vec2 down = 3 * size * vec2(-std::sin(turn + 0.4F), std::cos(turn + 0.4F));
        const int level = glsl::gn_virtual_level_of(glsl::gn_virtual_wanted(right, down, data), 0, data.levels);
        const auto scale = static_cast<float>(1 << level);
        EXPECT_LE(glsl::gn_undersampling_of(scale * right, scale * down), 1.001F) << i;
        if (level > 0) {
            EXPECT_GT(glsl::gn_undersampling_of(0.5F * scale * right, 0.5F * scale * down), 1) << i;
        }
    }
    // Where light grazes, a texel counts as so much longer than its mean side at most.
    data.stretch = 4;
    EXPECT_EQ(glsl::gn_virtual_wanted(vec2(1, 0), vec2(0, 1.0F / 65536), data), 10);
    // Coarser by quarters: by a quarter some, by four all of them.
    EXPECT_EQ(glsl::gn_virtual_level_of(4.2F, 0, 12), 5);
    EXPECT_EQ(glsl::gn_virtual_level_of(4.2F, 1, 12), 4);
    EXPECT_EQ(glsl::gn_virtual_level_of(4.9F, 1, 12), 5);
    EXPECT_EQ(glsl::gn_virtual_level_of(4.9F, 4, 12), 4);
}

/// What a page shows of a face is what the face shows there, and the border beside it.
TEST(Virtual, PagesArePartsOfTheirFace) {
    GnLightView face;
    face.cs_from_ws = glm::perspective(1.2F, 1.0F, 0.1F, 10.0F);
    face.ws_from_cs = glm::inverse(face.cs_from_ws);
    const ivec2 page(5, 2);
    const GnLightView view = glsl::gn_virtual_view(face, 3, page, 128, 4, vec2(0));
    for (const vec3 p_ws : {vec3(0.1F, -0.2F, -1), vec3(1, 0.5F, -4), vec3(-0.3F, 0.1F, -0.7F)}) {
        const vec4 p_face = face.cs_from_ws * vec4(p_ws, 1);
        const vec2 in_page = 8.0F * (0.5F * vec2(p_face) / p_face.w + 0.5F) - vec2(page);
        const vec4 p_cs = view.cs_from_ws * vec4(p_ws, 1);
        const vec2 p_ts = 0.5F * vec2(p_cs) / p_cs.w + 0.5F;
        EXPECT_NEAR(p_ts.x * 128, 4 + in_page.x * 120, 2e-3);
        EXPECT_NEAR(p_ts.y * 128, 4 + in_page.y * 120, 2e-3);
        const vec4 back = view.ws_from_cs * p_cs;
        EXPECT_NEAR(glm::distance(vec3(back) / back.w, p_ws), 0, 1e-4);
    }
}

/// Lookups that ask what a region holds say themselves whether they can ask pages; the others are refused, and those named that can.
TEST(Virtual, LookupsSayWhetherTheySearchPages) {
    const Scene& scene = test::built_in("slab");
    const auto why = [&](const char* text) {
        const Recipe recipe = load_recipe(text);
        return recipe.placement->refuses(scene, scene.lights[0], recipe);
    };
    for (const char* served : {"hard,placement=virtual", "pcss,placement=virtual", "smrt,placement=virtual"}) {
        EXPECT_EQ(why(served), "") << served;
    }
    const std::string refused = why("backprojection,placement=virtual");
    EXPECT_NE(refused.find("'pcss', 'smrt'"), std::string::npos) << refused;
}

/// Frames of a recipe with a history of their own.
struct Sequence {
    SceneGpu& gpu;
    History history{test::device()};
    PreparedRecipe recipe;
    std::string pages;  ///< what the history calls those of light 0
    FrameResult frame;  ///< the latest
    Sequence(SceneGpu& scene, const std::string& text)
        : gpu(scene), recipe(test::device(), load_recipe(text)), pages("pages of light 0 " + load_recipe(text).name) {}
    std::vector<float> draw(const Camera& camera) {
        frame =
            render_frame(gpu, camera, recipe,
                         {.width = width, .height = height, .only_light = 0, .picture = false, .history = &history});
        EXPECT_EQ(frame.refused.front(), "");
        return frame.visibility.front().values;
    }
    std::vector<float> draw() { return draw(gpu.scene->cameras.front()); }
    [[nodiscard]] std::uint32_t drawn() { return *history.answered("pages drawn of light 0"); }
};

/// Slots and tags of the pages in a pool of so many that the latest frame showed.
using ShownPages = std::set<std::pair<int, uint>>;
ShownPages shown_pages(Sequence& frames, uint pool) {
    ShownPages shown;
    Texture2D* const texture = frames.history
                                   .pair({.name = frames.pages,
                                          .format = VK_FORMAT_R32_UINT,
                                          .width = pool,
                                          .height = 3,
                                          .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT})
                                   .before;
    if (texture == nullptr) {
        ADD_FAILURE() << "no frame left " << frames.pages;
        return shown;
    }
    const std::vector<std::byte> bytes = download(test::device(), *texture);
    std::vector<uint> rows(bytes.size() / sizeof(uint));
    std::memcpy(rows.data(), bytes.data(), bytes.size());
    for (uint i = 0; i < pool; ++i) {
        if (rows[i] != 0 && rows[2 * pool + i] == frames.history.frame()) {
            shown.emplace(static_cast<int>(rows[i]) - 1, rows[pool + i]);
        }
    }
    return shown;
}

/// Whether a box lies on a view of so many texels a side, or on a texel beside it.
bool lies_on(const Box& box_ws, const GnLightView& view, float side) {
    vec2 low(1e30F), high(-1e30F);
    for (const vec3& corner_ws : box_ws.corners()) {
        const vec4 p_cs = view.cs_from_ws * vec4(corner_ws, 1);
        if (p_cs.w <= 0) {
            return false;  // no box of these tests is both before and behind the light
        }
        low = glm::min(low, vec2(p_cs) / p_cs.w);
        high = glm::max(high, vec2(p_cs) / p_cs.w);
    }
    const float rim = 1 + 2 / side;
    return low.x <= rim && low.y <= rim && high.x >= -rim && high.y >= -rim;
}

/// A large box and a small one far from it, which stands where few pages look.
Scene two_boxes(const GnLight& light) {
    by_hand::SceneBuilder b;
    b.ground(8).box({-3, 0.5F, -1}, {-1.5F, 2.5F, 1}).box({3, 0.5F, 2}, {3.5F, 1, 2.5F}).light(light);
    Scene scene = b.scene();
    scene.cameras = {{.position_ws = vec3(0, 9, 9), .forward_ws = glm::normalize(vec3(0, -1, -1))}};
    return scene;
}

std::size_t differing(const std::vector<float>& a, const std::vector<float>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        count += a[i] != b[i] ? 1 : 0;
    }
    return count;
}

class PagesRendered : public testing::TestWithParam<const char*> {};

/// A steady frame draws nothing; a caster that moves the pages that it touched and touches; and no frame shows anything old.
TEST_P(PagesRendered, AreDrawnWhereACasterMovedAndNowhereElse) {
    const test::ValidationGuard guard;
    const std::string kind = GetParam();
    Scene scene = two_boxes(kind == "sun"    ? by_hand::sun({0.3F, -1, 0.2F})
                            : kind == "spot" ? by_hand::spot({0, 12, 1}, {0, 0, 0}, 0.7F)
                                             : by_hand::point({0, 6, 1}));
    SceneGpu gpu = upload_scene(test::device(), scene);
    const char* const text = "virtual,lookup=hard,resolution=1024,virtual.page=64";
    Sequence frames(gpu, text);
    const std::vector<float> first = frames.draw();
    const std::uint32_t all = frames.drawn();
    EXPECT_GT(std::count(first.begin(), first.end(), 0.0F), 50);
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(frames.draw(), first);
        EXPECT_EQ(frames.drawn(), 0U) << "frame " << k;
    }
    const ShownPages before = shown_pages(frames, 256);
    EXPECT_EQ(before.size(), all);
    const Box was_ws = scene.objects[2].bounds_ws;
    move_object(scene, 2, glm::translate(mat4(1), vec3(0.3F, 0, -0.4F)));
    refresh_scene(test::device(), gpu);
    const std::vector<float> moved = frames.draw();
    const std::uint32_t drawn = frames.drawn();
    EXPECT_LT(drawn, all / 2) << "of " << all;
    // Drawn are those on which the box lay or lies, and what samples on the box itself ask for that none asked for before.
    const auto* const grid = frames.history.before<virtual_pages::Grid>(frames.pages);
    ASSERT_NE(grid, nullptr);
    const auto faces = static_cast<int>(grid->faces.size());
    std::size_t touched = 0, seen_first = 0;
    for (const auto& [slot, tag] : shown_pages(frames, 256)) {
        const GnLightView view =
            glsl::gn_virtual_view(grid->faces[static_cast<std::size_t>(glsl::gn_virtual_face(faces, slot))],
                                  glsl::gn_virtual_level(faces, slot), glsl::gn_virtual_page(tag), 64, 2, vec2(0));
        const bool lies = lies_on(was_ws, view, 64) || lies_on(scene.objects[2].bounds_ws, view, 64);
        const bool is_new = before.count({slot, tag}) == 0;
        touched += lies && !is_new ? 1 : 0;
        seen_first += is_new ? 1 : 0;
    }
    EXPECT_GT(touched, 0U);
    EXPECT_EQ(drawn, touched + seen_first) << touched << " touched of " << all << ", " << seen_first << " seen first";
    EXPECT_EQ(frames.draw(), moved);
    EXPECT_EQ(frames.drawn(), 0U);
    // A sequence that begins now knows nothing of before. Its pages stand elsewhere in the pool, where positions round otherwise.
    Sequence fresh(gpu, text);
    EXPECT_LE(differing(fresh.draw(), moved), 3U);
    EXPECT_GT(differing(first, moved), 3U);

    // The light moves, and all is drawn anew.
    scene.lights[0].shape.position_ws.x += 0.5F;
    scene.lights[0].shape.direction_ws =
        vec4(glm::normalize(vec3(scene.lights[0].shape.direction_ws) + vec3(0.1F, 0, 0)), 0);
    static_cast<void>(frames.draw());
    EXPECT_GT(frames.drawn(), all / 2);
}

INSTANTIATE_TEST_SUITE_P(VirtualRendered, PagesRendered, testing::Values("sun", "spot", "point"));

/// Samples around which V is 0 all over.
std::vector<std::size_t> deep_in_shadow(const std::vector<float>& v) {
    std::vector<std::size_t> deep;
    for (uint y = 3; y + 3 < height; ++y) {
        for (uint x = 3; x + 3 < width; ++x) {
            bool dark = true;
            for (uint dy = y - 3; dy <= y + 3 && dark; dy += 3) {
                for (uint dx = x - 3; dx <= x + 3 && dark; dx += 3) {
                    dark = v[dy * width + dx] == 0;
                }
            }
            if (dark) {
                deep.push_back(y * width + x);
            }
        }
    }
    return deep;
}

/// A camera that jumps about, with one page a frame, in a pool that holds all pages and in one that is too small for the path: what is
/// not there yet, or no longer, is as dark as in the coarser page that serves, which is never lighter than what is deep in shadow.
TEST(VirtualRendered, AMissingPageIsNeverLight) {
    const test::ValidationGuard guard;
    Scene scene = two_boxes(by_hand::sun({0.3F, -1, 0.2F}));
    SceneGpu gpu = upload_scene(test::device(), scene);
    const std::string text = "virtual,lookup=hard,virtual.page=64,";
    Sequence coarse(gpu, text + "resolution=1024,virtual.levels=1");
    for (const auto& [pool, most] : {std::pair{"resolution=1024,virtual.drawn=1", 1U},
                                     std::pair{"resolution=512,virtual.texels=4,virtual.drawn=24", 24U}}) {
        Sequence frames(gpu, text + pool);
        std::size_t deep = 0;
        for (int k = 0; k < 8; ++k) {
            Camera camera = scene.cameras.front();
            camera.position_ws =
                vec3(-3.0F + 0.7F * static_cast<float>(k % 5), 5.0F - static_cast<float>(k % 5) * 0.5F, 4);
            const std::vector<float> few = frames.draw(camera);
            EXPECT_LE(frames.drawn(), most);
            EXPECT_GT(frames.drawn(), 0U);
            for (const std::size_t i : deep_in_shadow(coarse.draw(camera))) {
                ++deep;
                ASSERT_EQ(few[i], 0) << pool << " frame " << k << " at " << i % width << ", " << i / width;
            }
        }
        EXPECT_GT(deep, 20U);
    }
}

/// One page a frame for a lamp that has six faces, at first and when a caster beside the lamp moves, which lies on most of them: pages of
/// level 0 are all drawn, V is to the bit what they alone give, and no sample that the light does not reach is light for want of a page:
/// beyond those that are where all pages are drawn, none but along silhouettes, which texels of level 0 move by about a pixel.
TEST(VirtualRendered, AMissingFaceIsNeverLight) {
    const test::ValidationGuard guard;
    Scene scene = two_boxes(by_hand::point({0, 2, 0.5F}));
    SceneGpu gpu = upload_scene(test::device(), scene);
    const std::string text = "virtual,lookup=hard,virtual.page=64,resolution=1024";
    Sequence all(gpu, text), few(gpu, text + ",virtual.drawn=1"), coarse(gpu, text + ",virtual.levels=1");
    for (const bool moved : {false, true}) {
        if (moved) {
            move_object(scene, 1, glm::translate(mat4(1), vec3(0.2F, 0, 0.1F)));
            refresh_scene(test::device(), gpu);
        }
        const std::vector<float> v = few.draw(), v_all = all.draw(), v_coarse = coarse.draw();
        EXPECT_EQ(few.drawn(), coarse.drawn());
        EXPECT_GT(few.drawn(), 2U) << "faces that one page a frame does not serve";
        EXPECT_EQ(v, v_coarse);
        const TruthResult truth = Truth(scene).trace(all.frame.samples.position_ws, all.frame.samples.normal_ws,
                                                     scene.lights.front(), {.samples = 1});
        int deep = 0, light = 0, light_all = 0;
        for (const std::size_t i : deep_in_shadow(truth.visibility)) {
            deep += truth.counted[i] != 0 ? 1 : 0;
            light += truth.counted[i] != 0 && v[i] > 0 ? 1 : 0;
            light_all += truth.counted[i] != 0 && v_all[i] > 0 ? 1 : 0;
        }
        EXPECT_GT(deep, 100);
        EXPECT_LE(light, light_all) << "of " << deep;
    }
}

/// Cameras near the ground, one to the left, one before and one to the right.
std::array<Camera, 3> apart() {
    std::array<Camera, 3> cameras;
    for (std::size_t i = 0; i < 3; ++i) {
        const vec3 at_ws(-5.0F + 5.0F * static_cast<float>(i), 0, i == 1 ? 4 : -2);
        cameras[i].position_ws = at_ws + vec3(0, 3, 3);
        cameras[i].forward_ws = glm::normalize(vec3(0, -1, -1));
    }
    return cameras;
}

/// A pool that holds what two views ask for and not what three do: pages unused for longest are given away. What then is drawn again
/// shows what frames show that know of no others.
TEST(VirtualRendered, PagesUnusedForLongestAreGivenAway) {
    const test::ValidationGuard guard;
    const Scene scene = two_boxes(by_hand::sun({0.3F, -1, 0.2F}));
    SceneGpu gpu = upload_scene(test::device(), scene);
    const std::array<Camera, 3> cameras = apart();
    const auto text = [](int along) {
        return fmt::format("virtual,lookup=hard,resolution={},virtual.page=64,virtual.texels=4", 64 * along);
    };
    // What each view asks for beside what the whole scene's does.
    std::array<int, 3> asked{};
    for (std::size_t i = 0; i < 3; ++i) {
        Sequence alone(gpu, text(32));
        static_cast<void>(alone.draw());
        static_cast<void>(alone.draw(cameras[i]));
        asked[i] = static_cast<int>(alone.drawn());
    }
    const int two = std::max({asked[0] + asked[1], asked[1] + asked[2], asked[2] + asked[0]}) + 12;
    const int along = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(two))));
    ASSERT_GE(along, 8);
    ASSERT_LT(along * along + 12, asked[0] + asked[1] + asked[2]);

    // The whole scene first, so that the faces stay; then each view, and the first two again.
    Sequence frames(gpu, text(along));
    static_cast<void>(frames.draw());
    std::array<std::vector<float>, 3> first;
    for (const std::size_t i : {0U, 1U, 2U, 0U, 1U}) {
        first[i] = frames.draw(cameras[i]);
    }
    EXPECT_EQ(frames.draw(cameras[0]), first[0]);
    EXPECT_EQ(frames.drawn(), 0U);
    static_cast<void>(frames.draw(cameras[2]));
    EXPECT_GT(frames.drawn(), 0U) << "the third has been given away";
    // Now the second is the oldest.
    EXPECT_EQ(frames.draw(cameras[0]), first[0]);
    EXPECT_EQ(frames.drawn(), 0U);
    const std::vector<float> again = frames.draw(cameras[1]);
    EXPECT_GT(frames.drawn(), 0U);
    Sequence fresh(gpu, text(along));
    static_cast<void>(fresh.draw());
    // Pages stand elsewhere in the pool, where positions round otherwise.
    EXPECT_LE(differing(again, fresh.draw(cameras[1])), 3U);
}

/// Where the pool suffices no texel covers more than a pixel; where it does not, all are coarser and the budget holds.
TEST(VirtualRendered, TexelsAreAtMostAPixelWhereThePoolSuffices) {
    const test::ValidationGuard guard;
    const Scene scene = two_boxes(by_hand::sun({0.3F, -1, 0.2F}));
    SceneGpu gpu = upload_scene(test::device(), scene);
    const auto share_above_one = [&](const char* recipe) {
        const std::vector<float> m = undersampling(test::device(), gpu, scene.cameras.front(), load_recipe(recipe),
                                                   {.width = width, .height = height});
        const auto judged = std::count_if(m.begin(), m.end(), [](float of) { return of >= 0; });
        const auto above = std::count_if(m.begin(), m.end(), [](float of) { return of > 1.01F; });
        EXPECT_GT(judged, width * height / 2);
        return static_cast<double>(above) / static_cast<double>(judged);
    };
    // Sides of boxes that the light grazes ask for no more than `stretch` gives.
    EXPECT_LT(share_above_one("virtual,lookup=hard,resolution=2048,virtual.page=64"), 0.02);
    EXPECT_GT(share_above_one("virtual,lookup=hard,resolution=64"), 0.9);
}

/// A board high over a floor, its edge over x = 0, under a wide sun.
Scene wide_penumbra() {
    by_hand::SceneBuilder b;
    GnLight sun = by_hand::sun({0.02F, -1, 0.03F});
    sun.angular_radius = 0.25F;
    b.ground(8).box({-6, 4, -6}, {0, 4.1F, 6}).light(sun);
    return b.scene();
}

class PagesSearched : public testing::TestWithParam<const char*> {};

/// Penumbrae are wider than pages here, and to one camera the board's edge is on no page but the coarsest: what hides the light from a
/// receiver is found all the same. V is on average the traced one, and as near to it as over one whole map of as fine texels.
TEST_P(PagesSearched, FindCastersOnOtherPagesAndLevels) {
    const test::ValidationGuard guard;
    Scene scene = wide_penumbra();
    for (const bool beside : {false, true}) {
        // Under the board and the penumbra, or beside both what it covers and where it is.
        scene.cameras = {{.position_ws = vec3(beside ? 0.9F : 0.2F, beside ? 1.0F : 2.5F, 0.8F),
                          .forward_ws = glm::normalize(vec3(0, -1, -0.5F)),
                          .yfov = 0.8F}};
        const auto shadowed = [&](const std::string& placement) {
            const auto c = test::compare(scene, std::string(GetParam()) + placement,
                                         {.width = width, .height = height, .samples = 64});
            double sum = 0, squares = 0;
            int count = 0;
            for (std::size_t i = 0; i < c.truth.counted.size(); ++i) {
                const float traced = c.truth.visibility[i];
                if (c.truth.counted[i] != 0 && traced > 0.6F && traced < 0.97F) {
                    const auto wrong = static_cast<double>(c.visibility().values[i] - traced);
                    sum += wrong;
                    squares += wrong * wrong;
                    ++count;
                }
            }
            EXPECT_GT(count, 300) << placement;
            return dvec2(sum / count, std::sqrt(squares / count));
        };
        const dvec2 pages = shadowed(",placement=virtual,resolution=2048,virtual.page=64,virtual.texels=6");
        const dvec2 whole = shadowed(",placement=fit,resolution=2048");
        EXPECT_NEAR(pages.x, 0, 0.05) << GetParam() << " beside " << beside << ", whole " << whole.x;
        EXPECT_LT(pages.y, whole.y + 0.03) << GetParam() << " beside " << beside;
    }
}

INSTANTIATE_TEST_SUITE_P(VirtualRendered, PagesSearched, testing::Values("pcss", "smrt"));

/// Receivers near the borders of pages, of faces and of what the light shines on are served: the traced shadow, to a texel.
TEST(VirtualRendered, ServesEveryKindOfLight) {
    for (const char* kind : {"directional", "spot", "point", "rectangle"}) {
        const Scene scene = test::lit_scene(kind);
        const auto c = test::compare(scene, "virtual,lookup=hard,resolution=1024,virtual.page=64",
                                     {.width = width, .height = height, .samples = 1});
        const auto fitted = test::compare(scene, "hard,placement=auto,resolution=1024",
                                          {.width = width, .height = height, .samples = 1});
        EXPECT_LE(*c.errors.mismatch, 1.2 * *fitted.errors.mismatch + 0.002) << kind;
    }
}

}  // namespace
}  // namespace gn::virtual_test
