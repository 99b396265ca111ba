// SPDX-License-Identifier: MIT
// Backprojection of some samples, others interpolated between them.
#pragma once

#include "shadow/recipe/recipe.h"

namespace gn {

/// V of all samples. `footprint` tells how far apart samples may be looked up (gn_back_told), `lookup` gives V of those it is given:
/// both run by the shared resolve pass.
Visibility add_sparse(const FrameInput& input, const Recipe& recipe, const LightViews& views, const ShadowMap& map,
                      const Part& footprint, const Part& lookup);

}  // namespace gn
