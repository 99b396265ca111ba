// SPDX-License-Identifier: MIT
// The Vulkan objects behind a graph's handles: transients in shared heaps, imports, views.
#pragma once

#include "gpu/graph_plan.h"
#include "gpu/hash.h"

#include <map>

namespace gn {

/// What the graph was given to work on.
struct Imports {
    std::vector<Texture2D*> textures;    ///< by handle; null for transients
    std::vector<const Buffer*> buffers;  ///< by handle; null for transients
};

class GraphResources {
  public:
    /// Makes an image or buffer, without memory yet, for each transient that a living pass uses.
    GraphResources(Device& device, const GraphDeclaration& declaration, const Imports& imports);
    ~GraphResources();
    GraphResources(const GraphResources&) = delete;
    GraphResources& operator=(const GraphResources&) = delete;

    [[nodiscard]] const Footprints& footprints() const { return footprints_; }
    /// Takes other imports of the same descriptions, as a history that swaps its textures gives.
    void rebind(const Imports& imports);
    /// Binds everything to the plan's heaps.
    void bind_memory(const GraphPlan& plan);

    [[nodiscard]] VkImage image(std::uint32_t texture) const { return images_[texture]; }
    [[nodiscard]] VkBuffer buffer(std::uint32_t index) const { return buffers_[index]; }
    /// Made once per range, type and aspect.
    VkImageView view(std::uint32_t texture, const Range& range, VkImageViewType type, VkImageAspectFlags aspects);

  private:
    void make_texture(std::uint32_t index);
    void make_buffer(std::uint32_t index);
    void destroy();

    Device& device_;
    const GraphDeclaration& declaration_;
    Imports imports_;
    std::vector<VkImage> images_;
    std::vector<VkBuffer> buffers_;
    std::vector<bool> own_image_, own_buffer_;
    Footprints footprints_;
    std::vector<MemoryHeap> heaps_;
    std::map<Fingerprint, VkImageView> views_;
};

}  // namespace gn
