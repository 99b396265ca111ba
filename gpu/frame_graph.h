// SPDX-License-Identifier: MIT
// The frame graph: passes declare what they read and write in one lambda and record in another. Barriers, transient
// memory, culling of unused passes, debug labels, per-pass time and per-resource bytes come from here and nowhere else.
//
//     const TextureHandle map = graph.create({.name = "map", .format = VK_FORMAT_D32_SFLOAT, .width = 1024, .height = 1024});
//     graph.add_pass("map",
//         [&](PassBuilder& pass) { pass.depth(map, Load::clear, {.depth = 1.0F}); pass.vertices(vertex_buffer); },
//         [=](Recorder& r) { r.bind(desc); r.set("light", light); r.draw(3); });
#pragma once

#include "base/math.h"
#include "gpu/memory.h"
#include "gpu/pipeline.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gn {

struct TextureHandle {
    std::uint32_t index = ~0U;
    [[nodiscard]] bool valid() const { return index != ~0U; }
    bool operator==(const TextureHandle&) const = default;
};
struct BufferHandle {
    std::uint32_t index = ~0U;
    [[nodiscard]] bool valid() const { return index != ~0U; }
    bool operator==(const BufferHandle&) const = default;
};

/// A part of a texture; counts of ~0 mean "the rest".
struct Range {
    std::uint32_t mip = 0, mips = ~0U, layer = 0, layers = ~0U;
    bool operator==(const Range&) const = default;
};
inline Range one_layer(std::uint32_t layer, std::uint32_t mip = 0) {
    return {mip, 1, layer, 1};
}
inline Range one_mip(std::uint32_t mip) {
    return {mip, 1, 0, ~0U};
}

enum class Load { clear, keep, discard };
struct ClearValue {
    vec4 color{0};
    float depth = 0.0F;
    std::uint32_t stencil = 0;
    uvec4 bits{0};  ///< for integer formats
    bool operator==(const ClearValue&) const = default;
};

/// Samplers that parts may ask for, by kind; the recorder makes them once.
struct SamplerDesc {
    VkFilter filter = VK_FILTER_NEAREST;
    bool mip_linear = false;
    VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    VkSamplerAddressMode address_v = VK_SAMPLER_ADDRESS_MODE_MAX_ENUM;  ///< as `address` unless given
    VkBorderColor border = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    std::optional<VkCompareOp> compare;
    float anisotropy = 0.0F;  ///< 0 or 1: off
    bool operator==(const SamplerDesc&) const = default;
};
inline SamplerDesc nearest() {
    return {};
}
inline SamplerDesc linear() {
    return {.filter = VK_FILTER_LINEAR};
}
inline SamplerDesc trilinear() {
    return {.filter = VK_FILTER_LINEAR, .mip_linear = true};
}

class PassBuilder {
  public:
    virtual ~PassBuilder() = default;
    // Attachments; all of a pass have the same extent. A range with several layers makes a layered pass (gl_Layer).
    virtual void color(TextureHandle target, Load load, ClearValue clear = {}, Range range = {0, 1, 0, 1}) = 0;
    virtual void depth(TextureHandle target, Load load, ClearValue clear = {}, Range range = {0, 1, 0, 1}) = 0;
    /// Tested, not written; the stencil beside it may be, and starts at `clear_stencil` where that is given.
    virtual void depth_read_only(TextureHandle target, Range range = {0, 1, 0, 1},
                                 std::optional<std::uint32_t> clear_stencil = {}) = 0;
    // Shader access.
    virtual void sample(TextureHandle texture, Range range = {}) = 0;
    virtual void storage_read(TextureHandle texture, Range range = {}) = 0;
    virtual void storage_write(TextureHandle texture, Range range = {}) = 0;  ///< also read-modify-write
    virtual void storage_read(BufferHandle buffer) = 0;
    virtual void storage_write(BufferHandle buffer) = 0;
    virtual void vertices(BufferHandle buffer) = 0;
    virtual void indices(BufferHandle buffer) = 0;
    virtual void indirect(BufferHandle buffer) = 0;
    virtual void copy_from(TextureHandle texture, Range range = {}) = 0;
    virtual void copy_to(TextureHandle texture, Range range = {}) = 0;
    virtual void copy_from(BufferHandle buffer) = 0;
    virtual void copy_to(BufferHandle buffer) = 0;
    /// Never culled, even when nobody reads what it writes.
    virtual void keep() = 0;
};

/// What an execute lambda records with. Only declared resources may be used (checked: Error names pass and resource).
/// Inside a pass with attachments rendering has begun, viewport and scissor cover the whole target. In a pass without
/// attachments the commands see each other's results in order.
class Recorder {
  public:
    virtual ~Recorder() = default;
    virtual void bind(const ComputeDesc& desc) = 0;
    virtual void bind(const RasterDesc& desc) = 0;
    // Resources by the name they have in the shader; a name the bound shaders do not use is ignored.
    virtual void set(std::string_view name, TextureHandle texture, const SamplerDesc& sampler = {},
                     Range range = {}) = 0;
    virtual void set_storage(std::string_view name, TextureHandle texture, Range range = {0, 1, 0, ~0U}) = 0;
    virtual void set(std::string_view name, BufferHandle buffer) = 0;
    /// A uniform (or read-only storage) block with these bytes, valid for the following draws of this pass.
    virtual void set_bytes(std::string_view name, std::span<const std::byte> bytes) = 0;
    template <class T>
    void set_value(std::string_view name, const T& value) {
        set_bytes(name, std::as_bytes(std::span(&value, 1)));
    }
    virtual void push(std::span<const std::byte> bytes) = 0;  ///< push constants, at most 128 bytes
    template <class T>
    void push_value(const T& value) {
        push(std::as_bytes(std::span(&value, 1)));
    }
    virtual void viewport(float x, float y, float width, float height) = 0;
    virtual void scissor(std::int32_t x, std::int32_t y, std::uint32_t width, std::uint32_t height) = 0;
    virtual void depth_bias(float constant, float slope, float clamp = 0.0F) = 0;
    virtual void stencil_reference(std::uint32_t value) = 0;
    virtual void vertex_buffer(BufferHandle buffer, VkDeviceSize offset = 0) = 0;
    virtual void index_buffer(BufferHandle buffer, VkDeviceSize offset = 0) = 0;  ///< 32-bit indices
    virtual void draw(std::uint32_t vertices, std::uint32_t instances = 1, std::uint32_t first_vertex = 0,
                      std::uint32_t first_instance = 0) = 0;
    virtual void draw_indexed(std::uint32_t indices, std::uint32_t instances = 1, std::uint32_t first_index = 0,
                              std::int32_t vertex_offset = 0, std::uint32_t first_instance = 0) = 0;
    /// Many draws with the same state: one command where the device takes their list from a buffer.
    virtual void draw_indexed(std::span<const VkDrawIndexedIndirectCommand> draws) = 0;
    virtual void draw_indirect(BufferHandle arguments, VkDeviceSize offset = 0) = 0;
    /// Consecutive VkDrawIndexedIndirectCommands from `offset`; more than one where the device draws several at once.
    virtual void draw_indexed_indirect(BufferHandle arguments, VkDeviceSize offset = 0, std::uint32_t draws = 1) = 0;
    virtual void dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z = 1) = 0;
    virtual void dispatch_indirect(BufferHandle arguments, VkDeviceSize offset = 0) = 0;
    /// One workgroup per tile of 8 x 8 pixels.
    void dispatch_pixels(std::uint32_t width, std::uint32_t height) { dispatch((width + 7) / 8, (height + 7) / 8); }
    virtual void blit(TextureHandle from, Range from_range, TextureHandle to, Range to_range, VkFilter filter) = 0;
    virtual void copy(TextureHandle from, BufferHandle to, Range range) = 0;
    virtual void copy(BufferHandle from, BufferHandle to, VkDeviceSize bytes, VkDeviceSize from_offset = 0,
                      VkDeviceSize to_offset = 0) = 0;
    virtual void fill(BufferHandle buffer, std::uint32_t word) = 0;
    [[nodiscard]] virtual const TextureDesc& desc(TextureHandle texture) const = 0;
    /// The commands themselves, null where only pipelines are made. Whoever records into them says so with `forget`: what is
    /// bound is then bound anew, and viewport and scissor cover the whole target again.
    [[nodiscard]] virtual VkCommandBuffer vk() const = 0;
    virtual void forget() = 0;
};

struct PassTime {
    std::string name, group;
    double ms = 0;
};
struct ResourceBytes {
    std::string name, group;  ///< the group that created it
    VkDeviceSize bytes = 0;   ///< by the formats' arithmetic
    bool transient = true;
};
struct GraphStatistics {
    std::vector<PassTime> passes;          ///< in order of execution, culled ones left out
    std::vector<ResourceBytes> resources;  ///< used ones
    VkDeviceSize transient_bytes = 0;      ///< memory really taken, with aliasing
};

struct GraphPlan;
struct PipelineOrder;
class Frames;

class FrameGraph {
  public:
    explicit FrameGraph(Device& device);
    ~FrameGraph();
    FrameGraph(const FrameGraph&) = delete;
    FrameGraph& operator=(const FrameGraph&) = delete;

    TextureHandle create(const TextureDesc& desc);  ///< transient; contents undefined before the first write
    BufferHandle create(const BufferDesc& desc);
    TextureHandle import(Texture2D& texture);  ///< must outlive the graph
    BufferHandle import(const Buffer& buffer);
    [[nodiscard]] bool imported(TextureHandle texture) const;
    /// Lets a transient texture live on in one of the caller's, which `give` returns for its description with the uses
    /// declared so far and sampling; it must outlive the graph.
    void place(TextureHandle texture, const std::function<Texture2D&(const TextureDesc&)>& give);
    [[nodiscard]] const TextureDesc& desc(TextureHandle texture) const;
    [[nodiscard]] const BufferDesc& desc(BufferHandle buffer) const;

    /// Between begin and end what a round creates takes the place of what the round before created by the same name and
    /// description, and passes that are those of the round before are its passes again, with other constants: one set of
    /// resources and passes serves all rounds. Contents are undefined before the round's first write.
    void begin_rounds();
    void next_round();
    void end_rounds();

    /// Names the group that following passes and resources belong to ("scene", "shadow", "shading").
    void group(std::string name);
    [[nodiscard]] const std::string& group() const;

    /// Whether passes from here on rest: they are declared, so that frames that run them and frames that do not have one
    /// plan, and this frame runs none of them.
    void rest(bool rests);
    void add_pass(std::string name, const std::function<void(PassBuilder&)>& setup,
                  std::function<void(Recorder&)> execute);
    /// Keeps a transient's contents past execute, for download; its producers are not culled.
    void keep(TextureHandle texture);
    void keep(BufferHandle buffer);
    /// Hands the buffer's final contents to `receive` without a stall: after execute, which waits anyway; after record,
    /// when the frame's slot is taken up again, so a frame or more late. `receive` must not throw.
    void answer(BufferHandle buffer, std::function<void(std::span<const std::byte>)> receive);
    /// Keeps an object that the passes use: as long as the graph, and where that is recorded until the slot is taken up
    /// again.
    void hold(std::shared_ptr<const void> object);

    /// Makes every pipeline and sampler that the passes will bind, and records nothing: what a host does before its first
    /// frame, so that none waits for a compiler. Throws Error.
    void compile();
    /// The pipelines that the passes will bind and that are not made yet, for who makes them elsewhere. Records nothing.
    [[nodiscard]] std::vector<PipelineOrder> missing();
    /// Tells every shader that the passes will bind, and makes nothing of it.
    void find_shaders(const std::function<void(const ShaderSource&)>& found);
    /// Culls, orders by declaration, places memory, records, submits and waits. May be called again: the same graph
    /// is then run once more. Throws Error on out-of-memory or a lost device.
    void execute(bool timed = true);
    /// Records the frame into a command buffer of the caller's: plan and memory come from `frames`, in its slot in hand.
    /// Neither submits nor waits; imported textures are left in the layouts that they say afterwards. What is imported
    /// must live until the slot is taken up again. Throws Error.
    void record(Frames& frames, VkCommandBuffer commands);
    /// Of the last execute, or of the last plan without times.
    [[nodiscard]] const GraphStatistics& statistics() const;
    /// Contents after execute of a kept transient or an imported resource, rows tightly packed.
    std::vector<std::byte> download(TextureHandle texture, std::uint32_t mip = 0, std::uint32_t layer = 0);
    std::vector<std::byte> download(BufferHandle buffer);
    /// Passes, their ports and barriers as text, for reports and tests.
    [[nodiscard]] std::string describe() const;
    /// The barriers and the memory that execute would use now; needs no GPU (gpu/null_device.h).
    [[nodiscard]] const GraphPlan& plan();
    [[nodiscard]] Device& device();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gn
