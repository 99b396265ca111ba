// SPDX-License-Identifier: MIT
#include "gpu/shader.h"

#include "gpu/glsl.h"
#include "gpu/hash.h"
#include "gpu/shader_cache.h"
#include "gpu/shader_sources.h"
#include "gpu/spirv.h"

namespace gn {
namespace {

/// Lines before every shader; raise the version when it or the compiler's options change.
constexpr std::uint32_t recipe_version = 1;

std::string prologue(ShaderKind kind) {
    std::string text =
        "#version 460\n"
        "#extension GL_GOOGLE_include_directive : require\n"
        "#extension GL_EXT_scalar_block_layout : require\n";
    if (kind == ShaderKind::vertex) {
        text += "#extension GL_ARB_shader_viewport_layer_array : require\n";
    }
    return text + "#line 1\n";
}

}  // namespace

struct ShaderCompiler::Impl {
    ShaderSources sources;
    ShaderCache cache;
    std::unique_ptr<GlslCompiler> compiler;  ///< made at the first miss: its tables cost a tenth of a second
    std::map<Fingerprint, CompiledShader> compiled;

    Impl(std::filesystem::path root, std::filesystem::path folder)
        : sources(std::move(root)), cache(std::move(folder)) {}

    std::vector<std::uint32_t> translate(const ShaderSource& source) {
        const std::string name = source.name.empty() ? "shader" : source.name;
        compiler = compiler ? std::move(compiler) : make_glsl_compiler();
        if (!compiler) {
            fail("shader '{}' cannot be compiled: this program links no compiler of GLSL (gn_compiler)", name);
        }
        return compiler->compile(source.kind, name, prologue(source.kind) + source.text, sources);
    }
};

ShaderCompiler::ShaderCompiler(std::filesystem::path include_root, std::filesystem::path cache_folder)
    : impl_(std::make_unique<Impl>(std::move(include_root), std::move(cache_folder))) {}

ShaderCompiler::~ShaderCompiler() = default;

const CompiledShader& ShaderCompiler::compile(const ShaderSource& source) {
    // Ask this process first, by the text alone.
    const Fingerprint here = source.fingerprint.value_or(source.work_out());
    if (const auto found = impl_->compiled.find(here); found != impl_->compiled.end()) {
        return found->second;
    }

    // Then the disk, by everything the text can reach.
    Hasher hasher;
    hasher.value(recipe_version).value(source.kind).text(prologue(source.kind));
    impl_->sources.fingerprint(hasher, source.text);
    const Fingerprint key = hasher.finish();
    std::vector<std::uint32_t> spirv = impl_->cache.load(key);
    if (spirv.empty()) {
        spirv = impl_->translate(source);
        impl_->cache.store(key, spirv);
    }

    // The interface is read from the code either way.
    Reflection reflection = reflect(spirv, source.name);
    CompiledShader shader{source.kind, source.name, std::move(spirv), std::move(reflection.bindings),
                          reflection.push_constant_bytes};
    return impl_->compiled.emplace(here, std::move(shader)).first->second;
}

}  // namespace gn
