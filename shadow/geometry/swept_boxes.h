// SPDX-License-Identifier: MIT
// What the shadows of boxes can fall on: asked for each component of a mesh, so that all that a light and a view decide for
// every box is worked out once.
#pragma once

#include "base/math.h"
#include "shadow/scene/light.h"

#include <array>
#include <optional>

namespace gn {

/// A box swept away from a light without end. Every answer is safe: never false where it can be.
class SweptBoxes {
  public:
    /// `cs_from_ws` null: the view sees all there is, and its near rectangle may lie anywhere.
    SweptBoxes(const GnLight& light, const mat4* cs_from_ws);
    /// Whether the shadow of something in the box can fall on what the view sees and the light reaches.
    [[nodiscard]] bool may_shade_view(const Box& box) const;
    /// Whether it can fall on the view's near rectangle.
    [[nodiscard]] bool may_shade_near_plane(const Box& box) const;
    /// Whether nothing in the box, nor behind it, counts for the light: it is out of range, beside the cone or behind the rectangle.
    [[nodiscard]] bool beyond_light(const Box& box) const;
    /// Whether nothing in the box is seen.
    [[nodiscard]] bool out_of_sight(const Box& box) const;
    /// Corners of the near rectangle, ws; none where no view is given.
    [[nodiscard]] std::optional<std::array<dvec3, 4>> near_corners_ws() const { return near_ws_; }

  private:
    /// A direction that may separate a box from what lies between the near rectangle and the light, and the heights between
    /// which that lies.
    struct Axis {
        dvec3 way_ws{0}, abs_ws{0};
        double low = 0, high = 0;
    };
    void add_axis(dvec3 way_ws);

    GnLight light_;
    dvec4 light_ws_;
    double cone_ = 0;  ///< half angle of a spot, radians
    std::optional<std::array<dvec4, 6>>
        planes_ws_;  ///< of the view: left, right, bottom, top, near, far; positive inside
    std::optional<std::array<dvec3, 4>> near_ws_;
    std::array<Axis, 30> axes_;
    std::size_t axis_count_ = 0;
};

}  // namespace gn
