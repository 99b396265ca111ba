// SPDX-License-Identifier: MIT
// Reading files that a model names: nothing outside the model's folder, nothing that is not a plain file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gn {

/// Largest file that is read, bytes.
inline constexpr std::size_t max_file_bytes = std::size_t{2} << 30;

/// The whole file. Throws Error when it is missing, not a plain file, unreadable or larger than `cap` bytes.
std::vector<std::byte> read_file(const std::filesystem::path& path, std::size_t cap = max_file_bytes);

/// The folder of a model file, from which names inside the model are resolved.
class Folder {
  public:
    explicit Folder(const std::filesystem::path& model_file);

    /// The file that a model names, relative to the folder ('/' or '\' between parts; subfolders allowed).
    /// Throws Error for absolute names, names that climb out (also through symbolic links), missing files and
    /// anything that is not a plain file.
    [[nodiscard]] std::filesystem::path resolve(std::string_view name) const;

    /// Whether an existing absolute or working-directory path lies inside the folder and is a plain file.
    [[nodiscard]] bool holds(const std::filesystem::path& file) const;
    [[nodiscard]] const std::filesystem::path& root() const { return root_; }

  private:
    std::filesystem::path root_;
};

/// Text fit for a one-line message and for JSON: control characters and bytes outside valid UTF-8 become '?'; at most
/// 200 bytes.
std::string clean_text(std::string_view text);

}  // namespace gn
