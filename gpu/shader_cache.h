// SPDX-License-Identifier: MIT
// SPIR-V, and what drivers make of it, on disk: words, one file a key. A damaged or half-written file counts as absent.
#pragma once

#include "gpu/hash.h"

#include <filesystem>
#include <vector>

namespace gn {

class ShaderCache {
  public:
    /// An empty folder turns the cache off.
    explicit ShaderCache(std::filesystem::path folder);
    /// Empty when there is no intact entry.
    [[nodiscard]] std::vector<std::uint32_t> load(const Fingerprint& key) const;
    /// Writes beside and renames; a full or read-only disk is not an error.
    void store(const Fingerprint& key, const std::vector<std::uint32_t>& spirv) const;
    [[nodiscard]] std::filesystem::path file(const Fingerprint& key) const;

  private:
    std::filesystem::path folder_;
};

}  // namespace gn
