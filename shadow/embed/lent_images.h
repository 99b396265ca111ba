// SPDX-License-Identifier: MIT
// Images of the renderer's within its frames: views of them are kept while they stay in use, layouts end as it asked.
#pragma once

#include "gpu/frames.h"
#include "shadow/embed/embed.h"

#include <map>
#include <tuple>

namespace gn::embed {

/// Stands before the names of all that is the renderer's.
inline constexpr std::string_view lent_mark = "lent ";

class LentImages {
  public:
    /// foreseen: no commands will be recorded, and images may be missing.
    LentImages(Device& device, Frames& frames, bool foreseen = false)
        : device_(device), frames_(frames), foreseen_(foreseen) {}

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
    /// The last tells images apart that are all missing.
    using Key = std::tuple<VkImage, VkFormat, std::size_t>;

    void drop(std::map<Key, Kept>::iterator& entry);

    Device& device_;
    Frames& frames_;
    bool foreseen_;
    std::map<Key, Kept> kept_;
    std::vector<std::pair<std::shared_ptr<Texture2D>, VkImageLayout>> used_;
    uint width_ = 0, height_ = 0;
    std::uint64_t frame_ = 0;
};

}  // namespace gn::embed
