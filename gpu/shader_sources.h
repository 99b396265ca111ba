// SPDX-License-Identifier: MIT
// The include files of shaders: read once, found below one root.
#pragma once

#include "gpu/hash.h"

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace gn {

/// Copies are snapshots: what one reads again the others keep as it was.
class ShaderSources {
  public:
    explicit ShaderSources(std::filesystem::path root) : root_(std::move(root)) {}

    /// The text of `path` below the root; null when there is no such file or it leads out of the root.
    const std::string* read(const std::string& path);

    /// Reads again what was written since it was read, by the files' times and sizes. Gives whether anything was.
    bool refresh();

    /// Adds to `hasher` the text and every file that it can reach by includes, whichever branch they stand in: a
    /// superset of the preprocessed source, without running a preprocessor.
    void fingerprint(Hasher& hasher, const std::string& text);

  private:
    struct File {
        std::optional<std::string> text;
        std::filesystem::file_time_type written{};
        std::uintmax_t bytes = 0;
    };
    [[nodiscard]] File load(const std::string& path) const;
    void visit(Hasher& hasher, const std::string& text, std::set<std::string>& seen);

    std::filesystem::path root_;
    std::map<std::string, File> files_;
};

}  // namespace gn
