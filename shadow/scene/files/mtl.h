// SPDX-License-Identifier: MIT
// Wavefront material libraries.
#pragma once

#include "shadow/scene/files/files.h"
#include "shadow/scene/model.h"

#include <map>

namespace gn {

/// How a material's pictures lie on its texture coordinates: t = scale * (u, v) + offset, v upwards.
struct MapPlacement {
    vec2 scale{1.0F}, offset{0.0F};
    bool clamp = false;
};

/// Collects materials and textures into a model. What cannot be read becomes a note, never an Error.
class MaterialLibrary {
  public:
    MaterialLibrary(const Folder& folder, Model& model) : folder_(folder), model_(model) {}
    /// Reads what follows "mtllib": one or several file names.
    void read(std::string_view names);
    /// The material's index; a grey one where the name is unknown.
    int find(const std::string& name);
    [[nodiscard]] MapPlacement placement(int material) const;

  private:
    struct Entry;
    void read_file_named(const std::string& name);
    void finish(const Entry& entry);
    int load_texture(const Entry& entry);
    std::optional<Image8> load_image(const std::string& name);

    const Folder& folder_;
    Model& model_;
    std::filesystem::path beside_;  ///< the folder of the library that is being read
    std::map<int, MapPlacement> placements_;
    std::map<std::string, int, std::less<>> materials_;
    std::map<std::string, int> textures_;
    std::map<std::string, bool> read_;
    std::size_t pixels_ = 0;
};

}  // namespace gn
