// SPDX-License-Identifier: MIT
// What a built-in scene is: a name, a sentence, a table of parameters and a function that builds it.
#pragma once

#include "base/param.h"
#include "shadow/scene/scene.h"

#include <span>
#include <string_view>

namespace gn::scenes {

struct Generator {
    std::string_view name;
    std::string_view sentence;  ///< what it shows and what it is meant to break
    ParamTable params;
    Scene (*make)(const ParamBlock&) = nullptr;
};

// Analytic scenes, with closed forms where one exists.
const Generator& half_plane();
const Generator& slab();
const Generator& stack();
const Generator& overlap();
const Generator& tilted();
const Generator& contact();
const Generator& fence();
const Generator& corridor();
const Generator& duel();
// The showcase.
const Generator& courtyard();
// Scenes after van Sambeek 2007, sections 4.1.2 and 4.1.1.
const Generator& car();
const Generator& boxes();
const Generator& disco_box();
const Generator& island();
const Generator& warehouse_inside();
const Generator& warehouse_outside();
const Generator& grid();

}  // namespace gn::scenes
