// SPDX-License-Identifier: MIT
// Shaders that are edited while a program runs, in development.
#pragma once

#include "gpu/device.h"

#include <cstddef>
#include <memory>

namespace gn {

struct Reloaded {
    std::size_t shaders = 0;  ///< whose code is another one now
    std::shared_ptr<const void>
        before;  ///< the pipelines that were replaced: hold it until the device has done with them
};

/// Compiles again what include files changed of, and makes its pipelines anew. Throws Error with the compiler's sentence, or
/// why there is no pipeline; then everything stays as it was, and the next call tries again.
Reloaded reload_shaders(Device& device);

}  // namespace gn
