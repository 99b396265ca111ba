// SPDX-License-Identifier: MIT
#include "gpu/memory.h"

#include "gpu/transfer.h"
#include "gpu/vk_names.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace gn {

bool is_depth(VkFormat format) {
    return format == VK_FORMAT_D16_UNORM || format == VK_FORMAT_X8_D24_UNORM_PACK32 || format == VK_FORMAT_D32_SFLOAT ||
           has_stencil(format);
}

bool has_stencil(VkFormat format) {
    return format == VK_FORMAT_D24_UNORM_S8_UINT || format == VK_FORMAT_D32_SFLOAT_S8_UINT;
}

int channels_of(VkFormat format) {
    switch (format) {
        case VK_FORMAT_D32_SFLOAT:
        case VK_FORMAT_D16_UNORM:
        case VK_FORMAT_D32_SFLOAT_S8_UINT:
        case VK_FORMAT_R8_UNORM:
        case VK_FORMAT_R16_UNORM:
        case VK_FORMAT_R16_SFLOAT:
        case VK_FORMAT_R32_SFLOAT: return 1;
        case VK_FORMAT_R8G8_UNORM:
        case VK_FORMAT_R16G16_UNORM:
        case VK_FORMAT_R16G16_SFLOAT:
        case VK_FORMAT_R32G32_SFLOAT: return 2;
        default: return 4;
    }
}

VkImageAspectFlags aspects_of(VkFormat format) {
    if (!is_depth(format)) {
        return VK_IMAGE_ASPECT_COLOR_BIT;
    }
    VkImageAspectFlags aspects = VK_IMAGE_ASPECT_DEPTH_BIT;
    if (has_stencil(format)) {
        aspects |= VK_IMAGE_ASPECT_STENCIL_BIT;
    }
    return aspects;
}

VkDeviceSize format_bytes(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R8_UNORM:
        case VK_FORMAT_R8_SNORM:
        case VK_FORMAT_R8_UINT: return 1;
        case VK_FORMAT_R8G8_UNORM:
        case VK_FORMAT_R8G8_SNORM:
        case VK_FORMAT_R8G8_UINT:
        case VK_FORMAT_R16_UNORM:
        case VK_FORMAT_R16_SNORM:
        case VK_FORMAT_R16_SFLOAT:
        case VK_FORMAT_R16_UINT:
        case VK_FORMAT_D16_UNORM: return 2;
        case VK_FORMAT_R8G8B8A8_UNORM:
        case VK_FORMAT_R8G8B8A8_SNORM:
        case VK_FORMAT_R8G8B8A8_SRGB:
        case VK_FORMAT_R8G8B8A8_UINT:
        case VK_FORMAT_B8G8R8A8_UNORM:
        case VK_FORMAT_B8G8R8A8_SRGB:
        case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
        case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
        case VK_FORMAT_R16G16_UNORM:
        case VK_FORMAT_R16G16_SNORM:
        case VK_FORMAT_R16G16_SFLOAT:
        case VK_FORMAT_R16G16_UINT:
        case VK_FORMAT_R32_SFLOAT:
        case VK_FORMAT_R32_UINT:
        case VK_FORMAT_R32_SINT:
        case VK_FORMAT_X8_D24_UNORM_PACK32:
        case VK_FORMAT_D24_UNORM_S8_UINT:
        case VK_FORMAT_D32_SFLOAT:
        case VK_FORMAT_D32_SFLOAT_S8_UINT: return 4;
        case VK_FORMAT_R16G16B16A16_UNORM:
        case VK_FORMAT_R16G16B16A16_SNORM:
        case VK_FORMAT_R16G16B16A16_SFLOAT:
        case VK_FORMAT_R16G16B16A16_UINT:
        case VK_FORMAT_R32G32_SFLOAT:
        case VK_FORMAT_R32G32_SINT:
        case VK_FORMAT_R32G32_UINT: return 8;
        case VK_FORMAT_R32G32B32A32_SFLOAT:
        case VK_FORMAT_R32G32B32A32_SINT:
        case VK_FORMAT_R32G32B32A32_UINT: return 16;
        default: fail("format {} is not one that textures can have here", format_name(format));
    }
}

VkDeviceSize texel_bytes(const TextureDesc& desc) {
    // A stencil byte beside 32-bit depth is the one case where memory holds more than a download delivers.
    const VkDeviceSize texel = format_bytes(desc.format) + (desc.format == VK_FORMAT_D32_SFLOAT_S8_UINT ? 1 : 0);
    VkDeviceSize texels = 0;
    for (std::uint32_t mip = 0; mip < desc.mips; ++mip) {
        texels += VkDeviceSize{std::max(desc.width >> mip, 1U)} * std::max(desc.height >> mip, 1U);
    }
    return texels * texel * desc.layers * desc.samples;
}

Buffer::Buffer(Device& device, const BufferDesc& desc) : device_(&device), desc_(desc) {
    desc_.bytes = std::max<VkDeviceSize>(desc.bytes, 16);
    desc_.usage |= VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (desc_.bytes > device.memory().largest()) {
        fail("buffer '{}' needs {} MiB; this device allows {} MiB", desc.name, desc_.bytes >> 20U,
             device.memory().largest() >> 20U);
    }
    const VkBufferCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = desc_.bytes, .usage = desc_.usage};
    GN_VK(vkCreateBuffer(device.vk(), &info, nullptr, &buffer_));
    ++device.counters().buffers;
    try {
        VkMemoryRequirements needs{};
        vkGetBufferMemoryRequirements(device.vk(), buffer_, &needs);
        memory_ = device.memory().allocate(needs, desc.host_visible ? MemoryUse::host : MemoryUse::buffer,
                                           fmt::format("buffer '{}'", desc.name));
        GN_VK(vkBindBufferMemory(device.vk(), buffer_, memory_.memory, memory_.offset));
    } catch (...) {
        *this = Buffer();
        throw;
    }
}

Buffer Buffer::borrow(const BufferDesc& desc, VkBuffer buffer) {
    Buffer borrowed;
    borrowed.desc_ = desc;
    borrowed.buffer_ = buffer;
    borrowed.borrowed_ = true;
    return borrowed;
}

Buffer::Buffer(Buffer&& other) noexcept {
    *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(desc_, other.desc_);
    std::swap(buffer_, other.buffer_);
    std::swap(borrowed_, other.borrowed_);
    std::swap(memory_, other.memory_);
    return *this;
}

Buffer::~Buffer() {
    if (buffer_ != VK_NULL_HANDLE && !borrowed_) {
        vkDestroyBuffer(device_->vk(), buffer_, nullptr);
        device_->memory().release(memory_);
    }
}

namespace {

/// Refuses what the driver would answer with undefined behaviour.
void check_texture(Device& device, const TextureDesc& desc, const VkImageCreateInfo& info) {
    const VkPhysicalDeviceLimits& limits = device.properties().limits;
    const std::uint32_t side = std::max(desc.width, desc.height);
    if (desc.width == 0 || desc.height == 0 || desc.layers == 0 || desc.mips == 0) {
        fail("texture '{}' of {} x {} x {} layers, {} mips is empty; every count must be at least 1", desc.name,
             desc.width, desc.height, desc.layers, desc.mips);
    }
    if (desc.mips > static_cast<std::uint32_t>(std::bit_width(side))) {
        fail("texture '{}' of {} x {} has at most {} mips, not {}", desc.name, desc.width, desc.height,
             std::bit_width(side), desc.mips);
    }
    if (side > limits.maxImageDimension2D || desc.layers > limits.maxImageArrayLayers) {
        fail("texture '{}' of {} x {} x {} layers exceeds the device's limit of {} pixels a side and {} layers",
             desc.name, desc.width, desc.height, desc.layers, limits.maxImageDimension2D, limits.maxImageArrayLayers);
    }
    VkImageFormatProperties properties{};
    const VkResult result = vkGetPhysicalDeviceImageFormatProperties(device.physical(), info.format, info.imageType,
                                                                     info.tiling, info.usage, info.flags, &properties);
    if (result != VK_SUCCESS || (properties.sampleCounts & info.samples) == 0 || desc.mips > properties.maxMipLevels) {
        fail("texture '{}': the device has no {} images with {} samples, {} mips and usage {:#x}", desc.name,
             format_name(desc.format), desc.samples, desc.mips, info.usage);
    }
}

}  // namespace

VkImage create_image(Device& device, const TextureDesc& desc) {
    const VkImageCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .flags = desc.cube ? VkImageCreateFlags{VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT} : VkImageCreateFlags{0},
        .imageType = VK_IMAGE_TYPE_2D,
        .format = desc.format,
        .extent = {desc.width, desc.height, 1},
        .mipLevels = desc.mips,
        .arrayLayers = desc.layers,
        .samples = static_cast<VkSampleCountFlagBits>(desc.samples),
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = desc.usage,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
    };
    check_texture(device, desc, info);
    VkImage image = VK_NULL_HANDLE;
    GN_VK(vkCreateImage(device.vk(), &info, nullptr, &image));
    ++device.counters().images;
    return image;
}

Texture2D::Texture2D(Device& device, const TextureDesc& desc) : device_(&device), desc_(desc) {
    desc_.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    image_ = create_image(device, desc_);
    layouts.assign(std::size_t{desc.mips} * desc.layers, VK_IMAGE_LAYOUT_UNDEFINED);
    try {
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(device.vk(), image_, &needs);
        memory_ = device.memory().allocate(needs, MemoryUse::image, fmt::format("texture '{}'", desc.name));
        GN_VK(vkBindImageMemory(device.vk(), image_, memory_.memory, memory_.offset));
    } catch (...) {
        *this = Texture2D();
        throw;
    }
}

Texture2D Texture2D::borrow(Device& device, const TextureDesc& desc, VkImage image, VkImageLayout layout) {
    Texture2D borrowed;
    borrowed.device_ = &device;
    borrowed.desc_ = desc;
    borrowed.image_ = image;
    borrowed.borrowed_ = true;
    borrowed.layouts.assign(std::size_t{desc.mips} * desc.layers, layout);
    return borrowed;
}

VkImageView create_view(Device& device, VkImage image, VkFormat format, VkImageViewType type,
                        const VkImageSubresourceRange& range) {
    const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = image,
                                     .viewType = type,
                                     .format = format,
                                     .subresourceRange = range};
    VkImageView view = VK_NULL_HANDLE;
    GN_VK(vkCreateImageView(device.vk(), &info, nullptr, &view));
    ++device.counters().views;
    return view;
}

VkImageView Texture2D::view(VkImageViewType type, const VkImageSubresourceRange& range) {
    const auto found = std::find_if(views_.begin(), views_.end(), [&](const View& held) {
        return held.type == type && held.range.aspectMask == range.aspectMask &&
               held.range.baseMipLevel == range.baseMipLevel && held.range.levelCount == range.levelCount &&
               held.range.baseArrayLayer == range.baseArrayLayer && held.range.layerCount == range.layerCount;
    });
    if (found != views_.end()) {
        return found->vk;
    }
    views_.push_back({type, range, create_view(*device_, image_, desc_.format, type, range)});
    return views_.back().vk;
}

Texture2D::Texture2D(Texture2D&& other) noexcept {
    *this = std::move(other);
}

Texture2D& Texture2D::operator=(Texture2D&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(desc_, other.desc_);
    std::swap(image_, other.image_);
    std::swap(memory_, other.memory_);
    std::swap(borrowed_, other.borrowed_);
    std::swap(views_, other.views_);
    std::swap(layouts, other.layouts);
    return *this;
}

Texture2D::~Texture2D() {
    for (const View& held : views_) {
        vkDestroyImageView(device_->vk(), held.vk, nullptr);
    }
    if (image_ != VK_NULL_HANDLE && !borrowed_) {
        vkDestroyImage(device_->vk(), image_, nullptr);
        device_->memory().release(memory_);
    }
}

}  // namespace gn
