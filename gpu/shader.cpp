// SPDX-License-Identifier: MIT
#include "gpu/shader.h"

#include "gpu/hash.h"
#include "gpu/shader_cache.h"
#include "gpu/shader_sources.h"
#include "gpu/spirv.h"

#include <shaderc/shaderc.hpp>

#include <algorithm>

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

shaderc_shader_kind shaderc_kind(ShaderKind kind) {
    switch (kind) {
        case ShaderKind::vertex: return shaderc_vertex_shader;
        case ShaderKind::fragment: return shaderc_fragment_shader;
        case ShaderKind::geometry: return shaderc_geometry_shader;
        case ShaderKind::compute: break;
    }
    return shaderc_compute_shader;
}

/// Hands the root's files to shaderc under their own names, so that messages carry them.
class Includer : public shaderc::CompileOptions::IncluderInterface {
  public:
    explicit Includer(ShaderSources& sources) : sources_(sources) {}

    shaderc_include_result* GetInclude(const char* requested, shaderc_include_type, const char*, size_t) override {
        auto* answer = new Answer;
        answer->name = requested;
        if (const std::string* text = sources_.read(answer->name)) {
            answer->text = *text;
        } else {
            answer->text = fmt::format("there is no file '{}' below the shader root", requested);
            answer->name.clear();
        }
        answer->result = {answer->name.data(), answer->name.size(), answer->text.data(), answer->text.size(), answer};
        return &answer->result;
    }
    void ReleaseInclude(shaderc_include_result* result) override { delete static_cast<Answer*>(result->user_data); }

  private:
    struct Answer {
        shaderc_include_result result{};
        std::string name, text;
    };
    ShaderSources& sources_;
};

/// One sentence from shaderc's lines: the first error with its place, and how many follow.
std::string error_sentence(const std::string& name, const std::string& log) {
    static constexpr std::string_view mark = ": error: ";
    std::string first;
    std::size_t more = 0;
    for (std::size_t begin = 0; begin < log.size();) {
        const std::size_t end = std::min(log.find('\n', begin), log.size());
        const std::string line = log.substr(begin, end - begin);
        begin = end + 1;
        const std::size_t at = line.find(mark);
        if (at == std::string::npos) {
            continue;
        }
        if (!first.empty()) {
            ++more;
            continue;
        }
        first = line.substr(0, at) + ": " + line.substr(at + mark.size());
    }
    if (first.empty()) {
        first = log.substr(0, log.find('\n'));
    }
    return fmt::format("shader '{}' does not compile: {}{}", name, first,
                       more > 0 ? fmt::format(" (and {} more)", more) : "");
}

}  // namespace

struct ShaderCompiler::Impl {
    ShaderSources sources;
    ShaderCache cache;
    std::unique_ptr<shaderc::Compiler> compiler;  ///< made at the first miss: its tables cost a tenth of a second
    std::map<Fingerprint, CompiledShader> compiled;

    Impl(std::filesystem::path root, std::filesystem::path folder)
        : sources(std::move(root)), cache(std::move(folder)) {}

    std::vector<std::uint32_t> translate(const ShaderSource& source) {
        if (!compiler) {
            compiler = std::make_unique<shaderc::Compiler>();
        }
        shaderc::CompileOptions options;
        options.SetTargetEnvironment(shaderc_target_env_vulkan, shaderc_env_version_vulkan_1_3);
        options.SetTargetSpirv(shaderc_spirv_version_1_6);
        options.SetOptimizationLevel(shaderc_optimization_level_zero);
        options.SetIncluder(std::make_unique<Includer>(sources));
        const std::string text = prologue(source.kind) + source.text;
        const std::string name = source.name.empty() ? "shader" : source.name;
        const auto result =
            compiler->CompileGlslToSpv(text.data(), text.size(), shaderc_kind(source.kind), name.c_str(), options);
        if (result.GetCompilationStatus() != shaderc_compilation_status_success) {
            throw Error(error_sentence(name, result.GetErrorMessage()));
        }
        return {result.begin(), result.end()};
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
