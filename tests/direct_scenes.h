// SPDX-License-Identifier: MIT
// Small scenes put together by hand, and the comparison of a direct part with the traced hard shadow on them.
#pragma once

#include "tests/rig.h"

namespace gn::by_hand {

using test::device;

/// A scene under construction; every shape is an object of its own.
class SceneBuilder {
  public:
    SceneBuilder();
    SceneBuilder& mesh(const std::vector<vec3>& corners, const std::vector<uvec3>& triangles, int material = 0,
                       const std::vector<vec2>& uvs = {});
    /// Corners in order around; uv (0,0), (1,0), (1,1), (0,1).
    SceneBuilder& quad(vec3 a, vec3 b, vec3 c, vec3 d, int material = 0);
    SceneBuilder& ground(float half, float y = 0.0F);
    /// Windings outwards, or inwards when `inverted`. Each face has its own four vertices, as exporters write them.
    SceneBuilder& box(vec3 low, vec3 high, bool inverted = false);
    /// A closed ring around the y axis with `n` by `n` facets, welded.
    SceneBuilder& torus(vec3 centre, float radius, float tube, std::uint32_t n);
    /// Triangles without any connection, of about `size`, in the box.
    SceneBuilder& soup(Box box, float size, int count, unsigned seed);
    SceneBuilder& light(const GnLight& shape);
    SceneBuilder& camera(vec3 from, vec3 at, float near = 0.1F, float far = 500.0F);
    /// Objects that follow may name the material by the returned index.
    int material(const Material& material, const Texture* texture = nullptr);
    [[nodiscard]] const Scene& scene() const { return scene_; }

  private:
    Scene scene_;
};

GnLight sun(vec3 direction);
GnLight point(vec3 at);
GnLight spot(vec3 at, vec3 target, float half_angle);
/// A rectangle of no extent: its centre is all there is, so that the hard shadow is the truth.
GnLight rectangle(vec3 at, vec3 target);

/// Boxes, a torus, loose triangles, a one-sided board and a leaf with holes over a ground, before a camera and without a light.
SceneBuilder garden();
/// The same under a sun, a lamp and a spot of some extent: what frames are made of, in few triangles.
Scene lit_garden();
/// A box above a ground, under a sun.
Scene box_on_ground();

Recipe direct_recipe(const Part& part, const std::vector<std::pair<std::string, std::string>>& values = {});

/// How a part's V differs from the traced V over the counted samples away from the edges of the shadow.
struct Comparison {
    std::size_t judged = 0, lit = 0, shadowed = 0, wrong = 0, edge = 0;
    std::string first;  ///< the first wrong sample, with all that is needed to look at it
};

Comparison judge(const Scene& scene, const FrameResult& frame, std::size_t light);

/// Renders the scene's first camera and judges every light; fails on any validation message and on any refusal.
std::vector<Comparison> render_and_judge(const Scene& scene, const Recipe& recipe, uint width = 160, uint height = 120);

}  // namespace gn::by_hand
