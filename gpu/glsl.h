// SPDX-License-Identifier: MIT
// The compiler of GLSL: a piece that a program links, or leaves out where its shaders were baked. The library gn_compiler
// registers the one that it holds (gpu/compiler/shaderc.cpp); without it nothing here knows how to compile.
#pragma once

#include "gpu/shader.h"
#include "gpu/shader_sources.h"

#include <memory>

namespace gn {

class GlslCompiler {
  public:
    virtual ~GlslCompiler() = default;
    /// SPIR-V 1.6 for Vulkan 1.3 of a whole text, `#version` and all, named for messages; its includes come from `sources`.
    /// Throws Error with one sentence: the shader, the file and line, the compiler's first complaint.
    virtual std::vector<std::uint32_t> compile(ShaderKind kind, const std::string& name, const std::string& text,
                                               ShaderSources& sources) = 0;
};

using MakeGlslCompiler = std::unique_ptr<GlslCompiler> (*)();
/// What make_glsl_compiler calls from now on; gives what it called before. Called before main by a compiler that is linked.
MakeGlslCompiler register_glsl_compiler(MakeGlslCompiler make);
/// Whether the program has a compiler.
bool has_glsl_compiler();
/// Null where none was registered.
std::unique_ptr<GlslCompiler> make_glsl_compiler();

}  // namespace gn
