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

class ShaderSources {
  public:
    explicit ShaderSources(std::filesystem::path root) : root_(std::move(root)) {}

    /// The text of `path` below the root; null when there is no such file or it leads out of the root.
    const std::string* read(const std::string& path);

    /// Adds to `hasher` the text and every file that it can reach by includes, whichever branch they stand in: a
    /// superset of the preprocessed source, without running a preprocessor.
    void fingerprint(Hasher& hasher, const std::string& text);

  private:
    void visit(Hasher& hasher, const std::string& text, std::set<std::string>& seen);
    std::filesystem::path root_;
    std::map<std::string, std::optional<std::string>> files_;
};

}  // namespace gn
