// SPDX-License-Identifier: MIT
// EXT_meshopt_compression: buffer views that hold vertices or indices in the codecs of meshoptimizer.
#include "shadow/scene/files/gltf_packed.h"

#include <meshoptimizer.h>

namespace gn::gltf {

namespace {

// A compressed view as the extension describes it.
struct Packed {
    std::string name;  ///< "file.gltf: EXT_meshopt_compression of buffer view 3"
    std::span<const unsigned char> bytes;
    std::size_t count = 0, stride = 0;
    std::string mode, filter = "NONE";
};

std::string text(const tinygltf::Value& object, const char* key, const std::string& otherwise) {
    return object.Has(key) && object.Get(key).IsString() ? object.Get(key).Get<std::string>() : otherwise;
}

Packed read_packed(const File& file, int view, const char* name, const tinygltf::Value& data) {
    Packed packed{.name = fmt::format("{}: {} of buffer view {}", file.shown, name, view)};
    const auto buffer = whole(data, "buffer");
    const auto length = whole(data, "byteLength");
    const auto count = whole(data, "count");
    const auto stride = whole(data, "byteStride");
    if (!buffer || *buffer >= file.data.buffers.size() || !length || !count || !stride) {
        fail("{} needs buffer, byteLength, byteStride and count, whole numbers of 0 or more", packed.name);
    }
    packed.bytes =
        buffer_bytes(file, static_cast<int>(*buffer), whole(data, "byteOffset").value_or(0), *length, packed.name);
    packed.count = *count;
    packed.stride = *stride;
    packed.mode = text(data, "mode", "");
    packed.filter = text(data, "filter", "NONE");
    return packed;
}

// What the codecs accept; they assert what they are given and check what they decode.
void check_form(const Packed& packed) {
    const bool vertices = packed.mode == "ATTRIBUTES";
    const bool indices = packed.mode == "TRIANGLES" || packed.mode == "INDICES";
    if (!vertices && !indices) {
        fail("{} has the mode '{}'; modes are ATTRIBUTES, TRIANGLES, INDICES", packed.name, clean_text(packed.mode));
    }
    const std::size_t stride = packed.stride;
    if (vertices ? stride == 0 || stride > 256 || stride % 4 != 0 : stride != 2 && stride != 4) {
        fail("{} has a stride of {} bytes; vertices have multiples of 4 up to 256, indices 2 or 4", packed.name,
             stride);
    }
    if (packed.mode == "TRIANGLES" && packed.count % 3 != 0) {
        fail("{} has {} indices, which is no multiple of 3", packed.name, packed.count);
    }
    const bool fits = packed.filter == "NONE" || (vertices && packed.filter == "EXPONENTIAL") ||
                      (vertices && packed.filter == "QUATERNION" && stride == 8) ||
                      (vertices && packed.filter == "OCTAHEDRAL" && (stride == 4 || stride == 8));
    if (!fits) {
        fail("{} has the filter '{}', which does not go with mode {} and a stride of {} bytes", packed.name,
             clean_text(packed.filter), packed.mode, stride);
    }
}

// The least that a stream of so many elements takes, by its format: a byte a triangle, a byte an index; of vertices, in
// every column of bytes, two bits for each group of 16, so that a byte stands for 64 of them. Nothing longer is promised
// by an honest header, and nothing is allocated for a promise that is not.
void check_length(const Packed& packed, std::size_t unpacked_before) {
    const std::size_t bytes = packed.bytes.size();
    const std::size_t most = packed.mode == "TRIANGLES" ? 3 * bytes
                             : packed.mode == "INDICES" ? bytes
                                                        : 64 * (bytes / packed.stride);
    if (packed.count > most) {
        fail("{} promises {} elements in {} bytes; there cannot be more than {}", packed.name, packed.count, bytes,
             most);
    }
    if (packed.count * packed.stride > max_unpacked_bytes - unpacked_before) {
        fail("{} unpacks to more than {} bytes with all views before it", packed.name, max_unpacked_bytes);
    }
}

int decode(const Packed& packed, unsigned char* out) {
    const auto& [name, bytes, count, stride, mode, filter] = packed;
    if (mode == "ATTRIBUTES") {
        return meshopt_decodeVertexBuffer(out, count, stride, bytes.data(), bytes.size());
    }
    return mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(out, count, stride, bytes.data(), bytes.size())
                               : meshopt_decodeIndexSequence(out, count, stride, bytes.data(), bytes.size());
}

std::vector<unsigned char> unpack(const Packed& packed) {
    std::vector<unsigned char> out(packed.count * packed.stride);
    if (packed.count > 0 && decode(packed, out.data()) != 0) {
        fail("{} is damaged, or of a later version of the codec", packed.name);
    }
    if (packed.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(out.data(), packed.count, packed.stride);
    } else if (packed.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(out.data(), packed.count, packed.stride);
    } else if (packed.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(out.data(), packed.count, packed.stride);
    }
    return out;
}

}  // namespace

void unpack_views(File& file) {
    std::size_t total = 0;
    for (std::size_t i = 0; i < file.data.bufferViews.size(); ++i) {
        const tinygltf::ExtensionMap& extensions = file.data.bufferViews[i].extensions;
        for (const char* name : meshopt_names) {
            const auto found = extensions.find(name);
            if (found == extensions.end() || file.unpacked_views.count(static_cast<int>(i)) > 0) {
                continue;
            }
            const Packed packed = read_packed(file, static_cast<int>(i), name, found->second);
            check_form(packed);
            check_length(packed, total);
            total += packed.count * packed.stride;
            file.unpacked_views[static_cast<int>(i)] = unpack(packed);
        }
    }
}

}  // namespace gn::gltf
