// SPDX-License-Identifier: MIT
#include "tests/lent_points.h"

#include "shadow/view/read_back.h"

namespace gn::test {

std::vector<float> visibility_at(const Scene& scene, const std::string& recipe, std::span<const LentPoint> points,
                                 std::set<std::string>* remarks) {
    // Rows of 64 points; what the last one has too much sees nothing.
    constexpr uint width = 64;
    const uint height = (static_cast<uint>(points.size()) + width - 1) / width;
    std::vector<vec4> positions(std::size_t{width} * height, vec4(0)), normals(positions.size(), vec4(0, 1, 0, 1));
    for (std::size_t i = 0; i < points.size(); ++i) {
        positions[i] = vec4(points[i].p_ws, 1);
        normals[i] = vec4(points[i].n_ws, 1);
    }
    const auto texture = [&](const char* name, std::span<const vec4> texels) {
        return upload_texture(device(),
                              {.name = name,
                               .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                               .width = width,
                               .height = height,
                               .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT},
                              std::as_bytes(texels));
    };
    Texture2D position = texture("lent positions", positions), normal = texture("lent normals", normals);

    const ValidationGuard guard;
    SceneGpu gpu = upload_scene(device(), scene);
    const PreparedRecipe prepared(device(), load_recipe(recipe));
    FrameGraph graph(device());
    const FrameCasters casters{scene, import_scene(graph, gpu)};
    const ViewSamples receivers = lent_samples(graph, scene.camera(""), graph.import(position), graph.import(normal));
    const std::vector<FrameLight> lights = lights_of(scene);
    std::set<std::string> said;
    const std::vector<LightShadow> shadows =
        add_frame(graph, receivers, casters, std::span(lights).first(1), prepared, nullptr, &said);
    EXPECT_EQ(shadows.front().refused, "");
    graph.keep(shadows.front().visibility.image);
    graph.execute(false);
    if (remarks != nullptr) {
        *remarks = said;
    }
    std::vector<float> values = read_image(graph, shadows.front().visibility.image).values;
    values.resize(points.size());
    return values;
}

}  // namespace gn::test
