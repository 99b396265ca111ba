// SPDX-License-Identifier: MIT
#include "shadow/scene/files.h"

#include "base/error.h"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace gn {

namespace fs = std::filesystem;

std::vector<std::byte> read_file(const fs::path& path, std::size_t cap) {
    // Ask before opening: a pipe or a device would never end.
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) {
        fail("{}: no such file", clean_text(path.string()));
    }
    if (!fs::is_regular_file(status)) {
        fail("{}: not a plain file", clean_text(path.string()));
    }

    // Check the size before allocating for it.
    const std::uintmax_t size = fs::file_size(path, error);
    if (error || size > cap) {
        fail("{}: the file has {} bytes; at most {} can be read", clean_text(path.string()), size, cap);
    }
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    std::ifstream in(path, std::ios::binary);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!in || static_cast<std::size_t>(in.gcount()) != bytes.size()) {
        fail("{}: cannot be read", clean_text(path.string()));
    }
    return bytes;
}

Folder::Folder(const fs::path& model_file) {
    std::error_code error;
    const fs::path parent = model_file.parent_path();
    root_ = fs::canonical(parent.empty() ? fs::path(".") : parent, error);
    if (error) {
        fail("{}: no such file (its folder cannot be opened)", clean_text(model_file.string()));
    }
}

bool Folder::holds(const fs::path& file) const {
    // Follow every link first: only where the file really is counts.
    std::error_code error;
    const fs::path real = fs::canonical(file, error);
    if (error || !fs::is_regular_file(real, error)) {
        return false;
    }
    const auto [root_end, unused] = std::mismatch(root_.begin(), root_.end(), real.begin(), real.end());
    return root_end == root_.end();
}

fs::path Folder::resolve(std::string_view name) const {
    const std::string shown = clean_text(name);
    if (name.empty() || name.find('\0') != std::string_view::npos) {
        fail("'{}': not a file name", shown);
    }

    // Refuse by spelling whatever could leave the folder, on any system's convention.
    std::string portable(name);
    std::replace(portable.begin(), portable.end(), '\\', '/');
    const fs::path relative = fs::path(portable).lexically_normal();
    const bool drive = portable.size() > 1 && portable[1] == ':';
    if (relative.is_absolute() || drive || (relative.begin() != relative.end() && *relative.begin() == "..")) {
        fail("'{}' lies outside the model's folder; only files inside it are read", shown);
    }

    // Then by place: a link may lead out although the name does not.
    std::error_code error;
    const fs::path file = root_ / relative;
    if (!fs::exists(file, error)) {
        fail("'{}': no such file in the model's folder", shown);
    }
    if (!holds(file)) {
        fail("'{}' is no plain file inside the model's folder", shown);
    }
    return file;
}

namespace {

// Length of the valid UTF-8 sequence at the start of `text`, 0 when there is none.
std::size_t sequence_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned lead = byte(0);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                               : (lead & 0xF0U) == 0xE0      ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || length > text.size()) {
        return 0;
    }
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0U) != 0x80) {
            return 0;
        }
    }

    // Overlong forms, surrogates and values beyond U+10FFFF are no characters.
    const bool overlong = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xF0 && byte(1) < 0x90);
    const bool outside = (lead == 0xED && byte(1) >= 0xA0) || (lead == 0xF4 && byte(1) >= 0x90);
    return overlong || outside ? 0 : length;
}

}  // namespace

std::string clean_text(std::string_view text) {
    constexpr std::size_t longest = 200;
    std::string clean;
    while (!text.empty() && clean.size() < longest) {
        const std::size_t length = sequence_length(text);
        const auto first = static_cast<unsigned char>(text.front());
        const bool printable = length > 1 || (length == 1 && first >= 0x20 && first != 0x7F);
        clean += printable ? text.substr(0, length) : std::string_view("?");
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return text.empty() ? clean : clean + "...";
}

}  // namespace gn
