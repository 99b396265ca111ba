// SPDX-License-Identifier: MIT
// What a device counts while passes run, and what the passes say they move: for who asks where their time goes.
#pragma once

#include "gpu/graph_plan.h"

namespace gn {

/// Work of one pass as the device counted it. Drivers may count helper pixels, or whole blocks, as fragments.
struct PassCounts {
    std::uint64_t vertices = 0;    ///< invocations of the vertex shader
    std::uint64_t emitted = 0;     ///< primitives that a geometry shader made
    std::uint64_t primitives = 0;  ///< that clipping left
    std::uint64_t fragments = 0;   ///< invocations of the fragment shader
    std::uint64_t items = 0;       ///< invocations of the compute shader
    bool operator==(const PassCounts&) const = default;
};

struct CountedPass {
    std::string name, group;
    bool draws = false;                ///< has attachments
    bool shades = false;               ///< writes colours or storage: what its shaders work out is kept
    std::optional<PassCounts> counts;  ///< absent where the device has no pipeline statistics
    std::optional<std::uint64_t>
        samples;              ///< that passed the tests of depth and stencil; absent where not counted exactly
    std::uint64_t bytes = 0;  ///< moved at the least: least_bytes
};

/// What a pass must move at the least: all that it writes, attachments that it keeps, and of every texture and buffer that it
/// reads each texel or word once, or one an invocation where those are fewer. Without counts reads are whole.
std::uint64_t least_bytes(const GraphDeclaration& declaration, const DeclaredPass& pass,
                          const std::optional<PassCounts>& counts);

/// While it lives, graphs that its thread executes without times on its device are counted; counting costs time. The device
/// is one of Device::create, which enables what there is. One at a time in a thread.
class PassCounters {
  public:
    explicit PassCounters(Device& device);
    ~PassCounters();
    PassCounters(const PassCounters&) = delete;
    PassCounters& operator=(const PassCounters&) = delete;

    /// Of the graph executed last, in order of execution, as GraphStatistics::passes.
    [[nodiscard]] const std::vector<CountedPass>& passes() const { return passes_; }
    /// What this device does not count, in one sentence, or "".
    [[nodiscard]] std::string missing() const;

    // For who executes a graph.
    /// The one that lives for this device in this thread, or null.
    static PassCounters* of(const Device& device);
    void begin(VkCommandBuffer commands, std::uint32_t passes);
    void open(VkCommandBuffer commands);
    void close(VkCommandBuffer commands);
    /// Reads what was counted; the commands have ended.
    void finish(const GraphDeclaration& declaration, std::span<const Turn> turns);

  private:
    void make_pools(std::uint32_t passes);
    void destroy_pools();

    Device& device_;
    bool statistics_ = false, samples_ = false;
    VkQueryPool statistics_pool_ = VK_NULL_HANDLE, samples_pool_ = VK_NULL_HANDLE;
    std::uint32_t capacity_ = 0, next_ = 0;
    std::vector<CountedPass> passes_;
};

}  // namespace gn
