// SPDX-License-Identifier: MIT
#include "shadow/scene/mtl.h"

#include "base/error.h"
#include "shadow/scene/text.h"

#include <algorithm>

namespace gn {

// One newmtl block.
struct MaterialLibrary::Entry {
    std::string name;
    Material material;
    std::string color_map, alpha_map;
    bool clamp = false;
    bool dissolve_given = false;  ///< by `d`, which goes before `Tr` wherever it stands
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
std::string map_name(std::string_view line, bool& clamp) {
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
            // Offsets and scales may have one to three numbers.
            if (i > 0 && option->second == 3 && !leading_number(argument)) {
                break;
            }
            clamp = option->first == "-clamp" ? argument == "on" : clamp;
            rest = after;
        }
        line = rest;
    }
}

// Coverage from a map_d: its alpha where it has any, else its brightness.
void merge_alpha(Image8& base, const Image8& mask) {
    bool has_alpha = false;
    for (std::size_t i = 3; i < mask.rgba.size(); i += 4) {
        has_alpha = has_alpha || mask.rgba[i] != 255;
    }
    for (int y = 0; y < base.height; ++y) {
        for (int x = 0; x < base.width; ++x) {
            const auto mx = static_cast<std::size_t>(static_cast<std::int64_t>(x) * mask.width / base.width);
            const auto my = static_cast<std::size_t>(static_cast<std::int64_t>(y) * mask.height / base.height);
            const std::uint8_t* texel = &mask.rgba[4 * (my * static_cast<std::size_t>(mask.width) + mx)];
            const auto at =
                4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(base.width) + static_cast<std::size_t>(x));
            base.rgba[at + 3] = has_alpha ? texel[3] : std::max({texel[0], texel[1], texel[2]});
        }
    }
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
        Material& m = entry.material;
        if (key == "newmtl") {
            finish(entry);
            entry = Entry{};
            entry.name = std::string(trimmed(line));
            entry.material.name = clean_text(entry.name);
        } else if (key == "Kd") {
            m.base_color = vec4(color(line, 1.0F), m.base_color.w);
        } else if (key == "Ke") {
            m.emissive = color(line, 1e9F);
        } else if (key == "d") {
            std::string_view rest = line;
            line = take_word(rest) == "-halo" ? rest : line;
            m.base_color.w = number_or(line, 1.0F, 0.0F, 1.0F);
            entry.dissolve_given = true;
        } else if (key == "Tr" && !entry.dissolve_given) {
            m.base_color.w = 1.0F - number_or(line, 0.0F, 0.0F, 1.0F);
        } else if (key == "Ns") {
            // The width of a Phong lobe as GGX roughness: alpha^2 = 2 / (Ns + 2), alpha = roughness^2.
            m.roughness = std::pow(2.0F / (number_or(line, 10.0F, 0.0F, 1e5F) + 2.0F), 0.25F);
        } else if (key == "Pr") {
            m.roughness = number_or(line, m.roughness, 0.0F, 1.0F);
        } else if (key == "Pm") {
            m.metallic = number_or(line, m.metallic, 0.0F, 1.0F);
        } else if (key == "map_Kd") {
            entry.color_map = map_name(line, entry.clamp);
        } else if (key == "map_d") {
            entry.alpha_map = map_name(line, entry.clamp);
        }
    }
    finish(entry);
}

void MaterialLibrary::finish(const Entry& entry) {
    if (entry.name.empty() || materials_.count(entry.name) > 0) {
        return;
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
    const bool masked = material.base_color_texture >= 0 && !entry.alpha_map.empty();
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
    const std::string key = entry.color_map + '\n' + entry.alpha_map + (entry.clamp ? "\nclamp" : "") + '\n' + beside_.string();
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
        model_.textures.push_back({clean_text(name), std::move(*image), !entry.clamp, !entry.clamp});
    }
    textures_[key] = index;
    return index;
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
