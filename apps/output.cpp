// SPDX-License-Identifier: MIT
#include "apps/output.h"

#include "apps/options.h"

#include <unistd.h>

#include <fstream>
#include <sstream>

namespace gn {

void check_writable_parent(std::string_view option, const std::filesystem::path& path) {
    if (path.empty()) {
        return;
    }
    std::error_code code;
    if (std::filesystem::is_directory(path, code)) {
        throw InputError(fmt::format("{} {}: is a folder; a file's name is needed", option, path.string()));
    }
    const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (!std::filesystem::is_directory(parent, code)) {
        throw InputError(fmt::format("{} {}: folder '{}' does not exist", option, path.string(), parent.string()));
    }
    if (access(parent.c_str(), W_OK) != 0) {
        throw InputError(
            fmt::format("{} {}: folder '{}' cannot be written to", option, path.string(), parent.string()));
    }
}

void write_text(const std::filesystem::path& path, std::string_view text) {
    std::filesystem::path temporary = path;
    temporary += fmt::format(".{}.part", getpid());
    std::error_code code;
    {
        std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
        stream.write(text.data(), static_cast<std::streamsize>(text.size()));
        stream.flush();
        if (!stream) {
            std::filesystem::remove(temporary, code);
            fail("{}: cannot be written; is the folder there, writable, and the disk not full?", path.string());
        }
    }
    std::filesystem::rename(temporary, path, code);
    if (code) {
        const std::string why = code.message();
        std::filesystem::remove(temporary, code);
        fail("{}: cannot be replaced: {}", path.string(), why);
    }
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
        fail("{}: cannot be read", path.string());
    }
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::string slug(std::string_view text) {
    constexpr std::size_t longest = 40;
    std::string name;
    for (const char c : text) {
        const bool digit = c >= '0' && c <= '9', lower = c >= 'a' && c <= 'z', upper = c >= 'A' && c <= 'Z';
        if (digit || lower) {
            name += c;
        } else if (upper) {
            name += static_cast<char>(c - 'A' + 'a');
        } else if (!name.empty() && name.back() != '-') {
            name += '-';
        }
        if (name.size() >= longest) {
            break;
        }
    }
    while (!name.empty() && name.back() == '-') {
        name.pop_back();
    }
    return name.empty() ? "unnamed" : name;
}

std::string shell_word(std::string_view word) {
    if (!word.empty() && word.find_first_of(" '\"$\\`*?[](){}<>|&;#~!\n\t") == std::string_view::npos) {
        return std::string(word);
    }
    std::string quoted = "'";
    for (const char c : word) {
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return quoted + "'";
}

}  // namespace gn
