// SPDX-License-Identifier: MIT
// What the command line names inside a scene, and what it says of the device before there is one.
#pragma once

#include "apps/options.h"
#include "shadow/recipe/recipe.h"
#include "shadow/scene/rig.h"

#include <optional>

namespace gn {

/// How a scene is loaded for a picture of this size with the ground that --ground asks for.
LoadOptions load_options(const FileOptions& file, const Size& size);

/// The scene that the command line names, moved to where --animation and --time say. Throws Error.
AnimatedScene load_asked(const std::string& scene, const FileOptions& file, const Size& size);

/// Moves it to a time of an animation; "" is at rest. What must be said of it, one sentence each. Throws Error.
std::vector<std::string> pose_asked(AnimatedScene& loaded, const std::string& animation, double seconds);

/// The index of the light that --light names. Throws Error listing the scene's lights.
std::size_t find_light(const Scene& scene, const std::string& name);

/// The camera path that --path names; "" is the scene's first. Throws Error listing the scene's paths.
const CameraPath& find_path(const Scene& scene, const std::string& name);

/// How many threads a software device has, which it reads once, when it is made; 0 leaves it to the device.
void set_device_threads(int threads);

/// A shipped recipe, or nothing, with a warning on standard error, where it names what is not there.
std::optional<Recipe> recipe_if_sound(const std::string& name);

}  // namespace gn
