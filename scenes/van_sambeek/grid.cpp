// SPDX-License-Identifier: MIT
// Based on: van Sambeek. Real-time Shadow Generation for 3D Simulations Using Modern Hardware. Twente 2007. [Sam07]
// The performance scenes of section 4.1.1: objects of equal triangle count in a square raster under spot lights.
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "scenes/registry.h"

namespace gn::scenes {
namespace {

struct GnGridParams {
    int objects = 25;
    int triangles = 100;
    int lights = 1;
    float radius = 0.1F;
};

constexpr int most_triangles = 16'000'000;

Scene make_grid(const ParamBlock& block) {
    const auto params = block.as<GnGridParams>();
    if (static_cast<double>(params.objects) * params.triangles > most_triangles) {
        fail("scene grid: {} objects of {} triangles are too many; objects * triangles is at most {}", params.objects,
             params.triangles, most_triangles);
    }
    Scene scene;
    MeshBuilder builder(scene);
    builder.begin("plane (sheet)", builder.material("stone", {0.5F, 0.49F, 0.46F}));
    const float extent = 1.5F * static_cast<float>(raster_columns(params.objects)) + 1;
    builder.sheet({-extent, 0, extent}, {2 * extent, 0, 0}, {0, 0, -2 * extent});

    // A torus of 2k by k quads has 4 k^2 triangles: k = 5 and k = 20 make the 100 and 1600 of the measurements.
    const int k = std::max(3, static_cast<int>(std::lround(std::sqrt(params.triangles / 4.0))));
    const std::array paints{builder.material("clay", {0.55F, 0.30F, 0.18F}, 0.5F),
                            builder.material("glaze", {0.12F, 0.32F, 0.36F}, 0.4F)};
    for (int i = 0; i < params.objects; ++i) {
        const vec2 cell = raster_cell(i, params.objects);
        const float turn = 2.4F * static_cast<float>(i);
        builder.begin(fmt::format("object {}", i), paints[static_cast<std::size_t>(i) % 2]);
        builder.place(glm::rotate(
            glm::rotate(glm::translate(mat4(1), vec3(2.5F * cell.x, 0.75F, 2.5F * cell.y)), turn, vec3(0, 1, 0)), 1.1F,
            vec3(1, 0, 0)));
        builder.ring(0.55F, 0, 0.2F, 2 * k, k);
    }
    builder.finish();

    // Spots around the raster, each of which covers it.
    const std::array colors{vec3(1, 0.93F, 0.82F), vec3(0.80F, 0.90F, 1), vec3(1, 0.82F, 0.86F)};
    for (int i = 0; i < params.lights; ++i) {
        const float a = 0.7F + 2 * pi * static_cast<float>(i) / 3, distance = 1.6F * extent;
        Light light = directional_light(fmt::format("spot {}", i), {std::sin(a), 1.5F, std::cos(a)}, 0, 0,
                                        colors[static_cast<std::size_t>(i) % 3]);
        light.shape.kind = GN_LIGHT_SPOT;
        light.shape.position_ws = -light.shape.direction_ws * distance;
        light.shape.radius = params.radius;
        light.shape.intensity = 1000 * distance * distance;
        light.shape.cos_inner = std::cos(glm::radians(38.0F));
        light.shape.cos_outer = std::cos(glm::radians(44.0F));
        scene.lights.push_back(light);
    }
    scene.cameras.push_back(
        look_at("main", vec3(0.25F, 0.75F, 1.05F) * (1.35F * extent), {0, 0.2F, 0.1F * extent}, 50, 0.1F, 10 * extent));
    return scene;
}

}  // namespace

const Generator& grid() {
    static const Generator row{
        "grid", "Equal objects in a square raster under spot lights: the performance scenes.",
        param_table<GnGridParams>({
            GN_PARAM(GnGridParams, objects, integer, 1, 10000, "",
                     "Number of objects: more draws and more depth complexity."),
            GN_PARAM(GnGridParams, triangles, integer, 36, 1000000, "", "Triangles of each object, rounded to 4 k^2."),
            GN_PARAM(GnGridParams, lights, integer, 1, 3, "", "Number of spot lights."),
            GN_PARAM(GnGridParams, radius, real, 0, 1, "m", "Radius of each light: 0 is a hard shadow."),
        }),
        make_grid};
    return row;
}

}  // namespace gn::scenes
