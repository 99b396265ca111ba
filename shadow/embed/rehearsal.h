// SPDX-License-Identifier: MIT
// Which shaders a recipe's frames bind, found by declaring frames of every kind that a renderer may lend and looking at what
// they would bind: nobody keeps a list. Nothing is drawn, and nothing compiled.
#pragma once

#include "gpu/described_device.h"
#include "gpu/shader.h"

#include <map>
#include <set>
#include <vector>

namespace gn::embed {

struct Rehearsal {
    std::map<Fingerprint, ShaderSource> shaders;  ///< by baked_key
    std::set<DeviceTrait> asked;                  ///< what texts may depend on: each was answered with yes and with no
    std::vector<std::string> refused;  ///< why some lights have no shadow whatever the device: a sentence each
};

/// Every kind of light, small and large, beside, before and behind the camera; both projections; one-sided casters and others;
/// all forms of depth and normals; first, still and moving frames; every answer that a device may give. Buffers are made on
/// `device`, whose own features do not count. Throws Error where the recipe cannot be embedded, or serves no light.
Rehearsal rehearse(Device& device, const std::string& recipe);

}  // namespace gn::embed
