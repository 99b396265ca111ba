// SPDX-License-Identifier: MIT
#include "tests/panels.h"

#include "shadow/scene/point_emission.h"

namespace gn::test {

Texture red_and_blue(int side) {
    Texture panel{.name = "panel", .image = {side, side, {}}, .repeat_u = false, .repeat_v = false};
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const auto green = static_cast<std::uint8_t>(255 * y / (side - 1));
            const std::uint8_t red = x < side / 2 ? 255 : 0;
            const auto blue = static_cast<std::uint8_t>(x < side / 2 ? 0 : 188);
            panel.image.rgba.insert(panel.image.rgba.end(), {red, green, blue, 255});
        }
    }
    return panel;
}

void show_picture(Scene& scene, Texture picture) {
    set_emission(scene.lights.front().shape, static_cast<int>(scene.textures.size()));
    scene.textures.push_back(std::move(picture));
    complete_emission(scene, scene.lights.front());
}

TracedPicture trace_picture(const Scene& scene, const CpuSamples& samples, int count, int side) {
    const Light& light = scene.lights.front();
    const std::vector<vec4> sent = emission_of_points(*shown_picture(scene, light.shape), light.shape, count, side);
    const LightSamples points = light_samples(light.shape, count, side);
    const Truth truth(scene);
    const std::size_t size = samples.position_ws.size();
    std::vector<dvec3> seen(size, dvec3(0)), all(size, dvec3(0));
    TracedPicture traced{.visibility = std::vector<vec3>(size, vec3(0)), .counted = {}};
    for (std::size_t k = 0; k < points.points.size(); ++k) {
        const LightSamples one{.points = {points.points[k]}};
        const TruthResult ray =
            truth.trace(samples.position_ws, samples.normal_ws, light, {.exactly = &one, .width = samples.width});
        traced.counted = ray.counted;
        for (std::size_t i = 0; i < size; ++i) {
            const ivec2 pixel(static_cast<int>(i % samples.width), static_cast<int>(i / samples.width));
            if (gn_point_taken(static_cast<int>(k), count, pixel, side)) {
                seen[i] += static_cast<double>(ray.visibility[i]) * dvec3(sent[k]);
                all[i] += dvec3(sent[k]);
            }
        }
    }
    for (std::size_t i = 0; i < size; ++i) {
        if (traced.counted[i] != 0) {
            const vec3 v(seen[i] / all[i]);
            traced.visibility[i] = v;
            traced.coloured += std::abs(v.r - v.b) > 0.25F ? 1 : 0;
        }
    }
    return traced;
}

}  // namespace gn::test
