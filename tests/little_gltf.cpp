// SPDX-License-Identifier: MIT
#include "tests/little_gltf.h"

#include <array>

namespace gn::test {

LittleGltf::LittleGltf() {
    material(R"("name":"ground")");
}

int LittleGltf::material(const std::string& members) {
    materials_.push_back("{" + members +
                         (members.find("doubleSided") == std::string::npos ? R"(,"doubleSided":true})" : "}"));
    return static_cast<int>(materials_.size()) - 1;
}

void LittleGltf::add(const std::vector<vec3>& corners, int material, const std::string& node, const std::string& mesh,
                     const std::vector<vec4>& colors) {
    std::vector<float> xyz;
    for (const vec3& p : corners) {
        xyz.insert(xyz.end(), {p.x, p.y, p.z});
    }
    const int accessor = text_.add_points(xyz);
    const std::string tint =
        colors.empty() ? "" : fmt::format(R"(,"COLOR_0":{})", text_.add(colors, "VEC4", 5126, colors.size()));
    meshes_.push_back(fmt::format(R"({{"primitives":[{{"attributes":{{"POSITION":{}{}}},"material":{}}}]{}}})",
                                  accessor, tint, material, mesh));
    nodes_.push_back(fmt::format(R"({{"mesh":{}{}}})", meshes_.size() - 1, node));
}

void LittleGltf::light(const std::string& type, vec3 at, const std::string& rotation) {
    lights_.push_back(fmt::format(R"({{"type":"{}","intensity":400,"name":"lamp"}})", type));
    nodes_.push_back(fmt::format(
        R"({{"name":"lamp","translation":[{},{},{}],"rotation":{},"extensions":{{"KHR_lights_punctual":{{"light":{}}}}}}})",
        at.x, at.y, at.z, rotation, lights_.size() - 1));
}

void LittleGltf::camera(vec3 at, float sine, float cosine) {
    nodes_.push_back(fmt::format(R"({{"camera":0,"translation":[{},{},{}],"rotation":[{},0,0,{}]}})", at.x, at.y, at.z,
                                 sine, cosine));
}

std::string LittleGltf::text() const {
    std::vector<std::size_t> roots(nodes_.size());
    for (std::size_t i = 0; i < roots.size(); ++i) {
        roots[i] = i;
    }
    testing_scene::GltfText text = text_;
    text.primitives = "";
    text.nodes = fmt::format("{}", fmt::join(nodes_, ","));
    text.scene = fmt::format(R"("scene":0,"scenes":[{{"nodes":[{}]}}],)", fmt::join(roots, ","));
    text.more = fmt::format(
        R"("meshes":[{}],"materials":[{}],"cameras":[{{"type":"perspective","perspective":{{"yfov":0.8,"znear":0.05,"zfar":100}}}}],)"
        R"("extensionsUsed":["KHR_lights_punctual"],"extensions":{{"KHR_lights_punctual":{{"lights":[{}]}}}},)",
        fmt::join(meshes_, ","), fmt::join(materials_, ","), fmt::join(lights_, ","));
    return text.text();
}

Scene LittleGltf::load() const {
    const testing_scene::TempFolder folder;
    return load_scene(folder.write("little.gltf", text()));
}

std::vector<vec3> quad(vec3 a, vec3 b, vec3 c, vec3 d) {
    return {a, b, c, a, c, d};
}

std::vector<vec3> level(vec3 centre, float half, bool upwards) {
    const vec3 x(half, 0, 0);
    const vec3 z(0, 0, half);
    return upwards ? quad(centre - x + z, centre + x + z, centre + x - z, centre - x - z)
                   : quad(centre - x - z, centre + x - z, centre + x + z, centre - x + z);
}

std::vector<vec3> box(vec3 low, vec3 high, bool outwards) {
    const auto at = [&](int i) {
        return vec3((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z);
    };
    constexpr std::array<std::array<int, 4>, 6> faces{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    std::vector<vec3> corners;
    for (const auto& f : faces) {
        const std::vector<vec3> face =
            outwards ? quad(at(f[0]), at(f[1]), at(f[2]), at(f[3])) : quad(at(f[3]), at(f[2]), at(f[1]), at(f[0]));
        corners.insert(corners.end(), face.begin(), face.end());
    }
    return corners;
}

Ground on_ground(const Comparison& c, std::span<const float> v) {
    Ground ground;
    for (std::size_t i = 0; i < v.size(); ++i) {
        if (c.truth.counted[i] != 0 && std::abs(c.frame.samples.position_ws[i].y) < 1e-4F) {
            ground.mean += static_cast<double>(v[i]);
            ++ground.samples;
        }
    }
    ground.mean /= static_cast<double>(std::max<std::size_t>(ground.samples, 1));
    return ground;
}

}  // namespace gn::test
