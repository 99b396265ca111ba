// SPDX-License-Identifier: MIT
#include "gpu/shader_sources.h"

#include <fstream>
#include <iterator>
#include <vector>

namespace gn {
namespace {

/// The quoted paths of the text's include lines, in order.
std::vector<std::string> includes_of(std::string_view text) {
    std::vector<std::string> paths;
    for (std::size_t at = text.find('#'); at != std::string_view::npos; at = text.find('#', at + 1)) {
        std::size_t word = text.find_first_not_of(" \t", at + 1);
        if (word == std::string_view::npos || text.compare(word, 7, "include") != 0) {
            continue;
        }
        const std::size_t open = text.find_first_not_of(" \t", word + 7);
        if (open == std::string_view::npos || text[open] != '"') {
            continue;
        }
        const std::size_t close = text.find_first_of("\"\n", open + 1);
        if (close != std::string_view::npos && text[close] == '"') {
            paths.emplace_back(text.substr(open + 1, close - open - 1));
        }
    }
    return paths;
}

bool leads_out(const std::filesystem::path& path) {
    const std::filesystem::path normal = path.lexically_normal();
    return path.is_absolute() || (!normal.empty() && *normal.begin() == "..");
}

}  // namespace

const std::string* ShaderSources::read(const std::string& path) {
    const auto [entry, fresh] = files_.try_emplace(path);
    if (fresh && !path.empty() && !leads_out(path)) {
        std::ifstream file(root_ / path, std::ios::binary);
        if (file && std::filesystem::is_regular_file(root_ / path)) {
            entry->second.emplace(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
        }
    }
    return entry->second ? &*entry->second : nullptr;
}

void ShaderSources::fingerprint(Hasher& hasher, const std::string& text) {
    std::set<std::string> seen;
    visit(hasher, text, seen);
}

void ShaderSources::visit(Hasher& hasher, const std::string& text, std::set<std::string>& seen) {
    hasher.text(text);
    for (const std::string& path : includes_of(text)) {
        if (!seen.insert(path).second) {
            continue;
        }
        hasher.text(path);
        if (const std::string* included = read(path)) {
            visit(hasher, *included, seen);
        }
    }
}

}  // namespace gn
