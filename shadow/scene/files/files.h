// SPDX-License-Identifier: MIT
// Reading files that a model names: nothing outside the model's folder and those that the user allows, nothing that is not
// a plain file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gn {

/// Largest file that is read, bytes.
inline constexpr std::size_t max_file_bytes = std::size_t{2} << 30;

/// The whole file. Throws Error when it is missing, not a plain file, unreadable or larger than `cap` bytes.
std::vector<std::byte> read_file(const std::filesystem::path& path, std::size_t cap = max_file_bytes);

/// The folder of a model file, and those that the user allows besides: from them names inside the model are resolved.
class Folder {
  public:
    /// Throws Error where one of the folders cannot be opened.
    explicit Folder(const std::filesystem::path& model_file, std::span<const std::filesystem::path> assets = {});

    /// The file that a model names, from the folder `beside` of the file that names it or from the model's own ('/' or '\'
    /// between parts). Where there is none of that very name, it is looked for as another system may have meant it: in
    /// another letter case, then without its drive and its leading folders, down to the base name; a note says what was
    /// read. Throws Error where nothing fits, or no plain file inside the folders once every link is followed.
    [[nodiscard]] std::filesystem::path resolve(std::string_view name, const std::filesystem::path& beside = {}) const;

    /// Whether an existing absolute or working-directory path lies inside the folders and is a plain file.
    [[nodiscard]] bool holds(const std::filesystem::path& file) const;
    [[nodiscard]] const std::filesystem::path& root() const { return roots_.front(); }
    /// What was read under another name than the model's, one sentence each; none of them a second time.
    [[nodiscard]] std::vector<std::string> take_notes() const;

  private:
    using Path = std::filesystem::path;
    [[nodiscard]] bool inside(const Path& real) const;
    [[nodiscard]] std::vector<Path> matches(const Path& from, std::span<const std::string> parts) const;
    [[nodiscard]] const std::vector<std::string>& spellings(const Path& folder, const std::string& part) const;
    [[nodiscard]] std::vector<Path> search(std::span<const std::string> parts, const Path& beside) const;
    [[nodiscard]] std::string shown_place(const Path& file) const;

    std::vector<Path> roots_;  ///< canonical; the model's own first
    mutable std::map<std::string, std::string> notes_;
    mutable std::set<std::string> said_;
    mutable std::map<Path, std::map<std::string, std::vector<std::string>>> listings_;  ///< lower case to names
};

/// Text fit for a one-line message and for JSON: control characters and bytes outside valid UTF-8 become '?'; at most
/// 200 bytes.
std::string clean_text(std::string_view text);

}  // namespace gn
