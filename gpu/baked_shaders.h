// SPDX-License-Identifier: MIT
// A folder of compiled shaders, written once and read where no compiler is:
//
//     FOLDER/manifest.txt         what it holds and of which library
//     FOLDER/recipes/NAME.toml    the recipes' files
//     FOLDER/shaders/KEY.spv      one shader each, with its length and checksum
//
// A shader's key is made of its composed text alone, so that the files which the text includes are not needed; instead the
// manifest says which library's they were. What is damaged is noticed and said. The code itself is handed to the driver: a
// folder must come from whom the program's own code may come from.
#pragma once

#include "gpu/shader.h"

namespace gn {

/// Version of the library, and a number that differs wherever one of its shaders' files does.
std::string library_stamp();

struct BakedManifest {
    std::string library = library_stamp();
    std::vector<std::string> recipes;            ///< as they were asked for, "pcf,placement=cascades"
    std::vector<std::string> notes;              ///< what was left out, and of what devices it depends; for readers
    std::map<Fingerprint, std::string> shaders;  ///< names by key
};

/// One line an entry; the last one says that it is whole.
std::string text_of(const BakedManifest& manifest);
/// Throws Error naming `where` for a text of another format or library, or one that is damaged.
BakedManifest parse_manifest(const std::string& text, const std::string& where);

/// What the shader is found by.
Fingerprint baked_key(const ShaderSource& source);

class BakedShaders {
  public:
    /// Throws Error with a sentence when there is no such folder, it was written by another library, or is damaged.
    explicit BakedShaders(std::filesystem::path folder);

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    [[nodiscard]] const BakedManifest& manifest() const { return manifest_; }
    /// Throws MissingShader where it was not baked.
    void demand(const Fingerprint& key, const std::string& name) const;
    /// The shader's code. Throws MissingShader where it was not baked, Error where its file is damaged.
    [[nodiscard]] std::vector<std::uint32_t> load(const Fingerprint& key, const std::string& name) const;
    /// `gnomon bake RECIPE... -o FOLDER` with the recipes that it was baked for and one more.
    [[nodiscard]] std::string command_with(const std::string& recipe) const;

  private:
    std::filesystem::path folder_;
    BakedManifest manifest_;
};

}  // namespace gn
