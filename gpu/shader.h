// SPDX-License-Identifier: MIT
// Shaders: a short prologue of includes composed at run time, compiled (gpu/glsl.h), cached on disk by the hash of the
// whole preprocessed source; or found compiled in a folder that was baked (gpu/baked_shaders.h).
#pragma once

#include "base/error.h"
#include "gpu/hash.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gn {

enum class ShaderKind { vertex, fragment, compute, geometry };

/// GLSL without a #version line. `#include "shadow/lookup/pcf/pcf.glsl"` is resolved from the data root. The compiler
/// prepends version 460 and the extensions every shader may use (scalar_block_layout, shader_viewport_layer_array for
/// vertex shaders, gather, buffer_reference off).
struct ShaderSource {
    ShaderKind kind = ShaderKind::compute;
    std::string name;  ///< for errors and labels
    std::string text;
    std::optional<Fingerprint> fingerprint{};  ///< of the three above, where their maker worked it out once: seal()

    [[nodiscard]] Fingerprint work_out() const { return Hasher().value(kind).text(name).text(text).finish(); }
    void seal() { fingerprint = work_out(); }
};

/// A binding found in compiled code, for binding by name.
struct ShaderBinding {
    std::uint32_t binding = 0;
    std::uint32_t vk_descriptor_type = 0;
    std::uint32_t image_dim = 1;                                  ///< images: 0 1D, 1 2D, 2 3D, 3 cube, 5 buffer
    bool arrayed = false, multisampled = false, integer = false;  ///< images: as the shader declares them
    std::uint32_t block_bytes = 0;                                ///< blocks: of the part with a fixed size
    /// Whether two stages mean the same resource; they may see different lengths of a block.
    [[nodiscard]] bool same_resource(const ShaderBinding& o) const {
        return binding == o.binding && vk_descriptor_type == o.vk_descriptor_type && image_dim == o.image_dim &&
               arrayed == o.arrayed && multisampled == o.multisampled && integer == o.integer;
    }
};

struct CompiledShader {
    ShaderKind kind = ShaderKind::compute;
    std::string name;
    std::vector<std::uint32_t> spirv;
    std::map<std::string, ShaderBinding, std::less<>>
        bindings;  ///< set 0 only, by the variable's (or block's instance, else block's) name
    std::uint32_t push_constant_bytes = 0;
};

/// A shader that a baked folder does not hold.
struct MissingShader : Error {
    using Error::Error;
};

class BakedShaders;
class ShaderCompiler;

/// Of a data folder's sources, with the disk cache where programs keep theirs (base/paths.h).
std::shared_ptr<ShaderCompiler> compiler_of(const std::filesystem::path& data);

class ShaderCompiler {
  public:
    /// An empty cache folder turns the disk cache off.
    ShaderCompiler(std::filesystem::path include_root, std::filesystem::path cache_folder);
    /// Compiles nothing and reads no source: what was baked is all there is.
    explicit ShaderCompiler(std::shared_ptr<const BakedShaders> baked);
    ~ShaderCompiler();
    /// Throws Error with the include's own file and line, or MissingShader. The result stays valid as long as the compiler,
    /// and becomes another one where reload says so.
    const CompiledShader& compile(const ShaderSource& source);

    /// Whether shaders are made of sources, so that reload may find some changed.
    [[nodiscard]] bool has_sources() const;
    /// Reads include files again that were written since they were read last, and compiles again what reaches them. Gives the
    /// fingerprints of the sources whose code became another one. Throws Error with the compiler's sentence; then nothing
    /// has changed, and the next call tries again.
    std::vector<Fingerprint> reload();
    /// Puts back what the latest reload replaced.
    void undo_reload();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gn
