// SPDX-License-Identifier: MIT
// What a compiled module asks for: the bindings of set 0 that its code uses, and its push constants.
#pragma once

#include "gpu/shader.h"

#include <span>

namespace gn {

struct Reflection {
    std::map<std::string, ShaderBinding, std::less<>> bindings;
    std::uint32_t push_constant_bytes = 0;
};

/// Reads the module. Variables that no function touches are left out. Throws Error naming `what` for a malformed
/// module, a set other than 0, or an array of resources.
Reflection reflect(std::span<const std::uint32_t> spirv, const std::string& what);

}  // namespace gn
