// SPDX-License-Identifier: MIT
// Compute, copies, order within and between passes, repeated execution, and what misuse answers.
#include "gpu/test_device.h"

#include <algorithm>
#include <numeric>

namespace gn::graph_execute_test {
namespace {

class Graph : public Rendered {
  protected:
    BufferHandle words(const char* name, std::size_t count) {
        return graph.create(BufferDesc{.name = name, .bytes = count * 4});
    }
    template <class T = std::uint32_t>
    std::vector<T> read(BufferHandle buffer) {
        return values_of<T>(graph.download(buffer));
    }
    FrameGraph graph{device};
};

/// values[i] = values[i] * factor + offset
ComputeDesc scale_and_add() {
    return {compute_shader("scale and add", R"(
layout(local_size_x = 64) in;
layout(binding = 0, scalar) uniform Params { uint factor; uint offset; uint count; } params;
layout(binding = 1, scalar) buffer Values { uint v[]; } values;
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < params.count) {
        values.v[i] = values.v[i] * params.factor + params.offset;
    }
}
)"),
            {}};
}
struct ScaleAndAdd {
    std::uint32_t factor, offset, count;
};

TEST_F(Graph, UniformBytesBelongToTheirDispatch) {
    const BufferHandle a = words("a", 100), b = words("b", 100);
    graph.keep(a);
    graph.keep(b);
    graph.add_pass(
        "two",
        [&](PassBuilder& pass) {
            pass.storage_write(a);
            pass.storage_write(b);
        },
        [=](Recorder& r) {
            r.bind(scale_and_add());
            r.set("values", a);
            r.set_value("params", ScaleAndAdd{0, 7, 100});
            r.dispatch(2, 1);
            r.set("values", b);
            r.set_value("params", ScaleAndAdd{0, 9, 100});
            r.dispatch(2, 1);
        });
    graph.execute();
    EXPECT_EQ(read(a), std::vector<std::uint32_t>(100, 7));
    EXPECT_EQ(read(b), std::vector<std::uint32_t>(100, 9));
}

TEST_F(Graph, CommandsOfAPassSeeEachOther) {
    const BufferHandle a = words("a", 64), b = words("b", 64);
    graph.keep(b);
    graph.add_pass(
        "chain",
        [&](PassBuilder& pass) {
            pass.copy_to(a);
            pass.storage_write(a);
            pass.copy_from(a);
            pass.copy_to(b);
        },
        [=](Recorder& r) {
            r.fill(a, 1);
            r.bind(scale_and_add());
            r.set("values", a);
            for (std::uint32_t i = 0; i < 3; ++i) {
                r.set_value("params", ScaleAndAdd{10, i, 64});
                r.dispatch(1, 1);
            }
            r.copy(a, b, 64 * 4);
        });
    graph.execute();
    EXPECT_EQ(read(b), std::vector<std::uint32_t>(64, 1012));
}

TEST_F(Graph, RoundsRunInOrderEachWithItsOwnConstants) {
    for (const bool timed : {true, false}) {
        FrameGraph rounds(device);
        const BufferHandle sums = rounds.create(BufferDesc{.name = "sums", .bytes = 256});
        rounds.keep(sums);
        const auto step = [&](BufferHandle buffer, ScaleAndAdd by) {
            rounds.add_pass(
                "step", [&](PassBuilder& pass) { pass.storage_write(buffer); },
                [=](Recorder& r) {
                    r.bind(scale_and_add());
                    r.set("values", buffer);
                    r.set_value("params", by);
                    r.dispatch(1, 1);
                });
        };
        rounds.add_pass(
            "fill", [&](PassBuilder& pass) { pass.copy_to(sums); }, [=](Recorder& r) { r.fill(sums, 1); });
        rounds.begin_rounds();
        for (std::uint32_t i = 0; i < 5; ++i) {
            rounds.next_round();
            step(sums, {3, i, 64});
            // What nobody reads is left out, and the round's other passes still have functions of their own.
            step(rounds.create(BufferDesc{.name = "unread", .bytes = 256}), {0, 0, 64});
            step(sums, {1, 100 * i, 64});
        }
        rounds.end_rounds();
        step(sums, {2, 0, 64});
        rounds.execute(timed);
        std::uint32_t expected = 1;
        for (std::uint32_t i = 0; i < 5; ++i) {
            expected = expected * 3 + i + 100 * i;
        }
        EXPECT_EQ(values_of<std::uint32_t>(rounds.download(sums)), std::vector<std::uint32_t>(64, 2 * expected));
        EXPECT_EQ(rounds.statistics().passes.size(), 12U);
    }
}

TEST_F(Graph, PassesSeeEachOtherInOneSubmitAsInMany) {
    for (const bool timed : {true, false}) {
        FrameGraph one(device);
        const BufferHandle a = one.create(BufferDesc{.name = "a", .bytes = 256});
        one.keep(a);
        one.add_pass(
            "fill", [&](PassBuilder& pass) { pass.copy_to(a); }, [=](Recorder& r) { r.fill(a, 1); });
        for (std::uint32_t i = 0; i < 5; ++i) {
            one.add_pass(
                "step", [&](PassBuilder& pass) { pass.storage_write(a); },
                [=](Recorder& r) {
                    r.bind(scale_and_add());
                    r.set("values", a);
                    r.set_value("params", ScaleAndAdd{3, i, 64});
                    r.dispatch(1, 1);
                });
        }
        one.execute(timed);
        std::uint32_t expected = 1;
        for (std::uint32_t i = 0; i < 5; ++i) {
            expected = expected * 3 + i;
        }
        EXPECT_EQ(values_of<std::uint32_t>(one.download(a)), std::vector<std::uint32_t>(64, expected));
        ASSERT_EQ(one.statistics().passes.size(), 6U);
        const double sum = std::accumulate(one.statistics().passes.begin(), one.statistics().passes.end(), 0.0,
                                           [](double total, const PassTime& pass) { return total + pass.ms; });
        EXPECT_EQ(sum > 0.0, timed);
    }
}

TEST_F(Graph, RepeatedExecutionCarriesImportsOn) {
    Texture2D history(device, {.name = "history",
                               .format = VK_FORMAT_R32_SFLOAT,
                               .width = 8,
                               .height = 8,
                               .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
    const TextureHandle h = graph.import(history);
    const BufferHandle out = words("out", 64);
    graph.keep(out);
    int frame = 0;
    graph.add_pass(
        "accumulate", [&](PassBuilder& pass) { pass.storage_write(h); },
        [=, &frame](Recorder& r) {
            r.bind(ComputeDesc{compute_shader("accumulate", R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, r32f) uniform image2D history;
layout(push_constant) uniform Push { int frame; } push;
void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    float before = push.frame == 0 ? 0.0 : imageLoad(history, p).r;
    imageStore(history, p, vec4(before + 1.0));
}
)"),
                               {}});
            r.set_storage("history", h);
            r.push_value(frame);
            r.dispatch_pixels(8, 8);
        });
    graph.add_pass(
        "look",
        [&](PassBuilder& pass) {
            pass.sample(h);
            pass.storage_write(out);
        },
        [=](Recorder& r) {
            r.bind(ComputeDesc{compute_shader("look", R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D history;
layout(binding = 1, scalar) buffer Out { float v[]; } result;
void main() {
    uvec2 p = gl_GlobalInvocationID.xy;
    result.v[p.y * 8 + p.x] = texelFetch(history, ivec2(p), 0).r;
}
)"),
                               {}});
            r.set("history", h);
            r.set("result", out);
            r.dispatch_pixels(8, 8);
        });
    for (frame = 0; frame < 4; ++frame) {
        graph.execute(frame % 2 == 0);
        EXPECT_EQ(read<float>(out), std::vector<float>(64, static_cast<float>(frame + 1)));
        EXPECT_EQ(history.layouts[0], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    EXPECT_EQ(values_of<float>(graph.download(h)), std::vector<float>(64, 4.0F));
    graph.execute();
    EXPECT_EQ(read<float>(out), std::vector<float>(64, 5.0F)) << "a download between frames changes nothing";
}

TEST_F(Graph, AMipChainOfBlitsAverages) {
    constexpr std::uint32_t mips = 4;
    const TextureHandle t = graph.create(TextureDesc{
        .name = "pyramid", .format = VK_FORMAT_R32_SFLOAT, .width = 8, .height = 8, .layers = 2, .mips = mips});
    graph.keep(t);
    graph.add_pass(
        "top", [&](PassBuilder& pass) { pass.storage_write(t, one_mip(0)); },
        [=](Recorder& r) {
            r.bind(ComputeDesc{compute_shader("ramp", R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, r32f) uniform writeonly image2DArray top;
void main() {
    ivec3 p = ivec3(gl_GlobalInvocationID);
    imageStore(top, p, vec4(p.x + 100 * p.z));
}
)"),
                               {}});
            r.set_storage("top", t);
            r.dispatch(1, 1, 2);
        });
    for (std::uint32_t mip = 1; mip < mips; ++mip) {
        graph.add_pass(
            "down",
            [&](PassBuilder& pass) {
                pass.copy_from(t, one_mip(mip - 1));
                pass.copy_to(t, one_mip(mip));
            },
            [=](Recorder& r) { r.blit(t, one_mip(mip - 1), t, one_mip(mip), VK_FILTER_LINEAR); });
    }
    graph.execute();
    EXPECT_EQ(values_of<float>(graph.download(t, 3, 0)), std::vector<float>{3.5F});
    EXPECT_EQ(values_of<float>(graph.download(t, 3, 1)), std::vector<float>{103.5F});
    EXPECT_EQ(values_of<float>(graph.download(t, 2, 1)), (std::vector<float>{101.5F, 105.5F, 101.5F, 105.5F}));
}

TEST_F(Graph, AMipChainWithinOnePassAverages) {
    const TextureHandle t = graph.create(
        TextureDesc{.name = "pyramid", .format = VK_FORMAT_R32_SFLOAT, .width = 4, .height = 4, .mips = 3});
    graph.keep(t);
    graph.add_pass(
        "top", [&](PassBuilder& pass) { pass.color(t, Load::clear, {.color = vec4(6)}); }, [](Recorder&) {});
    graph.add_pass(
        "down",
        [&](PassBuilder& pass) {
            pass.copy_from(t, {0, 2, 0, 1});
            pass.copy_to(t, {1, 2, 0, 1});
        },
        [=](Recorder& r) {
            r.blit(t, one_mip(0), t, one_mip(1), VK_FILTER_LINEAR);
            r.blit(t, one_mip(1), t, one_mip(2), VK_FILTER_LINEAR);
        });
    graph.execute();
    EXPECT_EQ(values_of<float>(graph.download(t, 2)), std::vector<float>{6.0F});
}

TEST_F(Graph, ArgumentsWrittenByAPassDriveTheNext) {
    const BufferHandle arguments = words("arguments", 8), counter = words("counter", 4);
    const TextureHandle color =
        graph.create(TextureDesc{.name = "color", .format = VK_FORMAT_R32_SFLOAT, .width = 4, .height = 4});
    graph.keep(counter);
    graph.keep(color);
    graph.add_pass(
        "write",
        [&](PassBuilder& pass) {
            pass.storage_write(arguments);
            pass.copy_to(counter);
        },
        [=](Recorder& r) {
            r.fill(counter, 0);
            r.bind(ComputeDesc{compute_shader("arguments", R"(
layout(local_size_x = 1) in;
layout(binding = 0, scalar) writeonly buffer Arguments { uint v[]; } arguments;
void main() {
    uint values[8] = uint[](5u, 2u, 3u, 0u, 3u, 1u, 0u, 0u);
    for (int i = 0; i < 8; ++i) {
        arguments.v[i] = values[i];
    }
}
)"),
                               {}});
            r.set("arguments", arguments);
            r.dispatch(1, 1);
        });
    graph.add_pass(
        "count",
        [&](PassBuilder& pass) {
            pass.indirect(arguments);
            pass.storage_write(counter);
        },
        [=](Recorder& r) {
            r.bind(ComputeDesc{compute_shader("count", R"(
layout(local_size_x = 1) in;
layout(binding = 0, scalar) buffer Counter { uint v[]; } counter;
void main() { atomicAdd(counter.v[0], 1u); }
)"),
                               {}});
            r.set("counter", counter);
            r.dispatch_indirect(arguments);
        });
    graph.add_pass(
        "draw",
        [&](PassBuilder& pass) {
            pass.indirect(arguments);
            pass.color(color, Load::clear);
        },
        [=](Recorder& r) {
            r.bind(fullscreen(fragment_shader("one", "layout(location = 0) out float v; void main() { v = 1.0; }")));
            r.draw_indirect(arguments, 16);
        });
    graph.execute();
    EXPECT_EQ(read(counter)[0], 5U * 2 * 3);
    EXPECT_EQ(values_of<float>(graph.download(color)), std::vector<float>(16, 1.0F));
}

TEST_F(Graph, AliasedTransientsDoNotDisturbEachOther) {
    // A chain of images, each made from the last: only two are alive at once.
    const VkDeviceSize one = VkDeviceSize{64} * 64 * 4;
    TextureHandle last;
    for (int i = 0; i < 8; ++i) {
        const TextureHandle next =
            graph.create(TextureDesc{.name = "link", .format = VK_FORMAT_R32_SFLOAT, .width = 64, .height = 64});
        graph.add_pass(
            "link",
            [&](PassBuilder& pass) {
                pass.color(next, Load::discard);
                if (last.valid()) {
                    pass.sample(last);
                }
            },
            [=](Recorder& r) {
                const std::string read =
                    last.valid() ? "texelFetch(last, ivec2(gl_FragCoord.xy), 0).r + 1.0" : "gl_FragCoord.x";
                r.bind(fullscreen(fragment_shader("link",
                                                  "layout(binding = 0) uniform sampler2D last;\n"
                                                  "layout(location = 0) out float v;\nvoid main() { v = " +
                                                      read + "; }")));
                if (last.valid()) {
                    r.set("last", last);
                }
                r.draw(3);
            });
        last = next;
    }
    graph.keep(last);
    for (const bool timed : {false, true}) {
        graph.execute(timed);
        const auto values = values_of<float>(graph.download(last));
        for (std::size_t i = 0; i < values.size(); ++i) {
            ASSERT_EQ(values[i], static_cast<float>(i % 64) + 7.5F);
        }
    }
    EXPECT_LT(graph.statistics().transient_bytes, 4 * one) << graph.describe();
}

TEST_F(Graph, TexturesAreCopiedToBuffers) {
    const TextureHandle depth = graph.create(
        TextureDesc{.name = "depth", .format = VK_FORMAT_D32_SFLOAT_S8_UINT, .width = 4, .height = 4, .layers = 2});
    const BufferHandle out = words("out", 32);
    graph.keep(out);
    graph.add_pass(
        "clear", [&](PassBuilder& pass) { pass.depth(depth, Load::clear, {.depth = 0.375F}, one_mip(0)); },
        [](Recorder&) {});
    graph.add_pass(
        "copy",
        [&](PassBuilder& pass) {
            pass.copy_from(depth);
            pass.copy_to(out);
        },
        [=](Recorder& r) { r.copy(depth, out, {}); });
    graph.execute();
    EXPECT_EQ(read<float>(out), std::vector<float>(32, 0.375F));
}

TEST_F(Graph, ResourcesAreAccountedByGroup) {
    graph.group("scene");
    const BufferHandle a = words("positions", 1000);
    graph.group("shadow");
    const TextureHandle map =
        graph.create(TextureDesc{.name = "map", .format = VK_FORMAT_D32_SFLOAT, .width = 32, .height = 32});
    const TextureHandle unused =
        graph.create(TextureDesc{.name = "unused", .format = VK_FORMAT_D32_SFLOAT, .width = 32, .height = 32});
    graph.keep(map);
    graph.add_pass(
        "fill",
        [&](PassBuilder& pass) {
            pass.copy_to(a);
            pass.keep();
        },
        [=](Recorder& r) { r.fill(a, 0); });
    graph.add_pass(
        "map", [&](PassBuilder& pass) { pass.depth(map, Load::clear); }, [](Recorder&) {});
    graph.add_pass(
        "culled", [&](PassBuilder& pass) { pass.depth(unused, Load::clear); }, [](Recorder&) { FAIL(); });
    graph.execute();
    const GraphStatistics& statistics = graph.statistics();
    ASSERT_EQ(statistics.resources.size(), 2U);
    EXPECT_EQ(statistics.resources[0].name, "map");
    EXPECT_EQ(statistics.resources[0].group, "shadow");
    EXPECT_EQ(statistics.resources[0].bytes, 32U * 32 * 4);
    EXPECT_EQ(statistics.resources[1].group, "scene");
    EXPECT_EQ(statistics.passes.size(), 2U);
}

// What misuse answers: an Error that names the pass and the resource, never a crash.

class Misuse : public Graph {
  protected:
    /// The error of a compute pass that declares `setup` and records `record`.
    std::string compute_error(const std::function<void(PassBuilder&)>& setup,
                              const std::function<void(Recorder&)>& record) {
        FrameGraph& g = graph;
        g.add_pass(
            "culprit",
            [&](PassBuilder& pass) {
                setup(pass);
                pass.keep();
            },
            record);
        return error_of([&] { g.execute(); });
    }
    static void expect_names(const std::string& error, std::initializer_list<const char*> names) {
        for (const char* name : names) {
            EXPECT_NE(error.find(name), std::string::npos) << "'" << name << "' in: " << error;
        }
    }
};

TEST_F(Misuse, AResourceThatWasNeverSet) {
    const BufferHandle a = words("a", 64);
    const std::string error = compute_error([&](PassBuilder& pass) { pass.storage_write(a); },
                                            [=](Recorder& r) {
                                                r.bind(scale_and_add());
                                                r.set("values", a);
                                                r.dispatch(1, 1);
                                            });
    expect_names(error, {"'culprit'", "'params'", "never set"});
}

TEST_F(Misuse, AResourceThatWasNotDeclared) {
    const BufferHandle a = words("a", 64), b = words("b", 64);
    const std::string error = compute_error([&](PassBuilder& pass) { pass.storage_write(a); },
                                            [=](Recorder& r) {
                                                r.bind(scale_and_add());
                                                r.set("values", b);
                                                r.set_value("params", ScaleAndAdd{});
                                                r.dispatch(1, 1);
                                            });
    expect_names(error, {"'culprit'", "'b'", "not declared"});
}

TEST_F(Misuse, AMipThatWasNotDeclared) {
    const TextureHandle t =
        graph.create(TextureDesc{.name = "t", .format = VK_FORMAT_R32_SFLOAT, .width = 4, .height = 4, .mips = 2});
    const std::string error = compute_error([&](PassBuilder& pass) { pass.storage_write(t, one_mip(0)); },
                                            [=](Recorder& r) {
                                                r.bind(ComputeDesc{compute_shader("store", R"(
layout(local_size_x = 1) in;
layout(binding = 0, r32f) uniform writeonly image2D target;
void main() { imageStore(target, ivec2(0), vec4(1)); }
)"),
                                                                   {}});
                                                r.set_storage("target", t, one_mip(1));
                                                r.dispatch(1, 1);
                                            });
    expect_names(error, {"'culprit'", "'t'", "mip 1"});
}

TEST_F(Misuse, TooFewUniformBytes) {
    const BufferHandle a = words("a", 64);
    const std::string error = compute_error([&](PassBuilder& pass) { pass.storage_write(a); },
                                            [=](Recorder& r) {
                                                r.bind(scale_and_add());
                                                r.set("values", a);
                                                r.set_value("params", std::uint32_t{1});
                                                r.dispatch(1, 1);
                                            });
    expect_names(error, {"'culprit'", "'params'", "12 bytes", "4 were given"});
}

TEST_F(Misuse, ADispatchWithoutAPipeline) {
    expect_names(compute_error([](PassBuilder&) {}, [](Recorder& r) { r.dispatch(1, 1); }), {"'culprit'", "binds"});
}

TEST_F(Misuse, ADrawWithoutAttachments) {
    const std::string error = compute_error([](PassBuilder&) {}, [](Recorder& r) { r.bind(fullscreen({})); });
    expect_names(error, {"'culprit'", "attachment"});
}

TEST_F(Misuse, ADispatchWhileDrawing) {
    const TextureHandle t =
        graph.create(TextureDesc{.name = "t", .format = VK_FORMAT_R32_SFLOAT, .width = 4, .height = 4});
    const std::string error = compute_error([&](PassBuilder& pass) { pass.color(t, Load::clear); },
                                            [](Recorder& r) { r.bind(scale_and_add()); });
    expect_names(error, {"'culprit'", "without attachments"});
}

TEST_F(Misuse, LayersForAShaderThatReadsOne) {
    const TextureHandle t =
        graph.create(TextureDesc{.name = "t", .format = VK_FORMAT_R32_SFLOAT, .width = 4, .height = 4, .layers = 3});
    const std::string error = compute_error([&](PassBuilder& pass) { pass.storage_write(t); },
                                            [=](Recorder& r) {
                                                r.bind(ComputeDesc{compute_shader("flat", R"(
layout(local_size_x = 1) in;
layout(binding = 0, r32f) uniform writeonly image2D target;
void main() { imageStore(target, ivec2(0), vec4(1)); }
)"),
                                                                   {}});
                                                r.set_storage("target", t);
                                                r.dispatch(1, 1);
                                            });
    expect_names(error, {"'culprit'", "'target'", "3 layers of 't'", "one_layer"});
}

TEST_F(Misuse, AnImportWithoutTheUsage) {
    Texture2D texture(device, {.name = "plain",
                               .format = VK_FORMAT_R32_SFLOAT,
                               .width = 4,
                               .height = 4,
                               .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    const TextureHandle t = graph.import(texture);
    const std::string error = error_of([&] {
        graph.add_pass(
            "culprit", [&](PassBuilder& pass) { pass.storage_write(t); }, [](Recorder&) {});
    });
    expect_names(error, {"'culprit'", "'plain'", "storage_write"});
}

TEST_F(Misuse, TheGraphWorksAgainAfterAnError) {
    const BufferHandle a = words("a", 64);
    graph.keep(a);
    bool wrong = true;
    graph.add_pass(
        "sometimes", [&](PassBuilder& pass) { pass.copy_to(a); },
        [&wrong, a](Recorder& r) {
            r.fill(a, 3);
            if (wrong) {
                fail("interrupted");
            }
        });
    EXPECT_EQ(error_of([&] { graph.execute(); }), "interrupted");
    EXPECT_NE(error_of([&] { graph.download(a); }), "") << "nothing was executed";
    wrong = false;
    graph.execute();
    EXPECT_EQ(read(a), std::vector<std::uint32_t>(64, 3));
}

}  // namespace
}  // namespace gn::graph_execute_test
