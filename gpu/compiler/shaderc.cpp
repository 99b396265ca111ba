// SPDX-License-Identifier: MIT
// GLSL through libshaderc: the only source that knows it.
#include "gpu/glsl.h"

#include <shaderc/shaderc.hpp>

#include <algorithm>

/// Whoever links this library refers to this name, so that the linker takes the file, and the file registers itself.
extern "C" {
extern const int gn_glsl_compiler;
const int gn_glsl_compiler = 1;
}

namespace gn {
namespace {

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

class ShadercCompiler final : public GlslCompiler {
  public:
    std::vector<std::uint32_t> compile(ShaderKind kind, const std::string& name, const std::string& text,
                                       ShaderSources& sources) override {
        shaderc::CompileOptions options;
        options.SetTargetEnvironment(shaderc_target_env_vulkan, shaderc_env_version_vulkan_1_3);
        options.SetTargetSpirv(shaderc_spirv_version_1_6);
        options.SetOptimizationLevel(shaderc_optimization_level_zero);
        options.SetIncluder(std::make_unique<Includer>(sources));
        const auto result =
            compiler_.CompileGlslToSpv(text.data(), text.size(), shaderc_kind(kind), name.c_str(), options);
        if (result.GetCompilationStatus() != shaderc_compilation_status_success) {
            throw Error(error_sentence(name, result.GetErrorMessage()));
        }
        return {result.begin(), result.end()};
    }

  private:
    shaderc::Compiler compiler_;
};

const bool is_registered = [] {
    register_glsl_compiler([]() -> std::unique_ptr<GlslCompiler> { return std::make_unique<ShadercCompiler>(); });
    return true;
}();

}  // namespace
}  // namespace gn
