// SPDX-License-Identifier: MIT
// Compressed glTF data: EXT_meshopt_compression packs buffer views, KHR_draco_mesh_compression whole primitives.
#pragma once

#include "shadow/scene/files/gltf_data.h"

#include <array>

namespace gn::gltf {

/// One codec under the name of its vendor's draft and under the later one.
inline constexpr std::array meshopt_names{"EXT_meshopt_compression", "KHR_meshopt_compression"};
inline constexpr const char* draco_name = "KHR_draco_mesh_compression";

/// Most bytes that one file may unpack to; more is an Error.
inline constexpr std::size_t max_unpacked_bytes = 2 * max_file_bytes;

/// The JSON as the parser reads it rightly, where compression or names make that another; check_json has passed it.
std::optional<std::string> readable_json(std::string_view json);

/// Unpacks every buffer view that is compressed into file.unpacked_views. Throws Error.
void unpack_views(File& file);

/// A primitive as Draco packed it, for load_primitive.
struct UnpackedPrimitive {
    std::vector<std::uint32_t> indices;                            ///< of triangles
    std::map<std::string, std::vector<unsigned char>> attributes;  ///< as their accessors declare them, without gaps
};
/// Nothing where the primitive's positions are there without unpacking. Throws Error.
std::optional<UnpackedPrimitive> unpack_primitive(const File& file, const tinygltf::Primitive& primitive);

/// A part of a buffer, or Error; `what` names it.
std::span<const unsigned char> buffer_bytes(const File& file, int buffer, std::size_t offset, std::size_t length,
                                            const std::string& what);
/// What a buffer view holds, unpacked where it was compressed, or Error.
std::span<const unsigned char> view_bytes(const File& file, int view);

/// A whole number, 0 or more, of an extension; nothing when absent or anything else.
std::optional<std::size_t> whole(const tinygltf::Value& object, const std::string& key);

}  // namespace gn::gltf
