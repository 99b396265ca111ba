// SPDX-License-Identifier: MIT
// extras.gnomon of nodes, meshes and materials: what casts and what receives. docs/scenes.md has the schema.
#include "shadow/scene/files/gltf_data.h"

#include <algorithm>

namespace gn::gltf {

namespace {

constexpr std::array keys{"casts", "receives"};

}  // namespace

std::span<const char* const> order_keys() {
    return keys;
}

Orders read_orders(File& file, const tinygltf::Value& extras, const std::string& who, bool carries_light) {
    if (!extras.IsObject() || !extras.Has("gnomon") || !extras.Get("gnomon").IsObject()) {
        return {};
    }
    const tinygltf::Value& given = extras.Get("gnomon");
    const auto flag = [&](const char* key) -> std::optional<bool> {
        if (!given.Has(key)) {
            return std::nullopt;
        }
        if (!given.Get(key).IsBool()) {
            add_note(file.notes, fmt::format("{}: extras.gnomon.{} is true or false; it was ignored.", who, key));
            return std::nullopt;
        }
        return given.Get(key).Get<bool>();
    };
    const std::span<const char* const> sizes = carries_light ? light_keys() : std::span<const char* const>{};
    for (const std::string& key : given.Keys()) {
        if (std::find(keys.begin(), keys.end(), key) == keys.end() &&
            std::find(sizes.begin(), sizes.end(), key) == sizes.end()) {
            add_note(file.notes, fmt::format("{}: extras.gnomon has no key '{}'; its keys are {}.", who,
                                             clean_text(key), fmt::join(keys, ", ")));
        }
    }
    return {flag("casts"), flag("receives")};
}

}  // namespace gn::gltf
