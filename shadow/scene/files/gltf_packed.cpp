// SPDX-License-Identifier: MIT
// What the parser behind must be told so that it reads files at all whose data is compressed, or whose names hold a plus.
#include "shadow/scene/files/gltf_packed.h"

#include <nlohmann/json.hpp>

#include <cstring>

namespace gn::gltf {

namespace {

using Json = nlohmann::json;

Json* member(Json& object, const char* name) {
    const auto found = object.is_object() ? object.find(name) : object.end();
    return found == object.end() ? nullptr : &*found;
}

bool is_fallback(Json& buffer) {
    Json* extensions = member(buffer, "extensions");
    bool fallback = false;
    for (const char* name : meshopt_names) {
        Json* meshopt = extensions != nullptr ? member(*extensions, name) : nullptr;
        Json* said = meshopt != nullptr ? member(*meshopt, "fallback") : nullptr;
        fallback = fallback || (said != nullptr && said->is_boolean() && said->get<bool>());
    }
    return fallback && buffer.find("uri") == buffer.end();
}

// Buffers that only stand for the size of what is compressed have no bytes: they get one.
void give_bytes(Json& document) {
    Json* buffers = member(document, "buffers");
    for (std::size_t i = 0; buffers != nullptr && buffers->is_array() && i < buffers->size(); ++i) {
        Json& buffer = (*buffers)[i];
        if (is_fallback(buffer)) {
            buffer["uri"] = "data:application/octet-stream;base64,AA==";
            buffer["byteLength"] = 1;
        }
    }
}

// Indices that are in the compressed mesh only: it brings its own, and the parser refuses accessors without a view.
void drop_indices(Json& document, Json& primitive) {
    Json* extensions = member(primitive, "extensions");
    Json* accessors = member(document, "accessors");
    Json* indices = member(primitive, "indices");
    if (extensions == nullptr || member(*extensions, draco_name) == nullptr || accessors == nullptr ||
        !accessors->is_array() || indices == nullptr || !indices->is_number_unsigned()) {
        return;
    }
    const auto index = indices->get<std::size_t>();
    if (index < accessors->size() && member((*accessors)[index], "bufferView") == nullptr) {
        primitive.erase("indices");
    }
}

void drop_indices(Json& document) {
    Json* meshes = member(document, "meshes");
    for (std::size_t m = 0; meshes != nullptr && meshes->is_array() && m < meshes->size(); ++m) {
        Json* primitives = member((*meshes)[m], "primitives");
        for (std::size_t p = 0; primitives != nullptr && primitives->is_array() && p < primitives->size(); ++p) {
            drop_indices(document, (*primitives)[p]);
        }
    }
}

// Whether a file may be named with a plus; data within the JSON is full of them.
bool may_name_plus(std::string_view json) {
    constexpr std::string_view key = "\"uri\"";
    for (std::size_t at = json.find(key); at != std::string_view::npos; at = json.find(key, at + 1)) {
        const std::size_t begin = json.find('"', at + key.size());
        const std::string_view value =
            begin == std::string_view::npos ? "" : json.substr(begin + 1, json.find('"', begin + 1) - begin - 1);
        if (!value.starts_with("data:") && value.find('+') != std::string_view::npos) {
            return true;
        }
    }
    return false;
}

// The parser takes a plus for a blank, as forms of web pages do. In a name it is a plus. [RFC 3986, 2.2 and 3.3]
void escape_plus(Json& document, const char* list) {
    Json* all = member(document, list);
    for (std::size_t i = 0; all != nullptr && all->is_array() && i < all->size(); ++i) {
        Json* uri = member((*all)[i], "uri");
        if (uri == nullptr || !uri->is_string() || uri->get_ref<std::string&>().starts_with("data:")) {
            continue;
        }
        auto& name = uri->get_ref<std::string&>();
        for (std::size_t at = name.find('+'); at != std::string::npos; at = name.find('+', at)) {
            name.replace(at, 1, "%2B");
        }
    }
}

}  // namespace

std::optional<std::string> readable_json(std::string_view json) {
    if (json.find("meshopt_compression") == std::string_view::npos && json.find(draco_name) == std::string_view::npos &&
        !may_name_plus(json)) {
        return std::nullopt;
    }
    Json document = Json::parse(json.begin(), json.end());
    escape_plus(document, "buffers");
    escape_plus(document, "images");
    give_bytes(document);
    drop_indices(document);
    return document.dump();
}

std::span<const unsigned char> view_bytes(const File& file, int view_index) {
    const auto unpacked = file.unpacked_views.find(view_index);
    if (unpacked != file.unpacked_views.end()) {
        return unpacked->second;
    }
    const tinygltf::BufferView& view = at(file.data.bufferViews, view_index, file, "buffer view");
    return buffer_bytes(file, view.buffer, view.byteOffset, view.byteLength, fmt::format("buffer view {}", view_index));
}

std::span<const unsigned char> buffer_bytes(const File& file, int buffer_index, std::size_t offset, std::size_t length,
                                            const std::string& what) {
    const tinygltf::Buffer& buffer = at(file.data.buffers, buffer_index, file, "buffer");
    if (offset > buffer.data.size() || length > buffer.data.size() - offset) {
        fail("{}: {} does not fit into its buffer of {} bytes", file.shown, what, buffer.data.size());
    }
    return {buffer.data.data() + offset, length};
}

std::optional<std::size_t> whole(const tinygltf::Value& object, const std::string& key) {
    const std::optional<double> value = number(object, key);
    return value && *value >= 0.0 && *value <= 0x1p53 && *value == std::floor(*value)
               ? std::optional(static_cast<std::size_t>(*value))
               : std::nullopt;
}

}  // namespace gn::gltf
