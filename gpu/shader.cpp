// SPDX-License-Identifier: MIT
#include "gpu/shader.h"

#include "base/paths.h"
#include "gpu/baked_shaders.h"
#include "gpu/glsl.h"
#include "gpu/hash.h"
#include "gpu/shader_cache.h"
#include "gpu/shader_sources.h"
#include "gpu/spirv.h"

#include <utility>

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

/// What a source and the prologue before it say, without the include files.
Fingerprint baked_key(const ShaderSource& source, const Fingerprint& of_source) {
    return Hasher()
        .value(recipe_version)
        .text(prologue(source.kind))
        .value(of_source.low)
        .value(of_source.high)
        .finish();
}

Fingerprint fingerprint_of(const ShaderSource& source) {
    return source.fingerprint ? *source.fingerprint : source.work_out();
}

/// The interface is read from the code, whoever made it.
CompiledShader described(const ShaderSource& source, std::vector<std::uint32_t> spirv) {
    Reflection reflection = reflect(spirv, source.name);
    return {source.kind, source.name, std::move(spirv), std::move(reflection.bindings), reflection.push_constant_bytes};
}

}  // namespace

Fingerprint baked_key(const ShaderSource& source) {
    return baked_key(source, fingerprint_of(source));
}

struct ShaderCompiler::Impl {
    /// A compiled source; what it was made of is kept where it may be made again.
    struct Entry {
        CompiledShader shader;
        ShaderSource source{};
        Fingerprint key{};  ///< of all that the source can reach
    };

    std::shared_ptr<const BakedShaders> baked;  ///< null: shaders are made of sources
    ShaderSources sources;
    ShaderCache cache;
    std::unique_ptr<GlslCompiler> compiler;  ///< made at the first miss: its tables cost a tenth of a second
    std::map<Fingerprint, Entry> compiled;
    std::map<Fingerprint, Entry> replaced;  ///< by the latest reload
    ShaderSources sources_before{{}};       ///< likewise

    Impl(std::filesystem::path root, std::filesystem::path folder)
        : sources(std::move(root)), cache(std::move(folder)) {}

    Fingerprint key_of(const ShaderSource& source) {
        Hasher hasher;
        hasher.value(recipe_version).value(source.kind).text(prologue(source.kind));
        sources.fingerprint(hasher, source.text);
        return hasher.finish();
    }

    /// From the disk, by everything that the text can reach, or made now.
    Entry make(const ShaderSource& source) {
        const Fingerprint key = key_of(source);
        std::vector<std::uint32_t> spirv = cache.load(key);
        if (spirv.empty()) {
            spirv = translate(source);
            cache.store(key, spirv);
        }
        return {described(source, std::move(spirv)), source, key};
    }

    std::vector<std::uint32_t> translate(const ShaderSource& source) {
        const std::string name = source.name.empty() ? "shader" : source.name;
        compiler = compiler ? std::move(compiler) : make_glsl_compiler();
        if (!compiler) {
            fail("shader '{}' cannot be compiled: this program links no compiler of GLSL (gn_compiler)", name);
        }
        return compiler->compile(source.kind, name, prologue(source.kind) + source.text, sources);
    }

    /// Exchanges entries with those of the same sources.
    void exchange(std::map<Fingerprint, Entry>& others) {
        for (auto& [fingerprint, other] : others) {
            std::swap(compiled.at(fingerprint), other);
        }
    }
};

ShaderCompiler::ShaderCompiler(std::filesystem::path include_root, std::filesystem::path cache_folder)
    : impl_(std::make_unique<Impl>(std::move(include_root), std::move(cache_folder))) {}

ShaderCompiler::ShaderCompiler(std::shared_ptr<const BakedShaders> baked)
    : impl_(std::make_unique<Impl>(std::filesystem::path(), std::filesystem::path())) {
    impl_->baked = std::move(baked);
}

ShaderCompiler::~ShaderCompiler() = default;

const CompiledShader& ShaderCompiler::compile(const ShaderSource& source) {
    // Ask this process first, by the text alone.
    const Fingerprint here = fingerprint_of(source);
    if (const auto found = impl_->compiled.find(here); found != impl_->compiled.end()) {
        return found->second.shader;
    }
    Impl::Entry entry = impl_->baked != nullptr
                            ? Impl::Entry{described(source, impl_->baked->load(baked_key(source, here), source.name))}
                            : impl_->make(source);
    return impl_->compiled.emplace(here, std::move(entry)).first->second.shader;
}

std::shared_ptr<ShaderCompiler> compiler_of(const std::filesystem::path& data) {
    const std::filesystem::path& caches = cache_root();
    return std::make_shared<ShaderCompiler>(data, caches.empty() ? std::filesystem::path() : caches / "shaders");
}

bool ShaderCompiler::has_sources() const {
    return impl_->baked == nullptr;
}

std::vector<Fingerprint> ShaderCompiler::reload() {
    // Make what changed beside what is there; only when all of it could be made, it takes its place.
    impl_->sources_before = impl_->sources;
    impl_->replaced.clear();
    std::map<Fingerprint, Impl::Entry> others;
    std::vector<Fingerprint> changed;
    try {
        if (!impl_->sources.refresh()) {
            return {};
        }
        for (const auto& [fingerprint, entry] : impl_->compiled) {
            if (impl_->key_of(entry.source) == entry.key) {
                continue;
            }
            Impl::Entry made = impl_->make(entry.source);
            if (made.shader.spirv != entry.shader.spirv) {
                changed.push_back(fingerprint);
            }
            others.emplace(fingerprint, std::move(made));
        }
    } catch (...) {
        impl_->sources = impl_->sources_before;
        throw;
    }
    impl_->exchange(others);
    impl_->replaced = std::move(others);
    return changed;
}

void ShaderCompiler::undo_reload() {
    impl_->exchange(impl_->replaced);
    impl_->replaced.clear();
    impl_->sources = impl_->sources_before;
}

}  // namespace gn
