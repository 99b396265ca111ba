// SPDX-License-Identifier: MIT
// Where the program's own files are: recipes, shaders, report templates.
#pragma once

#include <filesystem>

namespace gn {

/// The folder that holds recipes/ and the shader includes (shadow/..., base/...): $GNOMON_DATA, else
/// ../share/gnomon beside the executable, else the source tree that the program was built from. Throws Error.
const std::filesystem::path& data_root();

/// A writable folder for caches: $GNOMON_CACHE, else $XDG_CACHE_HOME/gnomon, else ~/.cache/gnomon; empty when none is
/// writable, and then nothing is cached.
const std::filesystem::path& cache_root();

}  // namespace gn
