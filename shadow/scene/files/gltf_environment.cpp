// SPDX-License-Identifier: MIT
// extras.gnomon.environment of the scene: the light from everywhere. docs/scenes.md has the schema.
#include "shadow/scene/files/given_sky.h"
#include "shadow/scene/files/gltf_data.h"

#include <algorithm>

namespace gn::gltf {
namespace {

/// Three numbers; of anything else NaN, which no key takes.
std::optional<dvec3> color(const tinygltf::Value& object, const std::string& key) {
    if (!object.Has(key)) {
        return std::nullopt;
    }
    const tinygltf::Value& list = object.Get(key);
    dvec3 value(std::numeric_limits<double>::quiet_NaN());
    for (int i = 0; list.IsArray() && list.ArrayLen() == 3 && i < 3; ++i) {
        const tinygltf::Value& number = list.Get(static_cast<std::size_t>(i));
        value[i] = number.IsNumber() ? number.GetNumberAsDouble() : value[i];
    }
    return value;
}

std::optional<double> any_number(const tinygltf::Value& object, const std::string& key) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return object.Has(key) ? std::optional(number(object, key).value_or(none)) : std::nullopt;
}

}  // namespace

std::optional<Light> load_environment(File& file) {
    if (file.data.scenes.empty()) {
        return std::nullopt;
    }
    const int index = std::max(file.data.defaultScene, 0);
    const tinygltf::Value& extras = at(file.data.scenes, index, file, "scene").extras;
    const bool says = extras.IsObject() && extras.Has("gnomon") && extras.Get("gnomon").IsObject();
    if (!says || !extras.Get("gnomon").Has("environment")) {
        return std::nullopt;
    }
    const tinygltf::Value& given = extras.Get("gnomon").Get("environment");
    if (!given.IsObject()) {
        add_note(file.notes, "The scene's extras.gnomon.environment is no object; it was ignored.");
        return std::nullopt;
    }
    for (const std::string& key : given.Keys()) {
        if (std::find(sky_keys.begin(), sky_keys.end(), key) == sky_keys.end()) {
            add_note(file.notes, fmt::format("The scene's extras.gnomon.environment has no key '{}'; its keys are {}.",
                                             clean_text(key), fmt::join(sky_keys, ", ")));
        }
    }
    const bool named = given.Has("name") && given.Get("name").IsString();
    const GivenSky sky{.name = named ? clean_text(given.Get("name").Get<std::string>()) : "",
                       .radiance = any_number(given, "radiance"),
                       .illuminance = any_number(given, "illuminance"),
                       .color = color(given, "color"),
                       .above = color(given, "above"),
                       .below = color(given, "below"),
                       .zenith = color(given, "zenith"),
                       .horizon = color(given, "horizon"),
                       .seen = any_number(given, "seen")};
    if (const std::string mistake = sky_mistake(sky); !mistake.empty()) {
        add_note(file.notes, fmt::format("The scene's extras.gnomon.environment {}; it was ignored.", mistake));
        return std::nullopt;
    }
    return light_of(sky);
}

}  // namespace gn::gltf
