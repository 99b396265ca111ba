// SPDX-License-Identifier: MIT
#include "shadow/scene/files/files.h"

#include "base/error.h"

#include <algorithm>
#include <array>
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

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

// Deeper names are no work of an exporter, and more files of one spelling no accident.
constexpr std::size_t most_parts = 64, most_matches = 16;

// A name as its folders and the file, on any system's convention.
struct Name {
    std::vector<std::string> parts;  ///< without empty ones, ".", and a drive or scheme
    bool rooted = false;             ///< begins at a root of this system
    bool foreign = false;            ///< begins at a drive, a server or a scheme
    [[nodiscard]] bool climbs() const { return !parts.empty() && parts.front() == ".."; }
};

Name split(std::string_view name) {
    const bool quoted = name.size() > 2 && name.front() == '"' && name.back() == '"';
    std::string portable(quoted ? name.substr(1, name.size() - 2) : name);
    std::replace(portable.begin(), portable.end(), '\\', '/');
    Name split;
    split.foreign =
        portable.starts_with("//") || portable.starts_with("file:") || (portable.size() > 1 && portable[1] == ':');
    split.rooted = !split.foreign && portable.starts_with('/');
    portable.erase(0, split.foreign ? portable.find(':') + 1 : 0);
    for (std::size_t begin = 0; begin <= portable.size();) {
        const std::size_t end = std::min(portable.find('/', begin), portable.size());
        const std::string part = portable.substr(begin, end - begin);
        // "name/.." is a detour; what is left of ".." leads out of the folder.
        if (part == ".." && !split.parts.empty() && split.parts.back() != "..") {
            split.parts.pop_back();
        } else if (!part.empty() && part != ".") {
            split.parts.push_back(part);
        }
        begin = end + 1;
    }
    return split;
}

fs::path joined(fs::path from, std::span<const std::string> parts) {
    for (const std::string& part : parts) {
        from /= part;
    }
    return from;
}

}  // namespace

Folder::Folder(const fs::path& model_file, std::span<const fs::path> assets) {
    std::error_code error;
    const fs::path parent = model_file.parent_path();
    roots_.push_back(fs::canonical(parent.empty() ? fs::path(".") : parent, error));
    if (error) {
        fail("{}: no such file (its folder cannot be opened)", clean_text(model_file.string()));
    }
    for (const fs::path& folder : assets) {
        roots_.push_back(fs::canonical(folder, error));
        if (error || !fs::is_directory(roots_.back(), error)) {
            fail("--assets: '{}': no such folder", clean_text(folder.string()));
        }
    }
}

bool Folder::inside(const fs::path& real) const {
    return std::any_of(roots_.begin(), roots_.end(), [&](const fs::path& root) {
        return std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first == root.end();
    });
}

bool Folder::holds(const fs::path& file) const {
    // Follow every link first: only where the file really is counts.
    std::error_code error;
    const fs::path real = fs::canonical(file, error);
    return !error && fs::is_regular_file(real, error) && inside(real);
}

const std::vector<std::string>& Folder::spellings(const fs::path& folder, const std::string& part) const {
    // List each folder once, and none that a link leads out to.
    const auto [listed, added] = listings_.try_emplace(folder);
    std::error_code error;
    if (added && inside(fs::canonical(folder, error)) && !error) {
        for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
             entry.increment(error)) {
            const std::string name = entry->path().filename().string();
            listed->second[lower(name)].push_back(name);
        }
        for (auto& [key, names] : listed->second) {
            std::sort(names.begin(), names.end());
        }
    }
    static const std::vector<std::string> none;
    const auto found = listed->second.find(lower(part));
    return found != listed->second.end() ? found->second : none;
}

std::vector<fs::path> Folder::matches(const fs::path& from, std::span<const std::string> parts) const {
    // The very spelling first, then others in order.
    std::vector<fs::path> found{from};
    for (const std::string& part : parts) {
        std::vector<fs::path> next;
        for (const fs::path& folder : found) {
            const std::vector<std::string>& names = spellings(folder, part);
            const bool exact = std::find(names.begin(), names.end(), part) != names.end();
            for (const std::string& name : exact ? std::vector<std::string>{part} : names) {
                if (next.size() < most_matches) {
                    next.push_back(folder / name);
                }
            }
        }
        found = std::move(next);
    }
    std::erase_if(found, [&](const fs::path& file) { return !holds(file); });
    return found;
}

std::vector<fs::path> Folder::search(std::span<const std::string> parts, const fs::path& beside) const {
    std::vector<fs::path> places{beside};
    places.insert(places.end(), roots_.begin(), roots_.end());
    // Take leading folders off until a file is found: the longer what is left, the surer it is the one that was meant.
    for (; !parts.empty(); parts = parts.subspan(1)) {
        if (std::find(parts.begin(), parts.end(), "..") != parts.end()) {
            continue;
        }
        std::vector<fs::path> found;
        for (const fs::path& place : places) {
            for (const fs::path& file : place.empty() ? std::vector<fs::path>{} : matches(place, parts)) {
                if (std::find(found.begin(), found.end(), file) == found.end()) {
                    found.push_back(file);
                }
            }
        }
        if (!found.empty()) {
            return found;
        }
    }
    return {};
}

std::string Folder::shown_place(const fs::path& file) const {
    const bool own = std::mismatch(root().begin(), root().end(), file.begin(), file.end()).first == root().end();
    return clean_text((own ? file.lexically_relative(root()) : file).generic_string());
}

fs::path Folder::resolve(std::string_view name, const fs::path& beside) const {
    const std::string shown = clean_text(name);
    const Name asked = split(name);
    if (asked.parts.empty() || asked.parts.size() > most_parts || name.find('\0') != std::string_view::npos) {
        fail("'{}': not a file name", shown);
    }

    // Where the name says. A link may lead out although the name does not.
    const std::array<fs::path, 2> starts{asked.rooted ? fs::path("/") : beside, asked.rooted ? fs::path() : root()};
    for (const fs::path& start : starts) {
        const fs::path file = joined(start, asked.parts);
        if (!start.empty() && !asked.foreign && holds(file)) {
            return file;
        }
    }

    // Where another system may have meant it.
    const std::vector<fs::path> found = search(asked.parts, beside);
    if (!found.empty()) {
        const std::string which =
            found.size() > 1 ? fmt::format(", the first of {} files that would do", found.size()) : "";
        notes_.try_emplace(shown, fmt::format("No file is named '{}' as it stands; '{}' is read{}.", shown,
                                              shown_place(found[0]), which));
        return found[0];
    }
    const bool more = roots_.size() > 1;
    if (asked.rooted || asked.foreign || asked.climbs()) {
        fail("'{}' lies outside the model's folder{}; allow it with --assets DIR", shown,
             more ? " and those allowed" : "");
    }
    std::error_code error;
    if (fs::exists(joined(root(), asked.parts), error)) {
        fail("'{}' is no plain file inside the model's folder", shown);
    }
    fail("'{}': no such file in the model's folder{}", shown, more ? " or those allowed" : "");
}

std::vector<std::string> Folder::take_notes() const {
    std::vector<std::string> fresh;
    for (const auto& [name, note] : notes_) {
        if (said_.insert(name).second) {
            fresh.push_back(note);
        }
    }
    return fresh;
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
