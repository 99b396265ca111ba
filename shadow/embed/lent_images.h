// SPDX-License-Identifier: MIT
// Images of the renderer's within its frames: views of them are kept while they stay in use, layouts end as it asked.
#pragma once

#include "gpu/frames.h"
#include "shadow/embed/embed.h"

#include <map>

namespace gn::embed {

class LentImages {
  public:
    LentImages(Device& device, Frames& frames) : device_(device), frames_(frames) {}

    /// A new frame of images of this size. Views of another size are given up, and of images that were not lent for longer than
    /// frames are in flight.
    void begin(uint width, uint height);
    /// Throws Error where there is no image, or one format is missing.
    TextureHandle import(FrameGraph& graph, const char* name, const LentImage& lent, VkImageUsageFlags usage);
    /// After the frame was recorded: leaves every image in the layout that was asked for, for all that follows on the queue.
    void give_back(VkCommandBuffer commands);

    /// Gives up all views.
    void forget();

  private:
    struct Kept {
        std::shared_ptr<Texture2D> texture;
        std::uint64_t last_used = 0;
    };
    using Key = std::pair<VkImage, VkFormat>;

    void drop(std::map<Key, Kept>::iterator& entry);

    Device& device_;
    Frames& frames_;
    std::map<Key, Kept> kept_;
    std::vector<std::pair<std::shared_ptr<Texture2D>, VkImageLayout>> used_;
    uint width_ = 0, height_ = 0;
    std::uint64_t frame_ = 0;
};

}  // namespace gn::embed
