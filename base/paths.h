// SPDX-License-Identifier: MIT
// Where the program's own files are: recipes, shaders, report templates.
#pragma once

#include <cstdint>
#include <filesystem>

namespace gn {

/// The folder that holds recipes/ and the shader includes (shadow/..., base/...): $GNOMON_DATA, else
/// ../share/gnomon beside the executable, else the source tree that the program was built from. Throws Error.
const std::filesystem::path& data_root();

/// A writable folder for caches: $GNOMON_CACHE, else $XDG_CACHE_HOME/gnomon, else ~/.cache/gnomon; empty when none is
/// writable, and then nothing is cached.
const std::filesystem::path& cache_root();

/// Whether `bytes` can be written into the folder, or into the nearest one above it that is there: they are reserved once
/// and given back, so that quotas count as well as full disks.
bool has_room(const std::filesystem::path& folder, std::uintmax_t bytes);

}  // namespace gn
