// SPDX-License-Identifier: MIT
// Casters that fall onto nothing that is seen are not drawn, and V is the same to the bit.
#include "tests/cascade_frame.h"

#include "shadow/placement/receiver_mask.h"

namespace gn::mask_test {
namespace {

using namespace cascades;
using namespace test;

/// A view straight down over x and z from -32 to 32: cells of one metre, of 16 texels each.
GnLightView from_above() {
    return plain_view(body_of(Box{vec3(-32, 0, -32), vec3(32, 1, 32)}),
                      {dvec3(1, 0, 0), dvec3(0, 0, 1), dvec3(0, -1, 0)}, 1024, {});
}

std::vector<dvec3> corners_of(vec3 low, vec3 high) {
    std::vector<dvec3> corners;
    for (const vec3 corner : Box{low, high}.corners()) {
        corners.emplace_back(corner);
    }
    return corners;
}

/// A receiver of 4 x 4 cells marks them, the kernel's reach to each side in texels and in metres, and the cell that rounding
/// may touch.
TEST(ReceiverMask, HoldsTheReceiversAndTheirKernels) {
    for (const auto& [guard, reach] : {std::pair{Guard{}, 0.125F}, std::pair{Guard{.texels = 32}, 2.125F},
                                       std::pair{Guard{.texels = 16, .metres = 1}, 2.125F}}) {
        ReceiverMask mask(from_above(), sun(vec3(0, -1, 0)), guard);
        EXPECT_EQ(mask.share(), 0);
        mask.add(corners_of(vec3(0, 0, 0), vec3(4, 1, 4)));
        // What is marked ends with whole cells of a metre.
        const double cells = 4 + 2 * std::ceil(static_cast<double>(reach));
        EXPECT_NEAR(mask.share() * 4096, cells * cells, 0.5) << guard.texels << " " << guard.metres;
        const float end = 4 + std::ceil(reach);
        const auto at = [&](float x) { return mask.meets(Box{vec3(x, 50, 1), vec3(x + 0.5F, 51, 2)}); };
        EXPECT_TRUE(at(end - 0.01F)) << guard.texels;
        EXPECT_TRUE(at(end + 0.1F)) << guard.texels;
        EXPECT_FALSE(at(end + 0.2F)) << guard.texels;
        EXPECT_TRUE(mask.meets(Box{vec3(-30, 5, 1), vec3(30, 6, 1)}));
    }
}

/// A square that stands on its corner marks its diagonal half, not its bounds.
TEST(ReceiverMask, FollowsTheOutline) {
    ReceiverMask mask(from_above(), sun(vec3(0, -1, 0)), {});
    mask.add(std::vector<dvec3>{{-24, 0, 0}, {24, 0, 0}, {0, 0, -24}, {0, 0, 24}, {0, 1, 0}});
    EXPECT_NEAR(mask.share() * 4096, 48 * 48 / 2, 150);
    EXPECT_FALSE(mask.meets(Box{vec3(20, 9, 20), vec3(22, 10, 22)}));
    EXPECT_TRUE(mask.meets(Box{vec3(-1, 9, 20), vec3(1, 10, 22)}));
}

/// Biases that move the place of the lookup across the rays count as kernels do.
TEST(ReceiverMask, BiasesWidenTheKernels) {
    const GnLightView view = from_above();
    const Guard plain = with_bias({.texels = 2}, {.normal = 0, .view = 0}, view);
    EXPECT_EQ(plain.metres, 0);
    // Texels of a sixteenth of a metre.
    EXPECT_NEAR(with_bias({.texels = 2}, {.normal = 4, .view = 0}, view).metres, 0.25F, 1e-4F);
    EXPECT_NEAR(with_bias({.texels = 2}, {.normal = 4, .view = 0, .view_world = 3}, view).metres, 3.25F, 1e-4F);
    EXPECT_NEAR(with_bias({.texels = 2}, {.normal = 4, .receiver_plane = 0, .view = 0, .kernel = 1}, view).metres,
                0.25F * 5, 1e-4F);
}

std::size_t drawn(const Rendered& frame) {
    std::size_t count = 0;
    for (const auto& casters : frame.casters) {
        count += casters.size();
    }
    return count;
}

TEST(CascadesRendered, MaskedCastersLeaveEveryBitOfVisibility) {
    const Scene scene = with_hard_sun("courtyard");
    SceneGpu gpu = upload_scene(device(), scene);
    for (const char* recipe :
         {"pcf,pcf.size=5,cascades.fit=stable", "hard,cascades.fit=fitted,bias.normal=3,cascades.falloff=0.5",
          "pcf,pcf.kernel=vogel,pcf.radius_world=0.2,cascades.fit=plain,cascades.select=projection"}) {
        std::size_t all = 0, some = 0;
        for (const Camera& camera : scene.cameras) {
            const std::string text = std::string(recipe) + ",resolution=512,placement=cascades,cascades.mask=";
            const Rendered plain = render(gpu, camera, camera, text + "0");
            const Rendered masked = render(gpu, camera, camera, text + "1");
            EXPECT_EQ(differing(plain.visibility, masked.visibility), 0U) << recipe << " " << camera.name;
            for (std::size_t i = 0; i < plain.casters.size(); ++i) {
                EXPECT_TRUE(std::includes(plain.casters[i].begin(), plain.casters[i].end(), masked.casters[i].begin(),
                                          masked.casters[i].end()));
            }
            all += drawn(plain);
            some += drawn(masked);
        }
        // Of all objects in all maps 43 %, 78 % and 90 % are left.
        EXPECT_LT(some, (19 * all) / 20) << recipe;
    }
}

/// A roof high above the ground and behind the camera throws a shadow before it; one farther aside throws it where nothing is
/// seen. The first is drawn, the other is not.
TEST(CascadesRendered, MaskKeepsCastersOutsideOfTheView) {
    Scene scene;
    const auto square = [&](const char* name, vec3 at, float half) {
        const auto base = static_cast<uint>(scene.positions_ws.size());
        const auto first = static_cast<std::uint32_t>(scene.triangles.size());
        for (const vec2 corner : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
            scene.positions_ws.push_back(at + vec3(half * corner.x, 0, half * corner.y));
            scene.normals_ws.emplace_back(0, 1, 0);
            scene.uvs.emplace_back(0);
        }
        scene.triangles.emplace_back(base, base + 2, base + 1);
        scene.triangles.emplace_back(base, base + 3, base + 2);
        scene.objects.push_back({name, first, 2, 0, Box{at - vec3(half, 0, half), at + vec3(half, 0, half)}});
    };
    scene.materials.emplace_back();
    square("ground", vec3(0), 60);
    square("roof", vec3(0, 20, 20), 2);
    square("aside", vec3(24, 20, 20), 2);
    Light light{"sun", {}};
    light.shape.kind = GN_LIGHT_DIRECTIONAL;
    light.shape.direction_ws = vec4(glm::normalize(vec3(0, -1, -1)), 0);
    scene.lights = {light};
    scene.cameras = {Camera{.position_ws = vec3(0, 2, 10), .forward_ws = glm::normalize(vec3(0, -2, -9)), .far = 60}};
    finish_scene(scene);
    SceneGpu gpu = upload_scene(device(), scene);
    const Camera& camera = scene.cameras[0];
    for (const char* fit : {"plain", "fitted", "stable"}) {
        const std::string recipe =
            fmt::format("hard,placement=cascades,cascades.count=1,cascades.fit={},cascades.mask=", fit);
        const Rendered plain = render(gpu, camera, camera, recipe + "0");
        const Rendered masked = render(gpu, camera, camera, recipe + "1");
        EXPECT_EQ(differing(plain.visibility, masked.visibility), 0U) << fit;
        std::size_t dark = 0;
        for (std::size_t p = 0; p < masked.visibility.size(); ++p) {
            dark += masked.samples.position_ws[p].w > 0 && masked.visibility[p] == 0 ? 1 : 0;
        }
        EXPECT_GT(dark, 200U) << fit;
        EXPECT_EQ(plain.casters[0], (std::vector<std::uint32_t>{0, 1, 2})) << fit;
        EXPECT_EQ(masked.casters[0], (std::vector<std::uint32_t>{0, 1})) << fit;
    }
}

TEST(CascadesRendered, RefusesToMaskWhatReachesFarther) {
    const Scene scene = load_scene("contact");
    Light light = scene.lights[0];
    light.shape.kind = GN_LIGHT_DIRECTIONAL;
    for (const char* text : {"vsm,placement=cascades", "pcss,placement=cascades", "sdsm", "cascades,cascades.rate=2",
                             "cascades,cascades.fit=warped"}) {
        EXPECT_THROW(check_recipe(load_recipe(std::string(text) + ",cascades.mask=1"), scene, light, test::device()),
                     Refusal)
            << text;
    }
}

}  // namespace
}  // namespace gn::mask_test
