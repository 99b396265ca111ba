// SPDX-License-Identifier: MIT
// Where in a light's view the camera sees receivers: casters whose shadow falls beside all of them need not be drawn.
//
// Based on: Bittner, Mattausch, Silvennoinen, Wimmer. Shadow Caster Culling for Efficient Shadow Mapping. I3D 2011. [BMSW11]
// Departs from it: the mask is drawn on the CPU from the bounds of what the frustum holds, without occlusion queries, so that
// views know their casters before anything is recorded. A hidden receiver counts as seen.
#pragma once

#include "shadow/geometry/convex_body.h"
#include "shadow/recipe/guard.h"
#include "shadow/stages.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace gn {

/// The rectangle of an affine view in 64 x 64 cells.
class ReceiverMask {
  public:
    /// `guard` is how far around a receiver its kernel reads; `light` says across which rays metres count.
    ReceiverMask(const GnLightView& view, const GnLight& light, const Guard& guard);
    /// Marks what a convex body of receivers may read of the map; points in world space.
    void add(std::span<const dvec3> corners_ws);
    /// Whether what lies in the box may be drawn into a marked cell. Never false for what is.
    [[nodiscard]] bool meets(const Box& box_ws) const;
    /// Share of the cells that are marked.
    [[nodiscard]] double share() const;

  private:
    static constexpr int cells = 64;
    /// Cells that a convex outline, widened by so many cells, touches: first and last of each row; last < first where none.
    struct Row {
        int first = cells, last = -1;
    };
    [[nodiscard]] std::array<Row, cells> rows_of(std::span<const dvec3> points_ws, dvec2 reach) const;

    dmat4 cs_from_ws_{1};
    dvec2 kernel_{0}, rounding_{0};  ///< in cells
    dvec3 x_ws_{0}, y_ws_{0};        ///< of the kernel's metres, across the rays
    std::array<std::uint64_t, cells> marked_{};
};

/// The guard with what biases move receivers by across the rays of an affine view.
Guard with_bias(Guard guard, const GnBias& bias, const GnLightView& view);

/// What of `casters` can be drawn where the camera sees receivers between two distances along its axis.
std::vector<std::uint32_t> casters_on_receivers(const FrameInput& input, const GnLightView& view, const Guard& guard,
                                                double near, double far, const std::vector<std::uint32_t>& casters);

}  // namespace gn
