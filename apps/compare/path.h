// SPDX-License-Identifier: MIT
// Flicker and error of one recipe along a camera path.
#pragma once

#include "apps/compare/measure.h"

namespace gn {

/// Draws every frame of the view's path, one after the other with one history as a game does, and holds T - R of each
/// against that of the frame before. Fills `flicker` and `path_rmse` of the run and of its lights that were served.
void measure_path(RunResult& run, ViewSession& view, Bench& bench, const PreparedRecipe& recipe);

}  // namespace gn
