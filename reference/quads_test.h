// SPDX-License-Identifier: MIT
// Loose quads and loose view samples, for tests.
#pragma once

#include "shadow/scene/scene.h"

namespace gn {

/// A scene of loose quads.
struct QuadScene {
    Scene scene;
    QuadScene() { scene.materials.emplace_back(); }
    void add(vec3 corner, vec3 a, vec3 b, int material = 0) {
        const auto first = static_cast<uint>(scene.positions_ws.size());
        for (const vec2 uv : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)}) {
            scene.positions_ws.push_back(corner + uv.x * a + uv.y * b);
            scene.normals_ws.push_back(glm::normalize(glm::cross(a, b)));
            scene.uvs.push_back(uv);
        }
        Object object;
        object.first_triangle = static_cast<uint>(scene.triangles.size());
        object.triangle_count = 2;
        object.material = material;
        scene.objects.push_back(object);
        scene.triangles.emplace_back(first, first + 1, first + 2);
        scene.triangles.emplace_back(first, first + 2, first + 3);
    }
};

struct Samples {
    std::vector<vec4> position_ws, normal_ws;
    void add(vec3 p, vec3 n) {
        position_ws.emplace_back(p, 1);
        normal_ws.emplace_back(n, 0);
    }
};

}  // namespace gn
