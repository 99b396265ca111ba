// SPDX-License-Identifier: MIT
// Random graphs against an independent model of what Vulkan's barriers guarantee: every conflicting pair of accesses,
// to the same texels or to the same bytes of memory, must be ordered, and every read must see its write.
#include "gpu/graph_plan.h"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace gn::graph_random_test {
namespace {

constexpr VkAccessFlags2 write_bits = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                      VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;

GraphDeclaration random_graph(std::mt19937& random) {
    const auto pick = [&](std::uint32_t count) {
        return std::uniform_int_distribution<std::uint32_t>(0, count - 1)(random);
    };
    GraphDeclaration graph;
    for (std::uint32_t i = 0; i < 5; ++i) {
        graph.textures.push_back({.desc = {.name = "t" + std::to_string(i),
                                           .format = VK_FORMAT_R32_SFLOAT,
                                           .width = 16U << pick(3),
                                           .height = 16,
                                           .layers = 1 + pick(3),
                                           .mips = 1 + pick(3)},
                                  .imported = i == 0,
                                  .kept = i == 1});
    }
    for (std::uint32_t i = 0; i < 3; ++i) {
        graph.buffers.push_back({.desc = {.name = "b" + std::to_string(i), .bytes = 256U << pick(5)}});
    }

    // Use things at random, but read nothing before somebody wrote it.
    const std::uint32_t passes = 4 + pick(12);
    std::vector<bool> written_textures(5), written_buffers(3);
    for (std::uint32_t p = 0; p < passes; ++p) {
        DeclaredPass pass{.name = "p" + std::to_string(p), .keep = true};
        for (std::uint32_t u = 0; u < 1 + pick(3); ++u) {
            const std::uint32_t index = pick(8);
            const bool is_texture = index < 5;
            const std::uint32_t resource = is_texture ? index : index - 5;
            static constexpr UseKind reads[] = {UseKind::sample, UseKind::storage_read, UseKind::copy_from};
            static constexpr UseKind writes_[] = {UseKind::storage_write, UseKind::copy_to};
            static constexpr UseKind buffer_reads[] = {UseKind::storage_read, UseKind::indirect, UseKind::indices,
                                                       UseKind::copy_from};
            auto&& written = is_texture ? written_textures : written_buffers;
            const bool read = written[resource] && pick(2) == 0;
            Use use{.texture = is_texture, .resource = resource};
            use.kind = !read ? writes_[pick(2)] : is_texture ? reads[pick(3)] : buffer_reads[pick(4)];
            if (is_texture) {
                const TextureDesc& desc = graph.textures[resource].desc;
                const std::uint32_t mip = pick(desc.mips), layer = pick(desc.layers);
                use.range = {mip, 1 + pick(desc.mips - mip), layer, 1 + pick(desc.layers - layer)};
            }
            written[resource] = written[resource] || !read;
            pass.uses.push_back(use);
        }
        graph.passes.push_back(std::move(pass));
    }
    // Let some of it run round after round.
    if (pick(2) == 0) {
        const std::uint32_t first = pick(passes);
        graph.loops.push_back({first, 1 + pick(passes - first), 2 + pick(3)});
    }
    return graph;
}

/// One past access, and for whom it is over.
struct Past {
    std::string what;
    VkDeviceSize begin = 0, end = 0;  ///< bytes of memory, transients only
    std::uint64_t key = 0;            ///< the subresource or buffer
    bool transient = false;
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 writes = 0;
    VkPipelineStageFlags2 over_for = 0;  ///< later commands in these stages come after it
    bool available = false;              ///< its writes were flushed
    std::vector<std::pair<VkPipelineStageFlags2, VkAccessFlags2>> visible;
};

class Model {
  public:
    Model(const GraphDeclaration& graph, const GraphPlan& plan) : graph_(graph), plan_(plan) {}

    void run() {
        for (const Turn& turn : turns_of(graph_, plan_)) {
            const PlannedPass& planned = *turn.pass;
            for (const ImageBarrier& b : planned.images) {
                each(b.range, [&](std::uint32_t mip, std::uint32_t layer) {
                    barrier(texture_key(b.texture, mip, layer), plan_.textures[b.texture], b.src_stages, b.src_access,
                            b.dst_stages, b.dst_access, b.old_layout != b.new_layout);
                });
            }
            for (const BufferBarrier& b : planned.buffers) {
                barrier(buffer_key(b.buffer), plan_.buffers[b.buffer], b.src_stages, b.src_access, b.dst_stages,
                        b.dst_access, false);
            }
            visit(graph_.passes[planned.declared]);
        }
    }

  private:
    static std::uint64_t texture_key(std::uint32_t t, std::uint32_t mip, std::uint32_t layer) {
        return 1 + mip + 16U * layer + 1024U * std::uint64_t{t};
    }
    static std::uint64_t buffer_key(std::uint32_t b) { return (std::uint64_t{1} << 40U) + b; }
    template <class Visit>
    static void each(const Range& range, Visit visit) {
        for (std::uint32_t mip = range.mip; mip < range.mip + range.mips; ++mip) {
            for (std::uint32_t layer = range.layer; layer < range.layer + range.layers; ++layer) {
                visit(mip, layer);
            }
        }
    }

    static bool same_memory(const Past& past, const Placement& placement) {
        return past.transient && placement.transient && past.begin < placement.offset + placement.bytes &&
               placement.offset < past.end;
    }

    void barrier(std::uint64_t key, const Placement& placement, VkPipelineStageFlags2 src, VkAccessFlags2 src_access,
                 VkPipelineStageFlags2 dst, VkAccessFlags2 dst_access, bool transition) {
        for (Past& past : past_) {
            const bool concerned = past.key == key || (same_memory(past, placement) && !same_resource(past.key, key));
            const bool ordered = (past.stages & ~src) == 0 || (past.over_for & src) != 0;
            if (concerned && ordered) {
                past.available = past.available || (past.writes & ~src_access) == 0;
                past.over_for |= dst;
                if (past.available) {
                    past.visible.emplace_back(dst, dst_access);
                }
            }
            // A change of layout writes: whoever came before must be over for it.
            if (transition && concerned) {
                EXPECT_TRUE(ordered) << "layout changes under " << past.what;
            }
        }
    }

    static bool same_resource(std::uint64_t a, std::uint64_t b) {
        const bool buffers = (a >> 40U) != 0 || (b >> 40U) != 0;
        return buffers ? a == b : (a - 1) / 1024 == (b - 1) / 1024;
    }

    void visit(const DeclaredPass& pass) {
        std::vector<Past> now;
        const auto access = [&](std::uint64_t key, const Placement& placement, const Access& a,
                                const std::string& name) {
            const VkAccessFlags2 mine = a.access & write_bits;
            for (const Past& past : past_) {
                const bool same = past.key == key;
                const bool aliased = !same && same_memory(past, placement) && !same_resource(past.key, key);
                if (!same && !aliased) {
                    continue;
                }
                const bool conflict = past.writes != 0 || mine != 0;
                if (conflict) {
                    EXPECT_EQ(a.stages & ~past.over_for, 0U) << pass.name << " on " << name << " after " << past.what;
                }
                if (past.writes != 0 && mine != 0) {
                    EXPECT_TRUE(past.available) << pass.name << " on " << name << " overwrites unflushed " << past.what;
                }
                if (same && past.writes != 0 && (a.access & ~write_bits) != 0) {
                    const bool seen = std::any_of(past.visible.begin(), past.visible.end(), [&](const auto& v) {
                        return (a.stages & ~v.first) == 0 && (a.access & ~v.second) == 0;
                    });
                    EXPECT_TRUE(seen) << pass.name << " does not see " << past.what << " on " << name;
                }
            }
            now.push_back({pass.name + " on " + name, placement.offset, placement.offset + placement.bytes, key,
                           placement.transient, a.stages, mine});
        };
        for (std::uint32_t t = 0; t < graph_.textures.size(); ++t) {
            const TextureDesc& desc = graph_.textures[t].desc;
            each({0, desc.mips, 0, desc.layers}, [&](std::uint32_t mip, std::uint32_t layer) {
                if (const auto a = access_of(graph_, pass, t, mip, layer)) {
                    access(texture_key(t, mip, layer), plan_.textures[t], *a, desc.name);
                }
            });
        }
        for (std::uint32_t b = 0; b < graph_.buffers.size(); ++b) {
            if (const auto a = access_of(pass, b)) {
                access(buffer_key(b), plan_.buffers[b], *a, graph_.buffers[b].desc.name);
            }
        }
        past_.insert(past_.end(), now.begin(), now.end());
    }

    const GraphDeclaration& graph_;
    const GraphPlan& plan_;
    std::vector<Past> past_;
};

TEST(RandomGraphs, EveryConflictIsOrderedAndEveryReadSeesItsWrite) {
    for (std::uint32_t seed = 1; seed <= 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        const GraphDeclaration graph = random_graph(random);
        const GraphPlan plan = make_plan(graph, nominal_footprints(graph));
        Model(graph, plan).run();
        if (::testing::Test::HasFailure()) {
            ADD_FAILURE() << describe(graph, plan);
            return;
        }
    }
}

TEST(RandomGraphs, TheModelNoticesAMissingBarrier) {
    // Remove one barrier from a plan that needs it: the model above must object, or it proves nothing.
    GraphDeclaration graph;
    graph.buffers.push_back({.desc = {.name = "b", .bytes = 64}, .kept = true});
    for (const UseKind kind : {UseKind::storage_write, UseKind::storage_read}) {
        graph.passes.push_back({.name = "p", .uses = {{.kind = kind, .texture = false}}, .keep = true});
    }
    GraphPlan plan = make_plan(graph, nominal_footprints(graph));
    ASSERT_EQ(plan.passes[1].buffers.size(), 1U);
    plan.passes[1].buffers.clear();
    ::testing::TestPartResultArray found;
    {
        const ::testing::ScopedFakeTestPartResultReporter reporter(
            ::testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &found);
        Model(graph, plan).run();
    }
    EXPECT_EQ(found.size(), 2) << "not ordered, and not seen";
}

TEST(RandomPlacement, LivingResourcesNeverOverlap) {
    for (std::uint32_t seed = 1; seed <= 300; ++seed) {
        std::mt19937 random(seed);
        const auto pick = [&](std::uint32_t count) {
            return std::uniform_int_distribution<std::uint32_t>(0, count - 1)(random);
        };
        GraphDeclaration graph;
        Footprints footprints;
        GraphPlan plan;
        const std::uint32_t passes = 10;
        for (std::uint32_t p = 0; p < passes; ++p) {
            graph.passes.push_back({.name = "p"});
            plan.passes.push_back({.declared = p});
        }
        VkDeviceSize sum = 0;
        for (std::uint32_t b = 0; b < 12; ++b) {
            graph.buffers.push_back({.desc = {.name = "b", .bytes = 16}, .kept = pick(6) == 0});
            footprints.buffers.push_back({1 + pick(5000), VkDeviceSize{1} << pick(9), 1U << pick(2)});
            sum += footprints.buffers.back().bytes + footprints.buffers.back().alignment;
            for (std::uint32_t n = 0; n < 2; ++n) {
                graph.passes[pick(passes)].uses.push_back(
                    {.kind = UseKind::storage_write, .texture = false, .resource = b});
            }
        }
        place(graph, footprints, plan);
        EXPECT_LE(plan.transient_bytes(), sum);
        for (std::uint32_t a = 0; a < 12; ++a) {
            const Placement& x = plan.buffers[a];
            EXPECT_EQ(x.offset % footprints.buffers[a].alignment, 0U);
            EXPECT_LE(x.offset + x.bytes, plan.heaps[x.heap].bytes);
            EXPECT_EQ(plan.heaps[x.heap].type_bits, footprints.buffers[a].type_bits);
            for (std::uint32_t b = 0; b < a; ++b) {
                const Placement& y = plan.buffers[b];
                const bool alive_together = x.first <= y.last && y.first <= x.last;
                const bool overlap = x.heap == y.heap && x.offset < y.offset + y.bytes && y.offset < x.offset + x.bytes;
                EXPECT_FALSE(alive_together && overlap) << "seed " << seed << ", " << a << " and " << b;
            }
        }
    }
}

}  // namespace
}  // namespace gn::graph_random_test
