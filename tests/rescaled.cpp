// SPDX-License-Identifier: MIT
#include "tests/rescaled.h"

namespace gn::test {

Scene lit_scene(const std::string& kind) {
    if (kind != "rectangle") {
        return load_scene("contact:light=" + kind);
    }
    Scene scene = load_scene("contact:light=spot");
    GnLight& shape = scene.lights[0].shape;
    shape.kind = GN_LIGHT_RECTANGLE;
    shape.half_size = vec2(0.3F, 0.2F);
    scene.closed_form = nullptr;
    return scene;
}

Scene rescaled(Scene scene, float scale) {
    for (vec3& p_ws : scene.positions_ws) {
        p_ws *= scale;
    }
    for (Light& light : scene.lights) {
        GnLight& shape = light.shape;
        shape.position_ws = vec4(vec3(shape.position_ws) * scale, shape.position_ws.w);
        shape.half_size *= scale;
        shape.radius *= scale;
        shape.range *= scale;
        shape.intensity *= shape.kind == GN_LIGHT_SPOT || shape.kind == GN_LIGHT_POINT ? scale * scale : 1.0F;
    }
    for (Camera& camera : scene.cameras) {
        camera.position_ws *= scale;
        camera.half_height *= scale;
        camera.near *= scale;
        camera.far *= scale;
    }
    scene.paths.clear();
    scene.closed_form = nullptr;
    finish_scene(scene);
    return scene;
}

Scene with_stray(Scene scene, vec3 at_ws, bool own_object) {
    const auto first = static_cast<uint>(scene.positions_ws.size());
    scene.positions_ws.insert(scene.positions_ws.end(), {at_ws, at_ws + vec3(0, 1, 0), at_ws + vec3(0, 0, 1)});
    scene.normals_ws.resize(scene.positions_ws.size(), vec3(1, 0, 0));
    scene.uvs.resize(scene.positions_ws.size(), vec2(0));
    if (own_object) {
        Object stray{.name = "stray", .first_triangle = static_cast<std::uint32_t>(scene.triangles.size())};
        stray.triangle_count = 1;
        scene.objects.push_back(stray);
    } else {
        ++scene.objects.back().triangle_count;
    }
    scene.triangles.emplace_back(first, first + 1, first + 2);
    scene.closed_form = nullptr;
    finish_scene(scene);
    return scene;
}

std::vector<float> visibility_of(const Scene& scene, const std::string& recipe, uint size) {
    const ValidationGuard guard;
    SceneGpu gpu = upload_scene(device(), scene);
    const FrameResult frame =
        render_frame(device(), gpu, scene.camera(""), load_recipe(recipe),
                     {.width = size, .height = size, .repeat = 0, .only_light = 0, .picture = false});
    return frame.refused.front().empty() ? frame.visibility.front().values : std::vector<float>{};
}

std::size_t count_differing(const std::vector<float>& a, const std::vector<float>& b, float slack) {
    std::size_t count = a.size() == b.size() ? 0 : std::max(a.size(), b.size());
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        count += std::abs(a[i] - b[i]) <= slack ? 0U : 1U;
    }
    return count;
}

}  // namespace gn::test
