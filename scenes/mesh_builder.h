// SPDX-License-Identifier: MIT
// Builds a scene out of solids: boxes, lathes, tubes, prisms and arcade walls, each a closed mesh with outward winding.
//
// A solid's faces may split their vertices for normals and texture coordinates, but corners that coincide carry
// bit-identical positions, so that adjacency found by position is complete. Open sheets are the exception; by
// convention the names of objects that hold any end in "(sheet)".
#pragma once

#include "shadow/scene/scene.h"

#include <span>
#include <string>
#include <vector>

namespace gn::scenes {

class MeshBuilder {
  public:
    /// Appends to `scene`, which must outlive the builder.
    explicit MeshBuilder(Scene& scene) : scene_(scene) {}

    /// Adds a material and returns its index.
    int material(std::string name, vec3 linear_rgb, float roughness = 0.8F, float metallic = 0.0F, int texture = -1);
    /// Adds a texture and returns its index.
    int texture(Texture texture);

    /// Starts an object; what follows belongs to it. Texture coordinates are `repeats_per_metre` times the metres
    /// along a face.
    void begin(std::string name, int material, float repeats_per_metre = 1.0F);
    /// Places the shapes that follow: ws_from_os must be a rotation, a translation and a scale, without mirroring.
    void place(const mat4& ws_from_os);
    /// Places at a point, turned by `yaw` radians about +y.
    void place(vec3 position_ws, float yaw = 0.0F);
    [[nodiscard]] const mat4& placement() const { return ws_from_os_; }
    /// Closes the last object and fills the scene's bounds.
    void finish();

    /// A sheet: the parallelogram at `corner` with normal cross(edge_u, edge_v). Its uv run from 0 to 1 when `unit_uv`.
    void sheet(vec3 corner, vec3 edge_u, vec3 edge_v, bool unit_uv = false);
    void box(vec3 low, vec3 high);
    /// A box whose top edges are cut at 45 degrees by `chamfer` metres.
    void chamfered_slab(vec3 low, vec3 high, float chamfer);
    /// A solid of revolution about +y: (radius, height) from the bottom, outside, to the top; ends off the axis are
    /// capped. Corners sharper than 40 degrees stay sharp.
    void lathe(std::span<const vec2> profile, int sides);
    /// A ring about +y: a torus of tube radius `tube`.
    void ring(float radius, float height, float tube, int sides, int tube_sides);
    /// A tube through `path` with a radius at each point, capped at both ends.
    void tube(std::span<const vec3> path, std::span<const float> radii, int sides);
    void rod(vec3 from, vec3 to, float radius, int sides = 8);
    void sphere(vec3 centre, float radius, int sides);
    /// A convex outline (counter-clockwise seen from +z) in the xy plane, extruded from z = 0 to z = depth.
    void prism(std::span<const vec2> outline, float depth);
    /// A wall of thickness `depth` in the xy plane from z = 0: its lower border follows `underside` (x increasing),
    /// its top is level at `top`. Faces of the underside are smooth within 40 degrees.
    void wall_over(std::span<const vec2> underside, float top, float depth);
    /// A leaf-like blade along `ridge`, `half_widths` to either side of it in z, `thickness` metres deep in y.
    void blade(std::span<const vec3> ridge, std::span<const float> half_widths, float thickness);
    /// Raw access, for height fields and cards.
    std::uint32_t vertex(vec3 p_os, vec3 n_os, vec2 uv);
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  private:
    void face(vec3 a, vec3 b, vec3 c, vec3 d);
    void polygon(std::span<const vec3> corners, vec3 n_os);
    void close_object();

    Scene& scene_;
    mat4 ws_from_os_{1.0F};
    float repeats_ = 1.0F;
    bool open_ = false;
};

}  // namespace gn::scenes
