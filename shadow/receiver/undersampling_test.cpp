// SPDX-License-Identifier: MIT
// The measure of undersampling against equations 3.1 and 3.2 of the course notes [EASW09], and the curves of its fig. 3.7 by it.
#include "shadow/receiver/undersampling.glsl"
#include "shadow/placement/light_views.h"
#include "shadow/show/show.h"
#include "tests/warp_scene.h"

#include <cmath>
#include <random>

namespace gn::undersampling_test {
namespace {

TEST(Undersampling, IsTheLargerSingularValueOfPixelsOverTexels) {
    // Turn, stretch by 3 and 0.25 texels a pixel, turn again: of the inverse's 1/3 and 4 the larger counts.
    for (const double first : {0.0, 0.4, 1.3, 2.9}) {
        for (const double second : {0.0, 0.7, 2.2}) {
            const auto turn = [](double a) { return glm::dmat2(std::cos(a), std::sin(a), -std::sin(a), std::cos(a)); };
            const glm::dmat2 texels = turn(first) * glm::dmat2(3, 0, 0, 0.25) * turn(second);
            EXPECT_NEAR(glsl::gn_undersampling_of(vec2(texels[0]), vec2(texels[1])), 4, 1e-4) << first << " " << second;
        }
    }
    EXPECT_GE(glsl::gn_undersampling_of(vec2(1, 0), vec2(1, 0)), 1e29F) << "seen edge-on";
    EXPECT_GE(glsl::gn_undersampling_of(vec2(0), vec2(0)), 1e29F);
}

/// A direction of the plane x = 0.
dvec3 in_plane(double angle) {
    return {0, std::sin(angle), std::cos(angle)};
}

/// C eq. 3.2 with depths along the normals of both image planes, from a random eye and light, both of them and the patch's
/// normal in one plane. Across it pixels are so wide that only the axis in the plane counts.
TEST(Undersampling, IsEquation32InThePlaneOfEyeAndLight) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const double rows = 720;
    const double eye_width = 1.1;  // of the image plane one metre before the eye
    const double light_width = 2;  // of square_perspective's with a tangent of 1
    const int resolution = 512;
    int asked = 0;
    for (int i = 0; i < 300; ++i) {
        // Where eye and light are, what they look at beside the patch, and how the patch lies.
        const dvec3 p_ws(0, uniform(random), uniform(random));
        const dvec3 eye_ws = p_ws + (6 + 4 * uniform(random)) * in_plane(3 * uniform(random));
        const dvec3 light_ws = p_ws + (6 + 4 * uniform(random)) * in_plane(3 * uniform(random));
        const dvec3 eye_axis = glm::normalize(p_ws + 2 * uniform(random) * in_plane(uniform(random)) - eye_ws);
        const dvec3 light_axis = glm::normalize(p_ws + 2 * uniform(random) * in_plane(uniform(random)) - light_ws);
        const dvec3 normal = in_plane(3 * uniform(random));
        const double cos_eye = glm::dot(normal, glm::normalize(eye_ws - p_ws));
        const double cos_light = glm::dot(normal, glm::normalize(light_ws - p_ws));
        if (cos_eye < 0.1 || cos_light < 0.1) {
            continue;
        }
        ++asked;

        // The patch's change from a pixel to the next: where the rays of both meet its plane.
        const dvec3 down = glm::cross(eye_axis, dvec3(1, 0, 0));
        const auto seen = [&](double pixels) {
            const double depth = glm::dot(p_ws - eye_ws, eye_axis);
            const dvec3 ray = (p_ws - eye_ws) / depth + down * (pixels * eye_width / rows);
            return eye_ws + ray * (glm::dot(normal, p_ws - eye_ws) / glm::dot(normal, ray));
        };
        glsl::GnReceiver receiver{};
        receiver.p_ws = vec3(p_ws);
        receiver.n_ws = vec3(normal);
        receiver.ddx_ws = vec3(1e3F, 0, 0);
        receiver.ddy_ws = vec3((seen(0.01) - seen(-0.01)) / 0.02);
        const vec3 up = vec3(glm::cross(light_axis, dvec3(1, 0, 0)));
        const GnLightView view = square_perspective(vec3(light_ws), vec3(light_axis), up, 1, 0.1, 30, resolution);
        vec3 du_ws, dv_ws;
        glsl::gn_uv_gradients(view, receiver.p_ws, du_ws, dv_ws);
        const double found = static_cast<double>(glsl::gn_undersampling(receiver, du_ws, dv_ws, resolution));

        const double eye_depth = glm::dot(p_ws - eye_ws, eye_axis);
        const double light_depth = glm::dot(p_ws - light_ws, light_axis);
        const double eye_beam = eye_depth / glm::length(p_ws - eye_ws);
        const double light_beam = light_depth / glm::length(p_ws - light_ws);
        const double m = rows / resolution * light_width / eye_width * light_depth / eye_depth *
                         (light_beam * cos_eye) / (eye_beam * cos_light);
        EXPECT_NEAR(found / m, 1, 2e-3) << i;
        EXPECT_NEAR(static_cast<double>(glsl::gn_undersampling(receiver, du_ws, dv_ws, 1)) / (m * resolution), 1, 2e-3)
            << "the resolution that the patch asks for";
    }
    EXPECT_GT(asked, 50);
}

constexpr double first = 3, last = 200, length = last - first;

/// C fig. 3.7, L = z_f - z_n: the error along the view of a map that a placement warps under a light overhead.
double closed_form(std::string_view placement, double z) {
    if (placement == "fit") {
        return length / z;
    }
    if (placement == "psm") {
        return length * z / (first * last);
    }
    const double n = first + std::sqrt(first * last);  // lispsm's n_opt
    return std::pow(n + z - first, 2) / (n * (n + length) * z) * length;
}

/// psm with the camera's own centre of projection.
std::string recipe_of(const std::string& placement, int resolution) {
    return fmt::format("hard,placement={}{},resolution={}", placement, placement == "psm" ? ",psm.back=0" : "",
                       resolution);
}

/// C eq. 3.1 where cos alpha = cos beta: a patch that is turned halfway between the light above and the camera.
TEST(Undersampling, AlongTheViewIsTheClosedFormOfEveryWarp) {
    const Scene scene = test::long_floor(first, last);
    const int resolution = 8192;
    const float pixel = 0.002F;
    EXPECT_NEAR(closed_form("lispsm", first), length / std::sqrt(first * last), 1e-9);
    EXPECT_NEAR(closed_form("lispsm", last), length / std::sqrt(first * last), 1e-9);
    EXPECT_NEAR(closed_form("lispsm", std::sqrt(first * last)),
                4 * length / std::pow(std::sqrt(first) + std::sqrt(last), 2), 1e-9);
    for (const std::string placement : {"fit", "lispsm", "psm"}) {
        const GnLightView view = test::place(scene, recipe_of(placement, resolution)).views[0];
        for (const double z : {1.01 * first, 6.0, std::sqrt(first * last), 60.0, 0.99 * last}) {
            const float size = pixel * static_cast<float>(z);
            glsl::GnReceiver receiver{};
            receiver.p_ws = vec3(0, 0, -z);
            receiver.n_ws = glm::normalize(vec3(0, 1, 1));
            receiver.ddx_ws = vec3(1e3F * size, 0, 0);
            receiver.ddy_ws = vec3(0, -size, size);
            const float m = glsl::gn_undersampling_in(receiver, glsl::gn_project(receiver, view, {}));
            const double error = static_cast<double>(m * pixel) * resolution;
            EXPECT_NEAR(error / closed_form(placement, z), 1, 0.02) << placement << " at " << z;
        }
    }
}

/// The pass over all view samples finds one over what --show texels has, which show_test.cpp holds to the texels of a plane.
TEST(Undersampling, OfEveryViewSampleIsOneOverItsTexelsPerPixel) {
    const test::ValidationGuard guard;
    const Scene& scene = test::built_in("corridor");
    SceneGpu gpu = upload_scene(test::device(), scene);
    const Recipe recipe = load_recipe("hard,placement=cascades,cascades.transition=none,resolution=256");
    const HiddenOptions options{.width = 64, .height = 40};
    const std::vector<float> m = undersampling(test::device(), gpu, scene.camera(""), recipe, options);
    const std::vector<std::string> name{"texels"};
    const Shown texels = show_hidden(test::device(), gpu, scene.camera(""), recipe, name, options).front();
    int held = 0;
    for (std::size_t i = 0; i < m.size(); ++i) {
        if (texels.values.values[2 * i + 1] < 0.5F) {
            EXPECT_EQ(m[i], -1) << i;
            continue;
        }
        EXPECT_NEAR(m[i] * texels.values.values[2 * i], 1, 1e-5F) << i;
        ++held;
    }
    EXPECT_GT(held, 100);
    EXPECT_TRUE(undersampling(test::device(), gpu, scene.camera(""), load_recipe("volumes"), options).empty());
}

}  // namespace
}  // namespace gn::undersampling_test
