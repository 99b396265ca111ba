// SPDX-License-Identifier: MIT
// Exact barriers of small graphs, on the null device.
#include "gpu/graph_plan.h"
#include "gpu/null_device.h"
#include "gpu/test_device.h"

namespace gn::graph_plan_test {
namespace {

constexpr VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 raster_shaders =
    VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr VkPipelineStageFlags2 color_output = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr VkPipelineStageFlags2 transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
constexpr VkPipelineStageFlags2 tests =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;

class Plan : public ::testing::Test {
  protected:
    TextureHandle texture(const char* name, VkFormat format = VK_FORMAT_R32_SFLOAT, std::uint32_t mips = 1,
                          std::uint32_t layers = 1) {
        return graph.create(
            TextureDesc{.name = name, .format = format, .width = 64, .height = 64, .layers = layers, .mips = mips});
    }
    BufferHandle buffer(const char* name, VkDeviceSize bytes = 1024) {
        return graph.create(BufferDesc{.name = name, .bytes = bytes});
    }
    void pass(const char* name, const std::function<void(PassBuilder&)>& setup) {
        graph.add_pass(name, setup, [](Recorder&) {});
    }

    std::unique_ptr<Device> device = make_null_device();
    FrameGraph graph{*device};
};

TEST_F(Plan, ReadAfterWriteWaitsForTheWrite) {
    const auto b = buffer("b"), out = buffer("out");
    graph.keep(out);
    pass("write", [&](PassBuilder& p) { p.storage_write(b); });
    pass("read", [&](PassBuilder& p) {
        p.storage_read(b);
        p.storage_write(out);
    });
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes.size(), 2U);
    EXPECT_TRUE(plan.passes[0].buffers.empty());
    ASSERT_EQ(plan.passes[1].buffers.size(), 1U);
    const BufferBarrier& barrier = plan.passes[1].buffers[0];
    EXPECT_EQ(barrier.buffer, b.index);
    EXPECT_EQ(barrier.src_stages, compute);
    EXPECT_EQ(barrier.src_access, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    EXPECT_EQ(barrier.dst_stages, compute);
    EXPECT_EQ(barrier.dst_access, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT);
}

TEST_F(Plan, ReadAfterReadWaitsForNothing) {
    const auto b = buffer("b");
    pass("write", [&](PassBuilder& p) { p.storage_write(b); });
    for (const char* name : {"first", "second"}) {
        pass(name, [&](PassBuilder& p) {
            p.storage_read(b);
            p.keep();
        });
    }
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes.size(), 3U);
    EXPECT_EQ(plan.passes[1].buffers.size(), 1U);
    EXPECT_TRUE(plan.passes[2].buffers.empty());
}

TEST_F(Plan, ReadByAnotherStageWaitsForTheSameWrite) {
    const auto b = buffer("b");
    pass("write", [&](PassBuilder& p) { p.storage_write(b); });
    pass("compute", [&](PassBuilder& p) {
        p.storage_read(b);
        p.keep();
    });
    pass("indirect", [&](PassBuilder& p) {
        p.indirect(b);
        p.keep();
    });
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes[2].buffers.size(), 1U);
    EXPECT_EQ(plan.passes[2].buffers[0].src_stages, compute);
    EXPECT_EQ(plan.passes[2].buffers[0].src_access, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    EXPECT_EQ(plan.passes[2].buffers[0].dst_stages, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
}

TEST_F(Plan, WriteAfterReadWaitsForReadersAndFlushesNothing) {
    const auto b = buffer("b");
    graph.keep(b);
    pass("write", [&](PassBuilder& p) { p.copy_to(b); });
    pass("read", [&](PassBuilder& p) {
        p.storage_read(b);
        p.keep();
    });
    pass("overwrite", [&](PassBuilder& p) { p.copy_to(b); });
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes[2].buffers.size(), 1U);
    EXPECT_EQ(plan.passes[2].buffers[0].src_stages, compute);
    EXPECT_EQ(plan.passes[2].buffers[0].src_access, 0U);
    EXPECT_EQ(plan.passes[2].buffers[0].dst_stages, transfer);
}

TEST_F(Plan, WriteAfterWriteFlushesTheFirst) {
    const auto b = buffer("b");
    graph.keep(b);
    pass("first", [&](PassBuilder& p) { p.copy_to(b); });
    pass("second", [&](PassBuilder& p) { p.storage_write(b); });
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes[1].buffers.size(), 1U);
    EXPECT_EQ(plan.passes[1].buffers[0].src_stages, transfer);
    EXPECT_EQ(plan.passes[1].buffers[0].src_access, VK_ACCESS_2_TRANSFER_WRITE_BIT);
}

TEST_F(Plan, LayoutsFollowTheUse) {
    const auto t = texture("t"), out = texture("out");
    graph.keep(out);
    pass("draw", [&](PassBuilder& p) { p.color(t, Load::clear); });
    pass("filter", [&](PassBuilder& p) {
        p.sample(t);
        p.color(out, Load::discard);
    });
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes[0].images.size(), 1U);
    EXPECT_EQ(plan.passes[0].images[0].old_layout, VK_IMAGE_LAYOUT_UNDEFINED);
    EXPECT_EQ(plan.passes[0].images[0].new_layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    const ImageBarrier& barrier = plan.passes[1].images[0];
    EXPECT_EQ(barrier.texture, t.index);
    EXPECT_EQ(barrier.src_stages, color_output);
    EXPECT_EQ(barrier.src_access, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
    EXPECT_EQ(barrier.dst_stages, raster_shaders);
    EXPECT_EQ(barrier.dst_access, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
    EXPECT_EQ(barrier.old_layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    EXPECT_EQ(barrier.new_layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    EXPECT_EQ(plan.final_layouts[out.index], std::vector{VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
}

TEST_F(Plan, DepthWrittenThenComparedInCompute) {
    // The hazard that synchronization validation does not see.
    const auto map = texture("map", VK_FORMAT_D32_SFLOAT);
    const auto out = buffer("out");
    graph.keep(out);
    pass("map", [&](PassBuilder& p) { p.depth(map, Load::clear); });
    pass("lookup", [&](PassBuilder& p) {
        p.sample(map);
        p.storage_write(out);
    });
    const ImageBarrier& barrier = graph.plan().passes[1].images.at(0);
    EXPECT_EQ(barrier.src_stages, tests);
    EXPECT_EQ(barrier.src_access, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT);
    EXPECT_EQ(barrier.dst_stages, compute);
    EXPECT_EQ(barrier.new_layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

TEST_F(Plan, DepthIsTestedAndSampledAtOnce) {
    const auto depth = texture("depth", VK_FORMAT_D32_SFLOAT), out = texture("out");
    graph.keep(out);
    pass("prepass", [&](PassBuilder& p) { p.depth(depth, Load::clear); });
    pass("shade", [&](PassBuilder& p) {
        p.depth_read_only(depth);
        p.sample(depth);
        p.color(out, Load::clear);
    });
    const ImageBarrier& barrier = graph.plan().passes[1].images.at(0);
    EXPECT_EQ(barrier.texture, depth.index);
    EXPECT_EQ(barrier.new_layout, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    EXPECT_EQ(barrier.dst_stages, tests | raster_shaders);
    EXPECT_EQ(barrier.dst_access, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
}

TEST_F(Plan, StencilBesideReadOnlyDepthOrdersItsWriters) {
    const auto depth = texture("depth", VK_FORMAT_D32_SFLOAT_S8_UINT);
    graph.keep(depth);
    pass("prepass", [&](PassBuilder& p) { p.depth(depth, Load::clear); });
    for (const char* name : {"volumes", "more volumes"}) {
        pass(name, [&](PassBuilder& p) { p.depth_read_only(depth); });
    }
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes.size(), 3U);
    const ImageBarrier& first = plan.passes[1].images.at(0);
    EXPECT_EQ(first.new_layout, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL);
    const ImageBarrier& second = plan.passes[2].images.at(0);
    EXPECT_EQ(second.old_layout, second.new_layout);
    EXPECT_EQ(second.src_access, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT);
}

TEST_F(Plan, MipChainMovesOneMipAtATime) {
    constexpr std::uint32_t mips = 4;
    const auto t = texture("pyramid", VK_FORMAT_R32_SFLOAT, mips);
    graph.keep(t);
    pass("top", [&](PassBuilder& p) { p.color(t, Load::clear); });
    for (std::uint32_t mip = 1; mip < mips; ++mip) {
        pass("down", [&](PassBuilder& p) {
            p.sample(t, one_mip(mip - 1));
            p.color(t, Load::discard, {}, one_layer(0, mip));
        });
    }
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes.size(), 4U);
    for (std::uint32_t mip = 1; mip < mips; ++mip) {
        const auto& barriers = plan.passes[mip].images;
        ASSERT_EQ(barriers.size(), 2U) << "mip " << mip;
        EXPECT_EQ(barriers[0].range.mip, mip - 1);
        EXPECT_EQ(barriers[0].range.mips, 1U);
        EXPECT_EQ(barriers[0].src_stages, color_output);
        EXPECT_EQ(barriers[0].new_layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        EXPECT_EQ(barriers[1].range.mip, mip);
        EXPECT_EQ(barriers[1].old_layout, VK_IMAGE_LAYOUT_UNDEFINED);
    }
}

TEST_F(Plan, LikeSubresourcesShareOneBarrier) {
    const auto t = texture("array", VK_FORMAT_R32_SFLOAT, 3, 6);
    graph.keep(t);
    pass("write", [&](PassBuilder& p) { p.storage_write(t); });
    pass("read", [&](PassBuilder& p) {
        p.sample(t);
        p.keep();
    });
    for (const PlannedPass& planned : graph.plan().passes) {
        ASSERT_EQ(planned.images.size(), 1U);
        EXPECT_EQ(planned.images[0].range.mips, 3U);
        EXPECT_EQ(planned.images[0].range.layers, 6U);
    }
}

TEST_F(Plan, PassesThatNobodyNeedsAreCulled) {
    const auto a = texture("a"), b = texture("b"), out = texture("out");
    graph.keep(out);
    pass("needed", [&](PassBuilder& p) { p.color(a, Load::clear); });
    pass("feeds only the next", [&](PassBuilder& p) { p.color(b, Load::clear); });
    pass("unread", [&](PassBuilder& p) {
        p.sample(b);
        p.color(texture("nowhere"), Load::clear);
    });
    pass("out", [&](PassBuilder& p) {
        p.sample(a);
        p.color(out, Load::clear);
    });
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes.size(), 2U);
    EXPECT_EQ(plan.passes[0].declared, 0U);
    EXPECT_EQ(plan.passes[1].declared, 3U);
    EXPECT_FALSE(plan.textures[b.index].used);
}

TEST_F(Plan, AKeptPassLivesWithItsProducers) {
    const auto a = buffer("a");
    pass("producer", [&](PassBuilder& p) { p.storage_write(a); });
    pass("observer", [&](PassBuilder& p) {
        p.storage_read(a);
        p.keep();
    });
    EXPECT_EQ(graph.plan().passes.size(), 2U);
}

TEST_F(Plan, WhatIsClearedLaterNeedsNoEarlierWriter) {
    const auto t = texture("t", VK_FORMAT_R32_SFLOAT, 1, 2);
    graph.keep(t);
    pass("wasted", [&](PassBuilder& p) { p.color(t, Load::clear, {}, one_layer(0)); });
    pass("other layer", [&](PassBuilder& p) { p.color(t, Load::clear, {}, one_layer(1)); });
    pass("clears", [&](PassBuilder& p) { p.color(t, Load::clear, {}, one_layer(0)); });
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes.size(), 2U);
    EXPECT_EQ(plan.passes[0].declared, 1U);
    EXPECT_EQ(plan.passes[1].declared, 2U);
}

TEST_F(Plan, RoundsShareOneSetOfResources) {
    const auto sums = buffer("sums");
    graph.keep(sums);
    graph.begin_rounds();
    std::vector<std::uint32_t> first;
    for (int round = 0; round < 3; ++round) {
        graph.next_round();
        const auto map = texture("map"), blurred = texture("map"), wide = texture("wide", VK_FORMAT_R32_SFLOAT, 2);
        const auto list = buffer("list");
        EXPECT_NE(map.index, blurred.index) << "a round has each resource once";
        pass("draw", [&](PassBuilder& p) {
            p.storage_write(map);
            p.storage_write(list);
        });
        pass("blur", [&](PassBuilder& p) {
            p.sample(map);
            p.storage_write(blurred);
            p.storage_write(wide);
        });
        pass("add", [&](PassBuilder& p) {
            p.sample(blurred);
            p.sample(wide);
            p.storage_read(list);
            p.storage_write(sums);
        });
        const std::vector<std::uint32_t> made{map.index, blurred.index, wide.index, list.index};
        first = round == 0 ? made : first;
        EXPECT_EQ(made, first) << round;
    }
    graph.end_rounds();
    EXPECT_NE(texture("map").index, first[0]) << "after the rounds a resource is a new one";

    // One set of passes too. What a round draws waits for what the round before still read.
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes.size(), 3U);
    ASSERT_EQ(plan.loops.size(), 1U);
    ASSERT_EQ(plan.loops[0].again.size(), 3U);
    const auto waits = [&](const PlannedPass& pass) {
        return std::count_if(pass.images.begin(), pass.images.end(),
                             [&](const ImageBarrier& w) { return w.texture == first[0] && w.src_stages != 0; });
    };
    EXPECT_EQ(waits(plan.passes[0]), 0);
    EXPECT_EQ(waits(plan.loops[0].again[0]), 1);
    EXPECT_EQ(graph.statistics().passes.size(), 9U) << "each round is a run of its own";
}

TEST_F(Plan, ARoundKeepsWhatTheNextOneReads) {
    const auto sums = buffer("sums"), carried = buffer("carried"), unread = buffer("unread");
    graph.keep(sums);
    pass("first", [&](PassBuilder& p) { p.copy_to(carried); });
    graph.begin_rounds();
    for (int round = 0; round < 3; ++round) {
        graph.next_round();
        pass("add", [&](PassBuilder& p) {
            p.storage_read(carried);
            p.storage_write(sums);
        });
        pass("carry", [&](PassBuilder& p) { p.storage_write(carried); });
        pass("in vain", [&](PassBuilder& p) { p.storage_write(unread); });
    }
    graph.end_rounds();
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes.size(), 3U) << "one that fills, two of the loop";
    EXPECT_EQ(plan.loops.at(0).again.size(), 2U);
    EXPECT_EQ(graph.statistics().passes.size(), 7U);
}

TEST_F(Plan, RoundsOfAnotherShapeAreDeclaredAnew) {
    const auto sums = buffer("sums");
    graph.keep(sums);
    graph.begin_rounds();
    for (int round = 0; round < 5; ++round) {
        graph.next_round();
        pass("add", [&](PassBuilder& p) { p.storage_write(sums); });
        if (round == 2) {
            pass("more", [&](PassBuilder& p) { p.storage_write(sums); });
        }
    }
    graph.end_rounds();
    const GraphPlan& plan = graph.plan();
    ASSERT_EQ(plan.passes.size(), 4U) << "twice, once with more, twice";
    EXPECT_EQ(plan.loops.size(), 2U);
    std::vector<std::string> names;
    for (const PassTime& pass : graph.statistics().passes) {
        names.push_back(pass.name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"add", "add", "add", "more", "add", "add"}));
}

TEST_F(Plan, AliasedMemoryWaitsForItsFormerUser) {
    const auto a = texture("a"), b = texture("b");
    const auto out = buffer("out");
    graph.keep(out);
    pass("draw a", [&](PassBuilder& p) { p.color(a, Load::clear); });
    pass("sum a", [&](PassBuilder& p) {
        p.sample(a);
        p.storage_write(out);
    });
    pass("draw b", [&](PassBuilder& p) { p.color(b, Load::clear); });
    pass("sum b", [&](PassBuilder& p) {
        p.sample(b);
        p.storage_write(out);
    });
    const GraphPlan& plan = graph.plan();
    EXPECT_EQ(plan.textures[a.index].offset, plan.textures[b.index].offset);
    EXPECT_EQ(plan.transient_bytes(), 64U * 64 * 4 + 1024);
    const ImageBarrier& barrier = plan.passes[2].images.at(0);
    EXPECT_EQ(barrier.texture, b.index);
    EXPECT_EQ(barrier.old_layout, VK_IMAGE_LAYOUT_UNDEFINED);
    EXPECT_NE(barrier.src_stages & compute, 0U) << "the sampling of a must be over";
}

TEST_F(Plan, KeptResourcesAreNotOverwritten) {
    const auto a = texture("a"), b = texture("b");
    graph.keep(a);
    graph.keep(b);
    pass("a", [&](PassBuilder& p) { p.color(a, Load::clear); });
    pass("b", [&](PassBuilder& p) { p.color(b, Load::clear); });
    const GraphPlan& plan = graph.plan();
    EXPECT_NE(plan.textures[a.index].offset, plan.textures[b.index].offset);
}

TEST_F(Plan, ReadingWhatNobodyWroteIsAnError) {
    const auto t = texture("ghost"), out = texture("out");
    graph.keep(out);
    pass("reader", [&](PassBuilder& p) {
        p.sample(t);
        p.color(out, Load::clear);
    });
    const std::string error = error_of([&] { static_cast<void>(graph.plan()); });
    EXPECT_NE(error.find("'reader'"), std::string::npos) << error;
    EXPECT_NE(error.find("'ghost'"), std::string::npos) << error;
}

TEST_F(Plan, SamplingATargetIsAnError) {
    const auto t = texture("t");
    graph.keep(t);
    pass("first", [&](PassBuilder& p) { p.color(t, Load::clear); });
    pass("feedback", [&](PassBuilder& p) {
        p.color(t, Load::keep);
        p.sample(t);
    });
    const std::string error = error_of([&] { static_cast<void>(graph.plan()); });
    EXPECT_NE(error.find("'feedback'"), std::string::npos) << error;
}

TEST_F(Plan, AttachmentsOfDifferentSizesAreAnError) {
    const auto a = texture("a");
    const auto b = graph.create(TextureDesc{.name = "b", .format = VK_FORMAT_R32_SFLOAT, .width = 32, .height = 64});
    const std::string error = error_of([&] {
        pass("mixed", [&](PassBuilder& p) {
            p.color(a, Load::clear);
            p.color(b, Load::clear);
        });
    });
    EXPECT_NE(error.find("'mixed'"), std::string::npos) << error;
}

TEST_F(Plan, ManyKeptTexturesShareHeapsThatADeviceCanAllocate) {
    // V of two hundred lights at 4096 x 2160: 34 MiB each, 6.6 GiB in all, which no device gives at once.
    std::vector<TextureHandle> kept;
    for (int i = 0; i < 200; ++i) {
        kept.push_back(
            graph.create(TextureDesc{.name = "V", .format = VK_FORMAT_R32_SFLOAT, .width = 4096, .height = 2160}));
        graph.keep(kept.back());
        pass("light", [&](PassBuilder& p) { p.storage_write(kept.back()); });
    }
    const GraphPlan& plan = graph.plan();
    EXPECT_GT(plan.heaps.size(), 1U);
    for (const Heap& heap : plan.heaps) {
        EXPECT_LE(heap.bytes, VkDeviceSize{1} << 30U);
    }
    EXPECT_EQ(plan.transient_bytes(), 200ULL * 4096 * 2160 * 4);
    // None shares its bytes with another that is alive with it.
    for (std::size_t i = 1; i < kept.size(); ++i) {
        const Placement &a = plan.textures[kept[i - 1].index], &b = plan.textures[kept[i].index];
        EXPECT_TRUE(a.heap != b.heap || a.offset + a.bytes <= b.offset || b.offset + b.bytes <= a.offset) << i;
    }
}

TEST_F(Plan, ExecutingOnNothingStillAccounts) {
    graph.group("shadow");
    const auto t = texture("map", VK_FORMAT_D32_SFLOAT_S8_UINT);
    graph.keep(t);
    pass("map", [&](PassBuilder& p) { p.depth(t, Load::clear); });
    graph.execute();
    const GraphStatistics& statistics = graph.statistics();
    ASSERT_EQ(statistics.passes.size(), 1U);
    EXPECT_EQ(statistics.passes[0].group, "shadow");
    ASSERT_EQ(statistics.resources.size(), 1U);
    EXPECT_EQ(statistics.resources[0].bytes, 64U * 64 * 5);
    EXPECT_NE(graph.describe().find("shadow/map"), std::string::npos);
}

}  // namespace
}  // namespace gn::graph_plan_test
