// SPDX-License-Identifier: MIT
// Files whose z points up: a sign by which they show, and the turn that stands them up.
#pragma once

#include "shadow/scene/model.h"

namespace gn {

/// x stays, z becomes y, y becomes -z.
dmat4 y_up_from_z_up();

/// Whether the model stands on its plane of least z and on nothing at its least y: a floor faces +z there, or feet stand apart.
bool lies_on_its_side(const Model& model);

/// Adds a note where it does and brings neither light nor camera, which would show what its maker saw as upright.
void note_side(Model& model);

}  // namespace gn
