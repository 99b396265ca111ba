// SPDX-License-Identifier: MIT
// Depth maps from the points of a light, one after the other in one set of resources, for maps that are made of what many
// points see.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/recipe/recipe.h"
#include "shadow/stages.h"

#include <functional>
#include <string>

namespace gn {

/// The map of one point of the light, placed and drawn as the recipe would for a light of its own.
struct PointMap {
    FrameInput input;  ///< of the point; its whole light is the light
    LightViews views;
    TextureHandle depth;  ///< D32, the views' layers
    int index = 0, count = 1;
};
/// Hands the maps of `count` points (shadow/scene/light_samples.h) to `use`, in their order; of a light without extent there is
/// one. The next one takes the place of the one before.
void add_point_maps(const FrameInput& input, const Recipe& recipe, int count,
                    const std::function<void(const PointMap&)>& use);

/// The sentence why a map `id` that takes the light's points by itself cannot serve the light, or "".
std::string refuses_points(std::string_view id, const Light& light, const Recipe& recipe);

/// What shaders read that look into the map of a point for the views of the whole light: sample_inputs of the point, its
/// `point_depth`, and the block `CentreViews`.
ShaderInputs point_inputs(const PointMap& map, const Recipe& recipe, const LightViews& centre);
/// GLSL before the inputs' text, and after it: bool gn_point_sees(vec3 p_ws, vec3 n_ws), which compares as the lookup `hard`
/// does, with the recipe's bias; true where no view of the point sees it.
std::string point_includes(const PointMap& map, const Recipe& recipe, const LightViews& centre);
std::string point_functions(const PointMap& map, const Recipe& recipe);

}  // namespace gn
