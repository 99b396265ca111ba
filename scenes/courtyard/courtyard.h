// SPDX-License-Identifier: MIT
// The courtyard's builders and the measures they share. Metres; the pavement is at y = 0, north is -z, east is +x.
#pragma once

#include "scenes/mesh_builder.h"

#include <fmt/format.h>

namespace gn::scenes::yard {

inline constexpr float east = 7.0F, west = -6.0F, north = -6.0F, south = 9.6F;  ///< borders of the pavement
inline constexpr float gallery_floor = 0.45F, gallery_depth = 3.0F;
inline constexpr float bay = 2.6F;             ///< from column to column
inline constexpr float spring_height = 2.65F;  ///< where arches begin
inline constexpr float arch_radius = 1.05F;
inline constexpr float eaves = 4.3F;
inline constexpr float window_sill = 1.05F;             ///< of the grilled windows
inline constexpr float spot_window_z = -7.5F;           ///< middle of the window in the west wall that hides the spot
inline constexpr vec3 lantern_at{-2.1F, 2.3F, -8.45F};  ///< centre of the flame

struct Materials {
    int paving, stone, plaster, tile, iron, wood, bark, leaves, grass, water, terracotta, brass, dark;
};
Materials add_materials(MeshBuilder& builder, Scene& scene);

void add_paving(MeshBuilder& builder, const Materials& m);
void add_arcades(MeshBuilder& builder, const Materials& m);
void add_walls(MeshBuilder& builder, const Materials& m);
void add_fence(MeshBuilder& builder, const Materials& m);
void add_tree(MeshBuilder& builder, const Materials& m);
void add_furniture(MeshBuilder& builder, const Materials& m);
void add_fountain(MeshBuilder& builder, const Materials& m);
void add_lantern(MeshBuilder& builder, const Materials& m);
void add_surroundings(MeshBuilder& builder, const Materials& m);

}  // namespace gn::scenes::yard
