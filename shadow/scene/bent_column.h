// SPDX-License-Identifier: MIT
// For tests: a glTF file of a ground, a sun, a camera, and a column on two bones of which the upper one bends over. It may have
// morph targets, too.
#pragma once

#include "shadow/scene/testing.h"

namespace gn::testing_scene {

/// The column stands from 0.2 m to 2.2 m; animation "bend" turns its upper half about z by a quarter, to -x, within one second.
/// Animation "slide" moves all of it by 1 m along x within two. With `morphs` the animation "lean" brings the weights of two
/// targets from 0 to 1 and to 0.5 within one second: 0.6 m along x for the rings above the foot, and, in a sparse accessor,
/// 0.4 m upwards for the top ring.
inline std::string bent_column(bool morphs = false) {
    constexpr float half = 0.2F, foot = 0.2F, knee = 1.2F, top = 2.2F, quarter = 0.70710678F;
    GltfText gltf;
    const int ground = gltf.add_points({-3, 0, 3, 3, 0, 3, 3, 0, -3, -3, 0, -3});
    const int ground_indices = gltf.add(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR", 5123, 6);

    // Three rings of four corners; the middle one hangs on both bones.
    std::vector<float> corners, weights;
    std::vector<std::uint8_t> joints;
    for (const float y : {foot, knee, top}) {
        for (const auto& [x, z] : {std::pair{-half, half}, {half, half}, {half, -half}, {-half, -half}}) {
            corners.insert(corners.end(), {x, y, z});
            joints.insert(joints.end(), {0, 1, 0, 0});
            const float upper = y == foot ? 0.0F : y == knee ? 0.5F : 1.0F;
            weights.insert(weights.end(), {1 - upper, upper, 0, 0});
        }
    }
    std::vector<std::uint16_t> indices;
    const auto quad = [&](unsigned a, unsigned b, unsigned c, unsigned d) {
        for (const unsigned i : {a, b, c, a, c, d}) {
            indices.push_back(static_cast<std::uint16_t>(i));
        }
    };
    quad(3, 2, 1, 0);
    quad(8, 9, 10, 11);
    for (unsigned ring : {0U, 4U}) {
        for (unsigned i = 0; i < 4; ++i) {
            quad(ring + i, ring + (i + 1) % 4, ring + 4 + (i + 1) % 4, ring + 4 + i);
        }
    }
    const int points = gltf.add_points(corners);
    const int column_indices = gltf.add(indices, "SCALAR", 5123, indices.size());
    const int joint_numbers = gltf.add(joints, "VEC4", 5121, 12);
    const int joint_weights = gltf.add(weights, "VEC4", 5126, 12);
    const int inverses = gltf.add(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,     0, 1,
                                                     1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -knee, 0, 1},
                                  "MAT4", 5126, 2);
    const int times = gltf.add(std::vector<float>{0, 1}, "SCALAR", 5126, 2);
    const int turns = gltf.add(std::vector<float>{0, 0, 0, 1, 0, 0, quarter, quarter}, "VEC4", 5126, 2);
    const int slow = gltf.add(std::vector<float>{0, 2}, "SCALAR", 5126, 2);
    const int steps = gltf.add(std::vector<float>{0, 0, 0, 1, 0, 0}, "VEC3", 5126, 2);
    std::string targets, lean;
    if (morphs) {
        const std::vector<float> none(36, 0.0F);
        std::vector<float> along = none;
        for (std::size_t v = 4; v < 12; ++v) {
            along[3 * v] = 0.6F;
        }
        const int leaning = gltf.add_points(along);
        const int ring = gltf.add(std::vector<std::uint16_t>{8, 9, 10, 11}, "SCALAR", 5123, 4);
        const int up = gltf.add_points({0, 0.4F, 0, 0, 0.4F, 0, 0, 0.4F, 0, 0, 0.4F, 0});
        const int raising = gltf.add(none, "VEC3", 5126, 12,
                                     fmt::format(R"(,"sparse":{{"count":4,"indices":{{"bufferView":{},"componentType")"
                                                 R"(:5123}},"values":{{"bufferView":{}}}}})",
                                                 ring, up)
                                         .c_str());
        const int pulls = gltf.add(std::vector<float>{0, 0, 1, 0.5F}, "SCALAR", 5126, 4);
        targets = fmt::format(R"(,"targets":[{{"POSITION":{}}},{{"POSITION":{}}}])", leaning, raising);
        lean = fmt::format(R"(,{{"name":"lean","samplers":[{{"input":{},"output":{}}}],)"
                           R"("channels":[{{"sampler":0,"target":{{"node":1,"path":"weights"}}}}]}})",
                           times, pulls);
    }

    gltf.primitives = "";
    gltf.nodes = fmt::format(
        R"({{"mesh":0,"name":"ground"}},{{"mesh":1,"skin":0,"name":"column"}},{{"name":"lower","children":[3]}},)"
        R"({{"name":"upper","translation":[0,{},0]}},)"
        R"({{"name":"sun","rotation":[-0.5,0.35,0.2,0.76],"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}},)"
        R"({{"name":"eye","camera":0,"translation":[0,4,5.5],"rotation":[-0.28,0,0,0.96]}})",
        knee);
    gltf.scene = R"("scene":0,"scenes":[{"nodes":[0,1,2,4,5]}],)";
    gltf.more = fmt::format(
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":{}}},"indices":{}}}]}},)"
        R"({{"primitives":[{{"attributes":{{"POSITION":{},"JOINTS_0":{},"WEIGHTS_0":{}}},"indices":{}{}}}]}}],)"
        R"("skins":[{{"joints":[2,3],"inverseBindMatrices":{}}}],)"
        R"("cameras":[{{"type":"perspective","perspective":{{"yfov":0.8,"znear":0.05,"zfar":100}}}}],)"
        R"("animations":[{{"name":"bend","samplers":[{{"input":{},"output":{}}}],)"
        R"("channels":[{{"sampler":0,"target":{{"node":3,"path":"rotation"}}}}]}},)"
        R"({{"name":"slide","samplers":[{{"input":{},"output":{}}}],)"
        R"("channels":[{{"sampler":0,"target":{{"node":2,"path":"translation"}}}}]}}{}],)"
        R"("extensionsUsed":["KHR_lights_punctual"],"extensions":{{"KHR_lights_punctual":{{"lights":)"
        R"([{{"type":"directional","intensity":10000,"name":"sun"}}]}}}},)",
        ground, ground_indices, points, joint_numbers, joint_weights, column_indices, targets, inverses, times, turns,
        slow, steps, lean);
    return gltf.text();
}

}  // namespace gn::testing_scene
