// SPDX-License-Identifier: MIT
#include "gpu/glsl.h"

#include <utility>

namespace gn {
namespace {

// Known before any compiler registers itself: it needs no code to begin.
constinit MakeGlslCompiler registered = nullptr;

}  // namespace

MakeGlslCompiler register_glsl_compiler(MakeGlslCompiler make) {
    return std::exchange(registered, make);
}

bool has_glsl_compiler() {
    return registered != nullptr;
}

std::unique_ptr<GlslCompiler> make_glsl_compiler() {
    return registered != nullptr ? registered() : nullptr;
}

}  // namespace gn
