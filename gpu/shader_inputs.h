// SPDX-License-Identifier: MIT
// What a composed shader reads and writes beyond its pass's attachments, by name: one list makes the declarations with
// their binding numbers, the pass's declaration of use, and what is bound when it is recorded. Nobody counts bindings, and
// a block's bytes stand in the order of its members because both come from the same call. A copy costs nothing until it
// becomes another, and GLSL is written when it is asked for: a steady frame asks for none.
#pragma once

#include "gpu/frame_graph.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gn {

/// A format as GLSL's layout qualifiers of images spell it, "rg32f", or "" where it has no name there.
std::string_view image_format(VkFormat format);

class ShaderInputs {
  public:
    /// `uniform TYPE NAME`, read through a sampler. TYPE: sampler2D, sampler2DArray, ...
    ShaderInputs& texture(std::string_view type, std::string_view name, TextureHandle handle,
                          const SamplerDesc& sampler = {});
    /// A texture of which single texels of the first level are read, in GLSL `NAME_texel(ivec2 or ivec3)` and `NAME_size()`:
    /// as an image where the device is faster so and GLSL has a name for the format. SHAPE: "2D" or "2DArray".
    ShaderInputs& texels(const Device& device, VkFormat format, std::string_view shape, std::string_view name,
                         TextureHandle handle);
    /// An image that is only written, or written and read where `access` is "". FORMAT as GLSL spells it: "r32f".
    ShaderInputs& image(std::string_view format, std::string_view access, std::string_view type, std::string_view name,
                        TextureHandle handle);
    /// A block in a buffer: `KIND BLOCK { members }`; KIND: "readonly buffer", "writeonly buffer", "buffer" or "uniform".
    ShaderInputs& buffer(std::string_view kind, std::string_view block, std::string_view members, BufferHandle handle);
    /// The same with bytes that travel with the commands; KIND: "uniform" or, for as many as one likes, "readonly buffer".
    ShaderInputs& block(std::string_view kind, std::string_view block, std::string_view members,
                        std::span<const std::byte> bytes);
    /// A member of the uniform block `u`, after those that were added before; T is laid out as GLSL's scalar layout does.
    template <class T>
    ShaderInputs& constant(std::string_view type, std::string_view name, const T& value) {
        return constant_bytes(type, name, std::as_bytes(std::span(&value, 1)));
    }
    ShaderInputs& constant_bytes(std::string_view type, std::string_view name, std::span<const std::byte> bytes);
    /// All that others declare, after what was added before.
    ShaderInputs& add(const ShaderInputs& others);

    /// GLSL: the declarations, numbered from `first`. The types that they name must stand before.
    [[nodiscard]] std::string text(unsigned first = 0) const;
    /// All that the text depends on, for keys of shaders that are made once.
    void hash(Hasher& hasher) const;
    void declare(PassBuilder& pass) const;
    void set(Recorder& r) const;

  private:
    enum class Kind { texture, image, buffer, bytes };
    struct Entry {
        Kind kind = Kind::texture;
        std::string name, type;      ///< of blocks the kind
        std::string format, access;  ///< of images
        std::string members;         ///< of blocks
        bool texels = false;         ///< read one by one
        TextureHandle texture{};
        BufferHandle buffer{};
        SamplerDesc sampler{};
        bool writes = false;
        std::vector<std::byte> bytes{};
    };
    struct List {
        std::vector<Entry> entries;
        std::string constant_members;
        std::vector<std::byte> constants;
    };
    static std::shared_ptr<List> nothing();
    static std::string declaration(const Entry& entry, unsigned binding);
    /// The list, for adding: one of its own.
    List& own();

    std::shared_ptr<List> list_ = nothing();
};

/// The key of a shader of which these inputs are all that differs; more may be added to it.
inline Hasher hashed(const ShaderInputs& inputs) {
    Hasher hasher;
    inputs.hash(hasher);
    return hasher;
}

}  // namespace gn
