// SPDX-License-Identifier: MIT
// The pictures of a glTF file.
#pragma once

#include "shadow/scene/files/gltf_data.h"

namespace gn::gltf {

/// Decodes each picture once; a broken one is reported once and then missing.
class Pictures {
  public:
    Pictures(File& file, Model& model) : file_(file), model_(model) {}

    /// Index into model.textures, or -1. Where a texture is repeated in mirror images, the picture and its image side by side
    /// are one period of plain repetition: coordinates take share_of_period() of it.
    int texture(int texture_index);
    /// The same of a texture as a light shows it: once, whatever its sampler says of repetition.
    int shown_by_light(int texture_index);
    /// One, or a half along each axis in which the texture is mirrored.
    [[nodiscard]] dvec2 share_of_period(int texture_index) const;
    /// Mean green and blue of a picture, (1, 1) without one.
    vec2 mean_green_blue(int texture_index);

  private:
    [[nodiscard]] bool exists(int image) const;
    std::vector<int> sources(int texture_index, const char* otherwise);
    int texture(int texture_index, int image_index);
    [[nodiscard]] std::string shown_name(int image) const;
    [[nodiscard]] std::span<const std::byte> bytes_of(int image) const;
    std::optional<Image8> decode(int image);
    void say_failures(const std::string& instead);

    File& file_;
    Model& model_;
    std::map<std::array<int, 5>, int> textures_;
    std::map<int, vec2> means_;
    std::map<int, bool> broken_;
    std::vector<std::string> failures_;  ///< not said yet
    std::size_t pixels_ = 0;
};

}  // namespace gn::gltf
