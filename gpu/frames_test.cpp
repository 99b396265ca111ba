// SPDX-License-Identifier: MIT
// Frames in flight: a steady frame finds its plan and creates nothing, what changes retires, nothing waits.
#include "gpu/frames.h"

#include "gpu/graph_plan.h"
#include "gpu/null_device.h"
#include "gpu/test_device.h"

namespace gn::frames_test {
namespace {

/// A host: command buffers and fences of its own, a ring of slots.
class Host {
  public:
    Host(Device& device, Frames& frames) : device_(device), frames_(frames) {
        const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                           .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                           .queueFamilyIndex = device.queue_family()};
        GN_VK(vkCreateCommandPool(device.vk(), &pool, nullptr, &pool_));
        commands_.resize(frames.in_flight());
        const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                               .commandPool = pool_,
                                               .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                               .commandBufferCount = frames.in_flight()};
        GN_VK(vkAllocateCommandBuffers(device.vk(), &info, commands_.data()));
        const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                      .flags = VK_FENCE_CREATE_SIGNALED_BIT};
        for (std::uint32_t i = 0; i < frames.in_flight(); ++i) {
            GN_VK(vkCreateFence(device.vk(), &fence, nullptr, &fences_.emplace_back()));
        }
    }
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;
    ~Host() {
        vkDeviceWaitIdle(device_.vk());
        for (const VkFence fence : fences_) {
            vkDestroyFence(device_.vk(), fence, nullptr);
        }
        vkDestroyCommandPool(device_.vk(), pool_, nullptr);
    }

    /// Waits for the slot's last frame alone, then records and submits the next one.
    template <class Record>
    void frame(Record record) {
        const std::uint32_t slot = static_cast<std::uint32_t>(count_++ % fences_.size());
        GN_VK(vkWaitForFences(device_.vk(), 1, &fences_[slot], VK_TRUE, ~std::uint64_t{0}));
        GN_VK(vkResetFences(device_.vk(), 1, &fences_[slot]));
        frames_.begin(slot);
        const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        GN_VK(vkBeginCommandBuffer(commands_[slot], &begin));
        record(commands_[slot]);
        GN_VK(vkEndCommandBuffer(commands_[slot]));
        const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                               .commandBuffer = commands_[slot]};
        const VkSubmitInfo2 submit{
            .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &buffer};
        GN_VK(vkQueueSubmit2(device_.queue(), 1, &submit, fences_[slot]));
    }
    void wait() { GN_VK(vkQueueWaitIdle(device_.queue())); }

  private:
    Device& device_;
    Frames& frames_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::vector<VkCommandBuffer> commands_;
    std::vector<VkFence> fences_;
    std::uint64_t count_ = 0;
};

const ComputeDesc& add_constant() {
    static const ComputeDesc once = sealed(ComputeDesc{compute_shader("add constant", R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D source;
layout(binding = 1, r32f) uniform writeonly image2D target;
layout(binding = 2, scalar) uniform Constants { float value; } u;
void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, imageSize(target)))) {
        imageStore(target, texel, texelFetch(source, texel, 0) + u.value);
    }
}
)"),
                                                       {}});
    return once;
}

/// target = source + constant
void declare_step(FrameGraph& graph, const char* name, TextureHandle source, TextureHandle target, float constant) {
    graph.add_pass(
        name,
        [&](PassBuilder& pass) {
            pass.sample(source);
            pass.storage_write(target);
        },
        [=, desc = graph.desc(target)](Recorder& r) {
            r.bind(add_constant());
            r.set("source", source);
            r.set_storage("target", target);
            r.set_value("u", constant);
            r.dispatch_pixels(desc.width, desc.height);
        });
}

/// out = in + value, through a transient image between.
void declare_chain(FrameGraph& graph, Texture2D& from, Texture2D& to, float value) {
    const TextureHandle in = graph.import(from), out = graph.import(to);
    const TextureDesc desc = from.desc();
    const TextureHandle middle =
        graph.create({.name = "middle", .format = desc.format, .width = desc.width, .height = desc.height});
    declare_step(graph, "first", in, middle, value);
    declare_step(graph, "second", middle, out, value);
}

Texture2D picture(Device& device, std::uint32_t side, float value) {
    const std::vector<float> texels(std::size_t{side} * side, value);
    return upload_texture(device,
                          {.name = "picture",
                           .format = VK_FORMAT_R32_SFLOAT,
                           .width = side,
                           .height = side,
                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT},
                          std::as_bytes(std::span(texels)));
}

class InFlight : public Rendered {
  protected:
    float first_texel(Texture2D& texture) { return values_of<float>(download(device, texture)).front(); }
};

// Each frame adds what it was given to what the frame before left, in two textures that swap.
TEST_F(InFlight, FramesFollowEachOtherAndSteadyOnesCreateNothing) {
    std::array<Texture2D, 2> kept{picture(device, 16, 1.0F), picture(device, 16, 0.0F)};
    Frames frames(device, 2);
    Host host(device, frames);
    float expected = 1.0F;
    Counters steady;
    for (int i = 0; i < 20; ++i) {
        if (i == 3) {
            steady = device.counters();
        }
        host.frame([&](VkCommandBuffer commands) {
            FrameGraph graph(device);
            declare_chain(graph, kept[static_cast<std::size_t>(i % 2)], kept[static_cast<std::size_t>((i + 1) % 2)],
                          static_cast<float>(i));
            graph.record(frames, commands);
        });
        expected += 2.0F * static_cast<float>(i);
    }
    host.wait();
    EXPECT_EQ(device.counters(), steady);
    EXPECT_EQ(frames.plans(), 1U);
    EXPECT_EQ(first_texel(kept[0]), expected);
}

// What a frame makes, the frames after it find; those that make nothing have the plan of those that do.
TEST_F(InFlight, PassesThatRestCostNoPlanAndAreNotRun) {
    Texture2D nothing = picture(device, 16, 0.0F), kept = picture(device, 16, -1.0F), sum = picture(device, 16, 0.0F);
    Frames frames(device, 2);
    Host host(device, frames);
    Counters steady;
    for (int i = 0; i < 8; ++i) {
        steady = i == 2 ? device.counters() : steady;
        host.frame([&](VkCommandBuffer commands) {
            FrameGraph graph(device);
            const TextureHandle there = graph.import(kept);
            graph.rest(i % 5 != 0);
            const TextureHandle middle =
                graph.create({.name = "middle", .format = VK_FORMAT_R32_SFLOAT, .width = 16, .height = 16});
            declare_step(graph, "make", graph.import(nothing), middle, static_cast<float>(i));
            declare_step(graph, "keep", middle, there, 100.0F);
            graph.answer(graph.create(BufferDesc{.name = "count", .bytes = 16}),
                         [](auto) { FAIL() << "never written"; });
            graph.rest(false);
            declare_step(graph, "use", there, graph.import(sum), static_cast<float>(i));
            graph.record(frames, commands);
        });
    }
    host.wait();
    EXPECT_EQ(device.counters(), steady) << "a slot whose first frame rests has room for those that do not";
    EXPECT_EQ(frames.plans(), 1U);
    EXPECT_EQ(first_texel(kept), 105.0F);
    EXPECT_EQ(first_texel(sum), 112.0F);

    // Each slot's account is of its own frame.
    frames.begin(0);
    EXPECT_EQ(frames.completed(0).passes.size(), 1U);
    frames.begin(1);
    EXPECT_EQ(frames.completed(1).passes.size(), 1U);
}

TEST_F(InFlight, APictureOfAnotherSizeHasAPlanOfItsOwnAndTheOldOneRetires) {
    Frames frames(device, 2);
    Host host(device, frames);
    std::array<Texture2D, 2> small{picture(device, 8, 1.0F), picture(device, 8, 0.0F)};
    std::array<Texture2D, 2> large{picture(device, 24, 2.0F), picture(device, 24, 0.0F)};
    const auto draw = [&](std::array<Texture2D, 2>& pictures) {
        host.frame([&](VkCommandBuffer commands) {
            FrameGraph graph(device);
            declare_chain(graph, pictures[0], pictures[1], 1.0F);
            graph.record(frames, commands);
        });
    };
    draw(small);
    draw(large);
    EXPECT_EQ(frames.plans(), 2U);
    for (int i = 0; i < 70; ++i) {
        draw(large);
    }
    EXPECT_EQ(frames.plans(), 1U);
    host.wait();
    EXPECT_EQ(first_texel(small[1]), 3.0F);
    EXPECT_EQ(first_texel(large[1]), 4.0F);
}

TEST_F(InFlight, WhatRetiresLivesUntilItsSlotIsTakenUpAgain) {
    Frames frames(device, 2);
    auto object = std::make_shared<int>(7);
    const std::weak_ptr<int> watch = object;
    frames.begin(0);
    frames.retire(std::move(object));
    frames.begin(1);
    EXPECT_FALSE(watch.expired());
    frames.begin(0);
    EXPECT_TRUE(watch.expired());
}

TEST_F(InFlight, TheAccountOfASlotIsOfItsLastCompletedUse) {
    std::array<Texture2D, 2> pictures{picture(device, 8, 1.0F), picture(device, 8, 0.0F)};
    Frames frames(device, 1);
    Host host(device, frames);
    const auto draw = [&](VkCommandBuffer commands) {
        FrameGraph graph(device);
        declare_chain(graph, pictures[0], pictures[1], 1.0F);
        graph.record(frames, commands);
    };
    host.frame(draw);
    EXPECT_TRUE(frames.completed(0).passes.empty());
    host.frame(draw);
    ASSERT_EQ(frames.completed(0).passes.size(), 2U);
    EXPECT_EQ(frames.completed(0).passes[1].name, "second");
}

// The device counts; the host hears of each frame's count when that frame's slot is taken up again, and waits for nothing.
TEST_F(InFlight, AnswersComeWithTheirSlot) {
    Frames frames(device, 2);
    Host host(device, frames);
    std::vector<std::uint32_t> heard;
    for (std::uint32_t i = 0; i < 6; ++i) {
        host.frame([&](VkCommandBuffer commands) {
            FrameGraph graph(device);
            const BufferHandle count = graph.create(BufferDesc{.name = "count", .bytes = 16});
            graph.answer(count, [&](std::span<const std::byte> bytes) {
                std::uint32_t word = 0;
                std::memcpy(&word, bytes.data(), 4);
                heard.push_back(word);
            });
            graph.add_pass(
                "count", [&](PassBuilder& pass) { pass.copy_to(count); }, [=](Recorder& r) { r.fill(count, 10 + i); });
            graph.record(frames, commands);
        });
        EXPECT_EQ(heard.size(), i < 2 ? 0U : i - 1U);
    }
    host.wait();
    EXPECT_EQ(heard, (std::vector<std::uint32_t>{10, 11, 12, 13}));

    // Executed at once, the answer is there at once.
    FrameGraph graph(device);
    const BufferHandle count = graph.create(BufferDesc{.name = "count", .bytes = 16});
    bool answered = false;
    graph.answer(count, [&](std::span<const std::byte>) { answered = true; });
    graph.add_pass(
        "count", [&](PassBuilder& pass) { pass.copy_to(count); }, [=](Recorder& r) { r.fill(count, 1); });
    graph.execute(false);
    EXPECT_TRUE(answered);
}

TEST_F(InFlight, SlotsThatAreNotThereAreNamed) {
    EXPECT_EQ(error_of([&] { Frames(device, 0); }), "0 frames in flight; valid is 1 to 8");
    Frames frames(device, 2);
    EXPECT_EQ(error_of([&] { frames.begin(2); }), "frame slot 2 of 2; valid is 0 to 1");
}

GraphDeclaration declaration_of(std::uint32_t side, Load load, VkImageLayout initial, const std::string& name) {
    GraphDeclaration declaration;
    declaration.textures.push_back(
        {.desc = {.name = name, .format = VK_FORMAT_R32_SFLOAT, .width = side, .height = side},
         .imported = true,
         .initial = {initial}});
    declaration.passes.push_back({.name = name, .uses = {{.kind = UseKind::color, .load = load}}});
    return declaration;
}

TEST(Fingerprint, SaysWhatAPlanDependsOnAndNothingElse) {
    const Fingerprint one = fingerprint(declaration_of(8, Load::clear, VK_IMAGE_LAYOUT_UNDEFINED, "a"));
    EXPECT_EQ(one, fingerprint(declaration_of(8, Load::clear, VK_IMAGE_LAYOUT_GENERAL, "b")));
    EXPECT_NE(one, fingerprint(declaration_of(9, Load::clear, VK_IMAGE_LAYOUT_UNDEFINED, "a")));
    EXPECT_NE(one, fingerprint(declaration_of(8, Load::keep, VK_IMAGE_LAYOUT_UNDEFINED, "a")));

    // Memory is planned for a transient buffer, and none for an imported one.
    const auto with_buffer = [](bool imported, VkDeviceSize bytes) {
        GraphDeclaration declaration = declaration_of(8, Load::clear, VK_IMAGE_LAYOUT_UNDEFINED, "a");
        declaration.buffers.push_back({.desc = {.name = "b", .bytes = bytes}, .imported = imported});
        return fingerprint(declaration);
    };
    EXPECT_EQ(with_buffer(true, 64), with_buffer(true, 128));
    EXPECT_NE(with_buffer(false, 64), with_buffer(false, 128));
    EXPECT_NE(with_buffer(false, 64), with_buffer(true, 64));
}

}  // namespace
}  // namespace gn::frames_test
