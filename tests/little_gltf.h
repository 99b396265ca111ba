// SPDX-License-Identifier: MIT
// For tests: small glTF worlds of quads, lamps and one camera, written as text.
#pragma once

#include "shadow/scene/testing.h"
#include "tests/rig.h"

namespace gn::test {

class LittleGltf {
  public:
    LittleGltf();

    /// `members` of the material without its braces; returns its index. Material 0 is a grey that both sides show.
    int material(const std::string& members);

    /// A node with a mesh of its own. `node` and `mesh` are further members, each with a comma before; `colors` are the
    /// corners' own.
    void add(const std::vector<vec3>& corners, int material, const std::string& node = "", const std::string& mesh = "",
             const std::vector<vec4>& colors = {});

    /// A lamp without extent; `type` is point or directional, the sun shines straight down unless turned.
    void light(const std::string& type, vec3 at, const std::string& rotation = "[-0.70710678,0,0,0.70710678]");

    /// A camera at `at` that is turned down (or up) by a quarter turn's sine and cosine of half the angle.
    void camera(vec3 at, float sine, float cosine);

    [[nodiscard]] std::string text() const;
    /// The scene, through a file of its own.
    [[nodiscard]] Scene load() const;

  private:
    testing_scene::GltfText text_;
    std::vector<std::string> materials_, meshes_, nodes_, lights_;
};

/// Two triangles; the front shows where a, b, c, d run counter-clockwise.
std::vector<vec3> quad(vec3 a, vec3 b, vec3 c, vec3 d);
/// A level square that shows its front upwards, or downwards.
std::vector<vec3> level(vec3 centre, float half, bool upwards = true);
/// A box whose six faces show outwards, or inwards.
std::vector<vec3> box(vec3 low, vec3 high, bool outwards = true);

/// Counted samples on the ground (y = 0), and the mean of V over them.
struct Ground {
    std::size_t samples = 0;
    double mean = 0;
};
Ground on_ground(const Comparison& c, std::span<const float> v);

}  // namespace gn::test
