// SPDX-License-Identifier: MIT
#include "gpu/frames.h"

#include "gpu/graph_account.h"
#include "gpu/memory_barrier.h"
#include "gpu/pass_writer.h"

#include <algorithm>

namespace gn {
namespace {

constexpr std::uint32_t most_in_flight = 8;
/// A plan that no frame asked for in so many frames gives its memory back: the picture was resized, the recipe changed.
constexpr std::uint64_t frames_unused = 64;
/// A host that alternates between more pictures than this makes them anew.
constexpr std::size_t most_plans = 8;

}  // namespace

/// A declaration that was seen, with all that it needs on the device.
struct FramePlan {
    Fingerprint key;
    GraphDeclaration declaration;  ///< as first seen; what resources look into
    GraphPlan plan;
    std::unique_ptr<GraphResources> resources;
    std::shared_ptr<const GraphStatistics> statistics;  ///< of the frame recorded last
    std::uint64_t last_used = 0;

    /// Follows what may differ between frames of one plan.
    void update() {
        synchronize(declaration, plan);
        statistics = std::make_shared<const GraphStatistics>(account(declaration, plan, {}));
    }
};

struct FrameSlot {
    explicit FrameSlot(Device& device) : arena(device), timestamps(device) {}
    UploadArena arena;
    PassTimestamps timestamps;
    std::vector<std::shared_ptr<const void>> retired;
    std::shared_ptr<FramePlan> recorded;                ///< what was recorded last
    std::shared_ptr<const GraphStatistics> statistics;  ///< of that
    GraphStatistics completed;
    struct Waiting {
        std::span<const std::byte> bytes;
        std::function<void(std::span<const std::byte>)> receive;
    };
    std::vector<Waiting> waiting;  ///< for answers that the device writes into the arena
};

namespace {

/// Brings what may differ between frames of one plan from `now` to `held`; whether anything did.
bool follow(GraphDeclaration& held, const GraphDeclaration& now) {
    bool differs = false;
    const auto assign = [&](auto&& to, const auto& from) {
        differs = differs || to != from;
        to = from;
    };
    for (std::size_t i = 0; i < now.textures.size(); ++i) {
        assign(held.textures[i].initial, now.textures[i].initial);
    }
    for (std::size_t i = 0; i < now.passes.size(); ++i) {
        assign(held.passes[i].rests, now.passes[i].rests);
    }
    return differs;
}

}  // namespace

struct Frames::Impl {
    Device& device;
    std::vector<std::unique_ptr<FrameSlot>> slots;
    std::vector<std::shared_ptr<FramePlan>> plans;
    std::uint32_t slot = 0;
    std::uint64_t frame = 0;

    std::shared_ptr<FramePlan> planned_for(const GraphDeclaration& declaration, const Imports& imports) {
        const Fingerprint key = fingerprint(declaration);
        const auto found = std::find_if(plans.begin(), plans.end(), [&](const auto& held) { return held->key == key; });
        std::shared_ptr<FramePlan> planned = found != plans.end() ? *found : make(key, declaration, imports);
        planned->last_used = frame;
        planned->resources->rebind(imports);
        if (follow(planned->declaration, declaration)) {
            planned->update();
        }
        return planned;
    }

    std::shared_ptr<FramePlan> make(const Fingerprint& key, const GraphDeclaration& declaration,
                                    const Imports& imports) {
        auto planned = std::make_shared<FramePlan>();
        planned->key = key;
        planned->declaration = declaration;
        planned->resources = std::make_unique<GraphResources>(device, planned->declaration, imports);
        planned->plan = make_plan(planned->declaration, planned->resources->footprints());
        planned->resources->bind_memory(planned->plan);
        planned->statistics = std::make_shared<const GraphStatistics>(account(planned->declaration, planned->plan, {}));
        plans.push_back(planned);
        return planned;
    }

    /// Plans of pictures that are no longer drawn retire: frames in flight may still use their memory.
    void retire_unused() {
        std::sort(plans.begin(), plans.end(), [](const auto& a, const auto& b) { return a->last_used > b->last_used; });
        while (!plans.empty() && (plans.size() > most_plans || plans.back()->last_used + frames_unused < frame)) {
            slots[slot]->retired.push_back(std::move(plans.back()));
            plans.pop_back();
        }
    }
};

Frames::Frames(Device& device, std::uint32_t in_flight) : impl_(new Impl{.device = device}) {
    if (in_flight < 1 || in_flight > most_in_flight) {
        fail("{} frames in flight; valid is 1 to {}", in_flight, most_in_flight);
    }
    for (std::uint32_t i = 0; i < in_flight; ++i) {
        impl_->slots.push_back(std::make_unique<FrameSlot>(device));
    }
}

Frames::~Frames() = default;

std::uint32_t Frames::in_flight() const {
    return static_cast<std::uint32_t>(impl_->slots.size());
}

void Frames::begin(std::uint32_t slot) {
    if (slot >= impl_->slots.size()) {
        fail("frame slot {} of {}; valid is 0 to {}", slot, impl_->slots.size(), impl_->slots.size() - 1);
    }
    impl_->slot = slot;
    ++impl_->frame;
    FrameSlot& held = *impl_->slots[slot];
    const std::vector<double> ms = held.timestamps.read(false);
    if (held.recorded != nullptr) {
        held.completed = *held.statistics;
        held.recorded.reset();
    }
    for (std::size_t i = 0; i < ms.size() && i < held.completed.passes.size(); ++i) {
        held.completed.passes[i].ms = ms[i];
    }
    for (const FrameSlot::Waiting& waiting : held.waiting) {
        waiting.receive(waiting.bytes);
    }
    held.waiting.clear();
    held.retired.clear();
    held.arena.reset();
    for (const std::unique_ptr<FrameSlot>& other : impl_->slots) {
        held.arena.match(other->arena);
    }
    impl_->retire_unused();
}

void Frames::retire(std::shared_ptr<const void> object) {
    impl_->slots[impl_->slot]->retired.push_back(std::move(object));
}

const GraphStatistics& Frames::completed(std::uint32_t slot) const {
    GN_CHECK(slot < impl_->slots.size());
    return impl_->slots[slot]->completed;
}

std::size_t Frames::plans() const {
    return impl_->plans.size();
}

namespace {

/// Copies the answers to where the host will find them.
void write_answers(const GraphDeclaration& declaration, const FramePlan& planned, const std::vector<Answer>& answers,
                   FrameSlot& slot, VkCommandBuffer commands) {
    if (answers.empty()) {
        return;
    }
    memory_barrier(commands, all_writes, {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
    for (const Answer& answer : answers) {
        if (!planned.plan.buffers[answer.buffer].used) {
            continue;
        }
        const VkDeviceSize bytes = declaration.buffers[answer.buffer].desc.bytes;
        const UploadedBytes target = slot.arena.reserve(bytes);
        const VkBufferCopy region{0, target.offset, bytes};
        vkCmdCopyBuffer(commands, planned.resources->buffer(answer.buffer), target.buffer, 1, &region);
        slot.waiting.push_back({{target.mapped, bytes}, answer.receive});
    }
    memory_barrier(commands, all_writes, host_reads);
}

}  // namespace

const std::vector<std::vector<VkImageLayout>>& Frames::write(
    const GraphDeclaration& declaration, const Imports& imports,
    const std::vector<std::function<void(Recorder&)>>& executes, const std::vector<Answer>& answers,
    VkCommandBuffer commands) {
    const std::shared_ptr<FramePlan> held = impl_->planned_for(declaration, imports);
    FramePlan& planned = *held;
    FrameSlot& slot = *impl_->slots[impl_->slot];
    const bool stamps = impl_->device.has(Feature::timestamps);
    PassWriter writer(impl_->device, declaration, *planned.resources, slot.arena);
    const std::vector<Turn> turns = turns_of(declaration, planned.plan);

    // What a frame that fails waits for never comes.
    struct Waiting {
        FrameSlot& slot;
        bool whole = false;
        ~Waiting() {
            if (!whole) {
                slot.waiting.clear();
            }
        }
    } waiting{slot};

    // Frames share their transients, so that each begins after all that was recorded before.
    memory_barrier(commands, all_writes, all_uses);
    if (stamps) {
        slot.timestamps.begin(commands, most_turns(declaration, planned.plan));
    }
    for (const Turn& turn : turns) {
        if (stamps) {
            slot.timestamps.stamp(commands);
        }
        writer.write(commands, *turn.pass, executes[turn.call]);
        if (stamps) {
            slot.timestamps.stamp(commands);
        }
    }
    write_answers(declaration, planned, answers, slot, commands);
    slot.recorded = held;
    slot.statistics = planned.statistics;
    waiting.whole = true;
    return planned.plan.final_layouts;
}

}  // namespace gn
