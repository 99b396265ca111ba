// SPDX-License-Identifier: MIT
#include "gpu/baked_shaders.h"

#include "gpu/shader_cache.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>

namespace gn {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view format_line = "gnomon baked 1";
constexpr std::uintmax_t most_manifest_bytes = 4U << 20U;
constexpr std::uintmax_t most_shader_bytes = 16U << 20U;

/// The key that 32 hexadecimal digits write, or nothing.
std::optional<Fingerprint> key_of(std::string_view digits) {
    Fingerprint key;
    if (digits.size() != 32) {
        return {};
    }
    for (const auto& [word, half] : {std::pair(&key.high, digits.substr(0, 16)), {&key.low, digits.substr(16)}}) {
        std::from_chars(half.data(), half.data() + half.size(), *word, 16);
    }
    // What is no digit does not come back.
    return key.hex() == digits ? std::optional(key) : std::nullopt;
}

/// The whole of a plain file that is not larger; nothing where there is none.
std::optional<std::string> read_small(const fs::path& path, std::uintmax_t most) {
    std::error_code code;
    if (!fs::is_regular_file(path, code) || fs::file_size(path, code) > most || code) {
        return {};
    }
    std::ifstream file(path, std::ios::binary);
    return file ? std::optional<std::string>(std::in_place, std::istreambuf_iterator<char>(file),
                                             std::istreambuf_iterator<char>())
                : std::nullopt;
}

}  // namespace

std::string text_of(const BakedManifest& manifest) {
    std::string text = fmt::format("{}\nlibrary {}\n", format_line, manifest.library);
    for (const std::string& recipe : manifest.recipes) {
        text += fmt::format("recipe {}\n", recipe);
    }
    for (const std::string& note : manifest.notes) {
        text += fmt::format("note {}\n", note);
    }
    for (const auto& [key, name] : manifest.shaders) {
        text += fmt::format("shader {} {}\n", key.hex(), name);
    }
    return text + fmt::format("end {}\n", manifest.shaders.size());
}

BakedManifest parse_manifest(const std::string& text, const std::string& where) {
    BakedManifest manifest;
    manifest.library.clear();
    const auto damaged = [&](std::size_t line, const char* what) {
        fail("{}: line {} {}; bake the folder again", where, line, what);
    };
    bool whole = false;
    std::size_t line = 0;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view all = std::string_view(text).substr(begin, end - begin);
        begin = end + 1;
        ++line;
        if (line == 1) {
            if (all != format_line) {
                fail("{}: it does not begin with '{}', so that another gnomon wrote it; bake the folder again", where,
                     format_line);
            }
            continue;
        }
        if (whole) {
            damaged(line, "follows the end");
        }
        const std::size_t blank = std::min(all.find(' '), all.size());
        const std::string_view word = all.substr(0, blank);
        const std::string rest(all.substr(std::min(blank + 1, all.size())));
        if (word == "library") {
            manifest.library = rest;
        } else if (word == "recipe") {
            manifest.recipes.push_back(rest);
        } else if (word == "note") {
            manifest.notes.push_back(rest);
        } else if (word == "shader") {
            const auto key = key_of(std::string_view(rest).substr(0, 32));
            if (!key) {
                damaged(line, "has no shader's key");
            }
            manifest.shaders.emplace(*key, rest.substr(std::min<std::size_t>(33, rest.size())));
        } else if (word == "end") {
            whole = rest == fmt::format("{}", manifest.shaders.size());
            if (!whole) {
                damaged(line, "counts other shaders than there are");
            }
        } else {
            damaged(line, "is not understood");
        }
    }
    if (!whole) {
        fail("{}: it ends too early; bake the folder again", where);
    }
    if (manifest.library != library_stamp()) {
        fail("{}: it was baked by gnomon {}, and this is gnomon {}; bake it again: gnomon bake {} -o FOLDER", where,
             manifest.library, library_stamp(), fmt::join(manifest.recipes, " "));
    }
    return manifest;
}

BakedShaders::BakedShaders(fs::path folder) : folder_(std::move(folder)) {
    const fs::path file = folder_ / "manifest.txt";
    const std::optional<std::string> text = read_small(file, most_manifest_bytes);
    if (!text) {
        fail(
            "{}: there is no manifest.txt of at most {} bytes; give a folder that 'gnomon bake RECIPE... -o FOLDER' "
            "wrote",
            folder_.string(), most_manifest_bytes);
    }
    manifest_ = parse_manifest(*text, file.string());
}

void BakedShaders::demand(const Fingerprint& key, const std::string& name) const {
    if (!manifest_.shaders.contains(key)) {
        throw MissingShader(fmt::format("shader '{}' is not in {}", name, folder_.string()));
    }
}

std::vector<std::uint32_t> BakedShaders::load(const Fingerprint& key, const std::string& name) const {
    demand(key, name);
    const fs::path file = folder_ / "shaders" / (key.hex() + ".spv");
    std::error_code code;
    std::vector<std::uint32_t> spirv;
    if (fs::is_regular_file(file, code) && fs::file_size(file, code) <= most_shader_bytes && !code) {
        spirv = ShaderCache(folder_ / "shaders").load(key);
    }
    if (spirv.empty()) {
        fail("{}: the file of shader '{}' is missing or damaged; bake the folder again: {}", file.string(), name,
             command_with(""));
    }
    return spirv;
}

std::string BakedShaders::command_with(const std::string& recipe) const {
    std::vector<std::string> recipes = manifest_.recipes;
    if (!recipe.empty() && std::find(recipes.begin(), recipes.end(), recipe) == recipes.end()) {
        recipes.push_back(recipe);
    }
    return fmt::format("gnomon bake {} -o {}", fmt::join(recipes, " "), folder_.string());
}

}  // namespace gn
