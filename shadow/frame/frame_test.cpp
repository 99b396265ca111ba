// SPDX-License-Identifier: MIT
// The order of the stages: what a recipe combines, and in which order V is changed.
#include "gpu/shader_inputs.h"
#include "tests/rig.h"

#include <algorithm>

namespace gn::frame_test {
namespace {

FrameResult frame_of(const Scene& scene, const Recipe& recipe) {
    const test::ValidationGuard guard;
    SceneGpu gpu = upload_scene(test::device(), scene);
    FrameResult frame = render_frame(test::device(), gpu, scene.camera(""), recipe,
                                     {.width = 96, .height = 96, .repeat = 0, .only_light = 0, .picture = false});
    EXPECT_EQ(frame.refused.front(), "");
    return frame;
}

std::vector<float> values_of(const Scene& scene, const Recipe& recipe) {
    return frame_of(scene, recipe).visibility.front().values;
}

/// V that changes from place to place and owes nothing to shadows: the fraction of x.
Visibility add_striped(const FrameInput& input, const Recipe&) {
    const Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs;
    inputs.texture("sampler2D", "position", input.samples.position)
        .image("r32f", "writeonly", "image2D", "visibility", result.image);
    input.graph.add_pass(
        "striped", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, size = uvec2(input.samples.width, input.samples.height)](Recorder& r) {
            r.bind(ComputeDesc{{ShaderKind::compute, "striped", inputs.text() + R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, imageSize(visibility)))) {
        imageStore(visibility, pixel, vec4(fract(texelFetch(position, pixel, 0).x)));
    }
}
)"},
                               {}});
            inputs.set(r);
            r.dispatch_pixels(size.x, size.y);
        });
    return result;
}

TEST(Frame, AMapAndADirectPartCombineAsTheRecipeSays) {
    const Scene scene = load_scene("contact");
    Recipe recipe = load_recipe("pcf,pcf.size=7,resolution=128");
    const std::vector<float> mapped = values_of(scene, recipe);
    Part striped;
    striped.id = "striped";
    striped.stage = Stage::direct;
    striped.add_direct = add_striped;
    recipe.direct = &striped;
    recipe.combine = Combine::product;
    const FrameResult product = frame_of(scene, recipe);
    recipe.combine = Combine::minimum;
    const std::vector<float> minimum = values_of(scene, recipe);
    std::size_t soft = 0;
    for (std::size_t i = 0; i < mapped.size(); ++i) {
        const float x = product.samples.position_ws[i].x;
        const float direct = x - std::floor(x), both = product.visibility.front().values[i];
        EXPECT_EQ(both, mapped[i] * direct) << i;
        EXPECT_EQ(minimum[i], std::min(mapped[i], direct)) << i;
        soft += both > 0 && both < minimum[i] ? 1 : 0;
    }
    EXPECT_GT(soft, 20U);
}

/// A part that changes every V by a line of GLSL.
Part changing(std::string_view id, Visibility (*add)(const FrameInput&, const Recipe&, const Visibility&)) {
    Part part;
    part.id = id;
    part.stage = Stage::visibility;
    part.add_visibility = add;
    return part;
}

template <int kind>
Visibility change(const FrameInput& input, const Recipe&, const Visibility& given) {
    const std::string text = fmt::format(R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, imageSize(changed)))) {{
        float v = texelFetch(given, pixel, 0).r;
        imageStore(changed, pixel, vec4({}));
    }}
}}
)",
                                         kind == 0 ? "0.5 * v" : "0.25 + 0.75 * v");
    const Visibility result{create_visibility(input.graph, input.samples)};
    ShaderInputs inputs;
    inputs.texture("sampler2D", "given", given.image).image("r32f", "writeonly", "image2D", "changed", result.image);
    input.graph.add_pass(
        "change", [&](PassBuilder& pass) { inputs.declare(pass); },
        [=, size = uvec2(input.samples.width, input.samples.height)](Recorder& r) {
            r.bind(ComputeDesc{{ShaderKind::compute, "change", inputs.text() + text}, {}});
            inputs.set(r);
            r.dispatch_pixels(size.x, size.y);
        });
    return result;
}

TEST(Frame, VisibilityPartsRunInTheOrderOfTheList) {
    const Scene scene = load_scene("contact");
    const Part halved = changing("halved", change<0>), lifted = changing("lifted", change<1>);
    Recipe recipe = load_recipe("hard");
    const std::vector<float> hard = values_of(scene, recipe);
    recipe.visibility = {&halved, &lifted};
    const std::vector<float> first = values_of(scene, recipe);
    recipe.visibility = {&lifted, &halved};
    const std::vector<float> second = values_of(scene, recipe);
    for (std::size_t i = 0; i < hard.size(); ++i) {
        EXPECT_EQ(first[i], 0.25F + 0.75F * 0.5F * hard[i]);
        EXPECT_EQ(second[i], 0.5F * (0.25F + 0.75F * hard[i]));
    }
    EXPECT_GT(std::count(hard.begin(), hard.end(), 1.0F), 100);
}

}  // namespace
}  // namespace gn::frame_test
