// SPDX-License-Identifier: MIT
// What the tests of cascades share: receivers made by hand, and a frame whose views and maps can be looked at.
#pragma once

#include "shadow/frame/history.h"
#include "shadow/placement/cascades/cascade_views.h"
#include "shadow/placement/cascades/cascades.glsl"
#include "tests/rig.h"

#include <cstring>

namespace gn::test {

glsl::GnReceiver receiver_at(float view_depth, vec2 p_ss = vec2(7.5F, 3.5F));

GnLight sun(vec3 direction_ws);

Scene with_hard_sun(const char* name);

/// A frame built by hand, so that tests can look at the views and the map, and place by another camera than the samples'.
struct Rendered {
    std::vector<float> visibility, map;
    std::vector<GnLightView> views;
    std::vector<std::vector<std::uint32_t>> casters;
    GnCascadesData data;
    CpuSamples samples;
};

template <class T>
void copy_bytes(const std::vector<std::byte>& bytes, std::vector<T>& values) {
    values.resize(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
}

Rendered render(SceneGpu& gpu, const Camera& camera, const Camera& placed_by, const std::string& recipe_text,
                History* history = nullptr);

Camera moved(Camera camera, vec3 by_ws);

std::size_t differing(const std::vector<float>& a, const std::vector<float>& b);

}  // namespace gn::test
