// SPDX-License-Identifier: MIT
#include "shadow/scene/files/mtl.h"

#include "base/error.h"
#include "shadow/scene/files/coverage.h"
#include "shadow/scene/files/text.h"

#include <algorithm>
#include <array>

namespace gn {

// One newmtl block.
struct MaterialLibrary::Entry {
    std::string name;
    Material material;
    std::string color_map, alpha_map;
    MapPlacement placed;
    bool dissolve_given = false;       ///< by `d`, which goes before `Tr` wherever it stands
    std::vector<std::string> unread;   ///< statements that change what casts
    std::vector<std::string> misread;  ///< sentences about coverage that is no number or out of range

    void take(std::string_view word, std::string_view line);
    void take_opacity(std::string_view word, std::string_view line);
};

namespace {

constexpr std::size_t largest_library = std::size_t{64} << 20U;

float number_or(std::string_view& line, float otherwise, float low, float high) {
    const std::optional<double> value = leading_number(take_word(line));
    return value && std::isfinite(*value)
               ? static_cast<float>(std::clamp(*value, static_cast<double>(low), static_cast<double>(high)))
               : otherwise;
}

vec3 color(std::string_view line, float most) {
    const float r = number_or(line, 0.8F, 0.0F, most);
    const float g = number_or(line, r, 0.0F, most);
    return {r, g, number_or(line, g, 0.0F, most)};
}

// A map statement: options with their arguments, then a file name that may hold spaces.
std::string map_name(std::string_view line, MapPlacement& placed) {
    static const std::map<std::string, int, std::less<>> arguments{
        {"-blendu", 1}, {"-blendv", 1}, {"-boost", 1}, {"-bm", 1}, {"-cc", 1}, {"-clamp", 1}, {"-imfchan", 1},
        {"-mm", 2},     {"-texres", 1}, {"-type", 1},  {"-o", 3},  {"-s", 3},  {"-t", 3}};
    while (true) {
        std::string_view rest = line;
        const auto option = arguments.find(take_word(rest));
        if (option == arguments.end()) {
            return std::string(trimmed(line));
        }
        for (int i = 0; i < option->second; ++i) {
            std::string_view after = rest;
            const std::string_view argument = take_word(after);
            const std::optional<double> value = leading_number(argument);
            // Offsets and scales may have one to three numbers.
            if (i > 0 && option->second == 3 && !value) {
                break;
            }
            if (i < 2 && value && (option->first == "-s" || option->first == "-o")) {
                (option->first == "-s" ? placed.scale : placed.offset)[i] = static_cast<float>(*value);
            }
            placed.clamp = option->first == "-clamp" ? argument == "on" : placed.clamp;
            rest = after;
        }
        line = rest;
    }
}

std::string lower(std::string_view word) {
    std::string text(word);
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

// What would change which light goes where, and is not read; the rest only changes how a surface looks.
bool changes_shadows(const std::string& key) {
    static constexpr std::array<std::string_view, 6> keys{"tf",     "disp",        "map_disp",
                                                          "map_tr", "map_opacity", "map_alpha"};
    return std::find(keys.begin(), keys.end(), key) != keys.end();
}

}  // namespace

void MaterialLibrary::read(std::string_view names) {
    // The whole rest of the line is one name, unless there is no such file: then each word is one.
    const std::string whole(trimmed(names));
    std::string_view words = names;
    const bool single = trimmed(names).find_first_of(" \t") == std::string_view::npos;
    bool exists = single;
    try {
        exists = exists || !folder_.resolve(whole).empty();
    } catch (const Error&) {
        exists = false;
    }
    if (exists) {
        read_file_named(whole);
        return;
    }
    for (std::string_view word = take_word(words); !word.empty(); word = take_word(words)) {
        read_file_named(std::string(word));
    }
}

void MaterialLibrary::read_file_named(const std::string& name) {
    if (!read_.emplace(name, true).second) {
        return;
    }
    std::string text;
    std::filesystem::path file;
    try {
        file = folder_.resolve(name);
        text = decode_text(read_file(file, largest_library));
    } catch (const Error& problem) {
        add_note(model_.notes, fmt::format("Material library ignored: {}.", problem.what()));
        return;
    }

    beside_ = file.parent_path();
    Entry entry;
    Lines lines(text);
    std::string_view line;
    while (lines.next(line)) {
        const std::string_view key = take_word(line);
        if (lower(key) == "newmtl") {
            finish(entry);
            entry = Entry{};
            entry.name = std::string(trimmed(line));
            entry.material.name = clean_text(entry.name);
        } else {
            entry.take(key, line);
        }
    }
    finish(entry);
}

void MaterialLibrary::Entry::take(std::string_view word, std::string_view line) {
    // Letter case is forgiven: exporters and hands differ.
    const std::string key = lower(word);
    Material& m = material;
    if (key == "kd") {
        m.base_color = vec4(color(line, 1.0F), m.base_color.w);
    } else if (key == "ke") {
        m.emissive = color(line, 1e9F);
    } else if (key == "d" || (key == "tr" && !dissolve_given)) {
        take_opacity(word, line);
    } else if (key == "ns") {
        // The width of a Phong lobe as GGX roughness: alpha^2 = 2 / (Ns + 2), alpha = roughness^2.
        m.roughness = std::pow(2.0F / (number_or(line, 10.0F, 0.0F, 1e5F) + 2.0F), 0.25F);
    } else if (key == "pr") {
        m.roughness = number_or(line, m.roughness, 0.0F, 1.0F);
    } else if (key == "pm") {
        m.metallic = number_or(line, m.metallic, 0.0F, 1.0F);
    } else if (key == "map_kd") {
        color_map = map_name(line, placed);
    } else if (key == "map_d") {
        alpha_map = map_name(line, placed);
    } else if (changes_shadows(key)) {
        unread.emplace_back(clean_text(word));
    }
}

void MaterialLibrary::Entry::take_opacity(std::string_view word, std::string_view line) {
    const std::string statement = clean_text(fmt::format("{} {}", word, trimmed(line)));
    const bool dissolve = lower(word) == "d";
    std::string_view rest = line;
    line = dissolve && take_word(rest) == "-halo" ? rest : line;
    std::string_view number = line;
    const std::optional<double> value = leading_number(take_word(number));
    const float taken = number_or(line, dissolve ? 1.0F : 0.0F, 0.0F, 1.0F);
    material.base_color.w = dissolve ? taken : 1.0F - taken;
    dissolve_given = dissolve_given || dissolve;
    if (!value || *value != std::clamp(*value, 0.0, 1.0)) {
        misread.push_back(fmt::format("'{}' is no number from 0 to 1; its opacity counts as {:.3g}", statement,
                                      material.base_color.w));
    }
}

void MaterialLibrary::finish(const Entry& entry) {
    if (entry.name.empty()) {
        return;
    }
    if (materials_.count(entry.name) > 0) {
        add_note(model_.notes,
                 fmt::format("Material '{}' is defined again; the first definition counts.", entry.material.name));
        return;
    }
    for (const std::string& sentence : entry.misread) {
        add_note(model_.notes, fmt::format("Material '{}': {}.", entry.material.name, sentence));
    }
    Material material = entry.material;
    material.base_color_texture = load_texture(entry);

    // A picture is the colour, not a factor of Kd: exporters write any Kd beside it.
    if (material.base_color_texture >= 0 && !entry.color_map.empty()) {
        material.base_color = vec4(1.0F, 1.0F, 1.0F, material.base_color.w);
    }
    if (material.base_color_texture < 0 && !entry.alpha_map.empty()) {
        note_lost_mask(model_.notes, material.name);
    }
    bool masked = material.base_color_texture >= 0 && !entry.alpha_map.empty();
    if (material.base_color_texture >= 0 && !masked) {
        masked = mask_of_color(model_.textures[static_cast<std::size_t>(material.base_color_texture)].image,
                               material.name, "map_d", "map_Kd", model_.notes);
    }
    if (!entry.unread.empty()) {
        add_note(model_.notes, fmt::format("Material '{}': {} {} not read.", material.name,
                                           fmt::join(entry.unread, ", "), entry.unread.size() == 1 ? "is" : "are"));
    }
    placements_[static_cast<int>(model_.materials.size())] = entry.placed;
    material.alpha_mode = masked                         ? AlphaMode::mask
                          : material.base_color.w < 1.0F ? AlphaMode::blend
                                                         : AlphaMode::opaque;
    materials_[entry.name] = static_cast<int>(model_.materials.size());
    model_.materials.push_back(std::move(material));
}

std::optional<Image8> MaterialLibrary::load_image(const std::string& name) {
    if (name.empty()) {
        return std::nullopt;
    }
    try {
        if (pixels_ > max_texture_pixels) {
            fail("'{}' is one too many: a scene may have {} pixels in all", clean_text(name), max_texture_pixels);
        }
        Image8 image = decode_image(read_file(folder_.resolve(name, beside_)), fmt::format("'{}'", clean_text(name)));
        pixels_ += image.rgba.size() / 4;
        return image;
    } catch (const Error& problem) {
        add_note(model_.notes, fmt::format("Texture ignored: {}.", problem.what()));
        return std::nullopt;
    }
}

int MaterialLibrary::load_texture(const Entry& entry) {
    const std::string key =
        entry.color_map + '\n' + entry.alpha_map + (entry.placed.clamp ? "\nclamp" : "") + '\n' + beside_.string();
    const auto known = textures_.find(key);
    if (known != textures_.end()) {
        return known->second;
    }
    std::optional<Image8> image = load_image(entry.color_map);
    if (!entry.alpha_map.empty() && entry.alpha_map != entry.color_map) {
        // White where only coverage is given.
        if (const std::optional<Image8> mask = load_image(entry.alpha_map)) {
            if (!image) {
                image = Image8{mask->width, mask->height, std::vector<std::uint8_t>(mask->rgba.size(), 255)};
            }
            merge_alpha(*image, *mask);
        }
    }
    int index = -1;
    if (image) {
        index = static_cast<int>(model_.textures.size());
        const std::string& name = entry.color_map.empty() ? entry.alpha_map : entry.color_map;
        model_.textures.push_back({clean_text(name), std::move(*image), !entry.placed.clamp, !entry.placed.clamp});
    }
    textures_[key] = index;
    return index;
}

MapPlacement MaterialLibrary::placement(int material) const {
    const auto known = placements_.find(material);
    return known != placements_.end() ? known->second : MapPlacement{};
}

int MaterialLibrary::find(const std::string& name) {
    const auto known = materials_.find(name);
    if (known != materials_.end()) {
        return known->second;
    }
    if (!name.empty()) {
        add_note(model_.notes, fmt::format("Material '{}' is not defined; grey is used.", clean_text(name)));
    }
    materials_[name] = static_cast<int>(model_.materials.size());
    model_.materials.push_back({.name = clean_text(name)});
    return materials_[name];
}

}  // namespace gn
