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

ShaderSources::File ShaderSources::load(const std::string& path) const {
    File file;
    if (path.empty() || leads_out(path)) {
        return file;
    }
    const std::filesystem::path whole = root_ / path;
    std::error_code code;
    if (!std::filesystem::is_regular_file(whole, code)) {
        return file;
    }
    // What is written between these and the reading has another time, and is read again.
    file.written = std::filesystem::last_write_time(whole, code);
    file.bytes = std::filesystem::file_size(whole, code);
    std::ifstream stream(whole, std::ios::binary);
    if (stream) {
        file.text.emplace(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    }
    return file;
}

const std::string* ShaderSources::read(const std::string& path) {
    auto entry = files_.find(path);
    if (entry == files_.end()) {
        entry = files_.emplace(path, load(path)).first;
    }
    return entry->second.text ? &*entry->second.text : nullptr;
}

bool ShaderSources::refresh() {
    bool changed = false;
    for (auto& [path, file] : files_) {
        std::error_code code;
        const std::filesystem::file_time_type written = std::filesystem::last_write_time(root_ / path, code);
        const bool there = !code && !leads_out(path) && !path.empty();
        if (there != file.text.has_value() ||
            (there && (written != file.written || std::filesystem::file_size(root_ / path, code) != file.bytes))) {
            file = load(path);
            changed = true;
        }
    }
    return changed;
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
