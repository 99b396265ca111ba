// SPDX-License-Identifier: MIT
#include "tests/lookup_by_hand.h"

namespace gn::test {

std::vector<float> visibility_of(const Scene& scene, const Recipe& recipe, uint pixels) {
    const ValidationGuard guard;
    SceneGpu gpu = upload_scene(device(), scene);
    const FrameResult frame = render_frame(device(), gpu, scene.camera(""), recipe,
                                           {.width = pixels, .height = pixels, .only_light = 0, .picture = false});
    EXPECT_EQ(frame.refused.front(), "");
    return frame.visibility.front().values;
}

Part lookup_by_hand(const std::string& body) {
    static std::string text;
    text = fmt::format(
        "#include \"shadow/receiver/map_access.glsl\"\n"
        "bool gn_by_hand_lit(GnLookup at, sampler2DArray depth, ivec2 texel) {{\n"
        "    vec2 middle_ts = (vec2(texel) + 0.5) * at.projected.texel_ts;\n"
        "    float occluder = texelFetch(depth, ivec3(texel, at.projected.layer), 0).r;\n"
        "    return gn_depth_at(at.projected, middle_ts, at.bias) <= occluder;\n}}\n"
        "#define lit(texel) gn_by_hand_lit(at, depth, texel)\n"
        "float gn_by_hand_visibility(GnLookup at, sampler2DArray depth) {{\n{}\n}}\n",
        body);
    Part by_hand;
    by_hand.id = "by-hand";
    by_hand.stage = Stage::lookup;
    by_hand.needs = {"depth"};
    by_hand.prologue = [](const Recipe&) { return text; };
    return by_hand;
}

std::vector<float> visibility_by_hand(const Scene& scene, Recipe recipe, const std::string& body, uint pixels) {
    Part by_hand = lookup_by_hand(body);
    by_hand.guard = recipe.lookup->guard;
    recipe.lookup = &by_hand;
    return visibility_of(scene, recipe, pixels);
}

}  // namespace gn::test
