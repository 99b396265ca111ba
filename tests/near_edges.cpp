// SPDX-License-Identifier: MIT
#include "tests/near_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gn::test {

float pixels_to_shadow(const Truth& truth, const Scene& scene, const CpuSamples& samples, std::size_t i,
                       const GnLight& light, float traced) {
    const Camera& camera = scene.cameras.front();
    const float aspect = static_cast<float>(samples.width) / static_cast<float>(samples.height);
    const glm::dmat4 ws_from_cs = glm::inverse(glm::dmat4(cs_from_vs(camera, aspect)) * glm::dmat4(vs_from_ws(camera)));
    const dvec2 size(samples.width, samples.height);
    const dvec2 centre = dvec2(i % samples.width, i / samples.width) + 0.5;
    const dvec3 p_ws(samples.position_ws[i]), n_ws(samples.normal_ws[i]);
    for (double reach = 1.0 / 1024; reach <= 1; reach *= 1.19) {
        std::vector<vec4> around, normals;
        for (int step = 0; step < 64; ++step) {
            const double angle = 2 * glm::pi<double>() * step / 64;
            const dvec2 at = 2.0 * (centre + reach * dvec2(std::cos(angle), std::sin(angle))) / size - 1.0;
            const dvec4 near = ws_from_cs * dvec4(at, 1, 1), middle = ws_from_cs * dvec4(at, 0.5, 1);
            const dvec3 from = dvec3(near) / near.w, way = dvec3(middle) / middle.w - from;
            around.emplace_back(vec3(from + way * (glm::dot(p_ws - from, n_ws) / glm::dot(way, n_ws))), 1.0F);
            normals.push_back(samples.normal_ws[i]);
        }
        const TruthResult there = truth.trace(around, normals, light, {.samples = 1});
        for (std::size_t k = 0; k < around.size(); ++k) {
            if (there.counted[k] == 0 || there.visibility[k] != traced) {
                return static_cast<float>(reach);
            }
        }
    }
    return std::numeric_limits<float>::infinity();
}

float pixels_to_triangle(const Scene& scene, const CpuSamples& samples, std::size_t i) {
    const Camera& camera = scene.cameras.front();
    const float aspect = static_cast<float>(samples.width) / static_cast<float>(samples.height);
    const glm::dmat4 cs_from_ws = glm::dmat4(cs_from_vs(camera, aspect)) * glm::dmat4(vs_from_ws(camera));
    const dvec2 size(samples.width, samples.height);
    const dvec2 centre = dvec2(i % samples.width, i / samples.width) + 0.5;
    double nearest = std::numeric_limits<double>::infinity();
    for (const uvec3& t : scene.triangles) {
        for (int k = 0; k < 3; ++k) {
            // Before the near plane there is nothing to see.
            dvec4 a = cs_from_ws * dvec4(scene.positions_ws[t[k]], 1);
            dvec4 b = cs_from_ws * dvec4(scene.positions_ws[t[(k + 1) % 3]], 1);
            const double beyond_a = a.w - a.z, beyond_b = b.w - b.z;
            if (beyond_a <= 0 && beyond_b <= 0) {
                continue;
            }
            const dvec4 cut = a + (b - a) * (beyond_a / (beyond_a - beyond_b));
            a = beyond_a < 0 ? cut : a;
            b = beyond_b < 0 ? cut : b;
            const dvec2 from = (dvec2(a) / a.w + 1.0) * 0.5 * size, to = (dvec2(b) / b.w + 1.0) * 0.5 * size;
            const dvec2 along = to - from;
            const double s = std::clamp(glm::dot(centre - from, along) / glm::dot(along, along), 0.0, 1.0);
            nearest = std::min(nearest, glm::distance(centre, from + along * s));
        }
    }
    return static_cast<float>(nearest);
}

}  // namespace gn::test
