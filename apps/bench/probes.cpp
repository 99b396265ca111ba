// SPDX-License-Identifier: MIT
#include "apps/bench/probes.h"

#include "gpu/frame_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gn {
namespace {

constexpr double ns_from_ms = 1e6;
constexpr int turns = 7;

constexpr const char* empty_text = "layout(local_size_x = 1) in;\nvoid main() {}\n";

// Eight chains of multiply-adds, whose ends no compiler can foresee.
constexpr const char* madd_text = R"(
layout(local_size_x = 64) in;
layout(binding = 0, scalar) buffer Sink { float v[]; } sink;
void main() {
    vec4 a = vec4(gl_GlobalInvocationID.xyzx) * 1e-3, b = a + 0.5;
    for (int i = 0; i < 128; ++i) {
        a = a * 0.999 + 0.001;
        b = b * 0.998 + 0.002;
    }
    float sum = dot(a, vec4(1)) + dot(b, vec4(1));
    if (sum < -1e6) {
        sink.v[0] = sum;
    }
}
)";
constexpr double madds_of_an_item = 128.0 * 8.0;

constexpr const char* copy_text = R"(
layout(local_size_x = 64) in;
layout(binding = 0, scalar) readonly buffer From { uvec4 v[]; } from;
layout(binding = 1, scalar) writeonly buffer To { uvec4 v[]; } to;
void main() {
    uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64 + gl_LocalInvocationID.x;
    to.v[i] = from.v[i];
}
)";
constexpr VkDeviceSize bytes_of_a_row_of_groups = VkDeviceSize{1024} * 64 * 16;

constexpr const char* constant_text = "layout(location = 0) out float color;\nvoid main() { color = 0.5; }\n";

// Corner k of a strip that zigzags along rows of pixels: every triangle is half a pixel.
constexpr const char* zigzag_text = R"(
void main() {
#if defined(GN_CULLED)
    int k = gl_VertexIndex / 3;
#elif defined(GN_LIST)
    int k = gl_VertexIndex / 3 + gl_VertexIndex % 3;
#else
    int k = gl_VertexIndex;
#endif
    ivec2 pixel = ivec2((k / 2) % 1024, (k / 2) / 1024 % 1023 + k % 2);
    gl_Position = vec4(vec2(pixel) / 512.0 - 1.0, 0.5, 1.0);
}
)";
constexpr std::uint32_t zigzag_side = 1024;

constexpr const char* passing_text = R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
void main() {
    for (int i = 0; i < 3; ++i) {
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
    EndPrimitive();
}
)";

/// Builds one graph, whose pass "probe" is timed.
using Build = std::function<void(FrameGraph&)>;

double least_ms(Device& device, const Build& build) {
    FrameGraph graph(device);
    build(graph);
    graph.execute(false);
    double least = std::numeric_limits<double>::max();
    for (int turn = 0; turn < turns; ++turn) {
        graph.execute(true);
        for (const PassTime& pass : graph.statistics().passes) {
            least = pass.name == "probe" ? std::min(least, pass.ms) : least;
        }
    }
    return least;
}

ComputeDesc compute(const char* name, const char* text) {
    return {{ShaderKind::compute, name, text}, {}};
}

void nothing(FrameGraph& graph) {
    graph.add_pass(
        "probe", [](PassBuilder& pass) { pass.keep(); },
        [](Recorder& r) {
            r.bind(compute("nothing.comp", empty_text));
            r.dispatch(1, 1);
        });
}

Build multiply_and_add(std::uint32_t groups) {
    return [=](FrameGraph& graph) {
        const BufferHandle sink = graph.create(BufferDesc{.name = "sink", .bytes = 16});
        graph.add_pass(
            "probe",
            [=](PassBuilder& pass) {
                pass.storage_write(sink);
                pass.keep();
            },
            [=](Recorder& r) {
                r.bind(compute("madd.comp", madd_text));
                r.set("sink", sink);
                r.dispatch(groups, 1);
            });
    };
}

Build copy(std::uint32_t rows, bool by_shader) {
    return [=](FrameGraph& graph) {
        const VkDeviceSize bytes = rows * bytes_of_a_row_of_groups;
        const BufferHandle from = graph.create(BufferDesc{.name = "from", .bytes = bytes});
        const BufferHandle to = graph.create(BufferDesc{.name = "to", .bytes = bytes});
        graph.add_pass(
            "fill", [=](PassBuilder& pass) { pass.copy_to(from); }, [=](Recorder& r) { r.fill(from, 7); });
        graph.add_pass(
            "probe",
            [=](PassBuilder& pass) {
                by_shader ? pass.storage_read(from) : pass.copy_from(from);
                by_shader ? pass.storage_write(to) : pass.copy_to(to);
                pass.keep();
            },
            [=](Recorder& r) {
                if (!by_shader) {
                    r.copy(from, to, bytes);
                    return;
                }
                r.bind(compute("copy.comp", copy_text));
                r.set("from", from);
                r.set("to", to);
                r.dispatch(1024, rows);
            });
    };
}

Build full_screen(std::uint32_t side, bool with_fragments) {
    return [=](FrameGraph& graph) {
        const TextureHandle target =
            graph.create({.name = "target",
                          .format = with_fragments ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_D32_SFLOAT,
                          .width = side,
                          .height = side});
        graph.add_pass(
            "probe",
            [=](PassBuilder& pass) {
                with_fragments ? pass.color(target, Load::clear) : pass.depth(target, Load::clear);
                pass.keep();
            },
            [=](Recorder& r) {
                RasterDesc desc = fullscreen({ShaderKind::fragment, "constant.frag", constant_text});
                if (!with_fragments) {
                    desc.fragment.reset();
                    desc.depth_test = desc.depth_write = true;
                    desc.depth_compare = VK_COMPARE_OP_ALWAYS;
                }
                r.bind(desc);
                r.draw(3);
            });
    };
}

enum class Form { strip, list, culled, passed_on };

Build small_triangles(std::uint32_t count, Form form) {
    return [=](FrameGraph& graph) {
        const TextureHandle target = graph.create(
            {.name = "target", .format = VK_FORMAT_D32_SFLOAT, .width = zigzag_side, .height = zigzag_side});
        graph.add_pass(
            "probe",
            [=](PassBuilder& pass) {
                pass.depth(target, Load::clear);
                pass.keep();
            },
            [=](Recorder& r) {
                RasterDesc desc;
                const bool strip = form == Form::strip;
                const char* const form_text = strip                  ? ""
                                              : form == Form::culled ? "#define GN_CULLED\n"
                                                                     : "#define GN_LIST\n";
                desc.vertex = {ShaderKind::vertex, "zigzag.vert", std::string(form_text) + zigzag_text};
                if (form == Form::passed_on) {
                    desc.geometry = ShaderSource{ShaderKind::geometry, "passing.geom", passing_text};
                }
                desc.topology = strip ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
                desc.depth_test = desc.depth_write = true;
                r.bind(desc);
                r.draw(strip ? count + 2 : 3 * count);
            });
    };
}

/// Multiply-adds of so many groups that they are told from the pass's own time.
double madd_ns(Device& device, double pass_ms) {
    std::uint32_t groups = 16;
    double ms = least_ms(device, multiply_and_add(groups)) - pass_ms;
    while (ms < std::max(4.0, 20 * pass_ms) && groups < (1U << 15U)) {
        groups *= 2;
        ms = least_ms(device, multiply_and_add(groups)) - pass_ms;
    }
    return ns_from_ms * ms / (groups * 64.0 * madds_of_an_item);
}

}  // namespace

MachineRates probe_machine(Device& device) {
    const bool cpu = device.info().cpu;
    const double pass_ms = least_ms(device, nothing);
    const auto work_ms = [&](const Build& build) { return std::max(least_ms(device, build) - pass_ms, 0.0); };
    MachineRates rates;
    rates.pass = ns_from_ms * pass_ms;
    rates.madd = madd_ns(device, pass_ms);

    // Reads and writes in a row, by a shader or by the driver's own copy, whichever is faster.
    const std::uint32_t rows = cpu ? 32 : 512;
    const double copied = 2.0 * rows * static_cast<double>(bytes_of_a_row_of_groups);
    rates.byte = ns_from_ms * std::min(work_ms(copy(rows, true)), work_ms(copy(rows, false))) / copied;

    const std::uint32_t side = cpu ? 2048 : 8192;
    const double pixels = double(side) * side;
    rates.fragment = ns_from_ms * work_ms(full_screen(side, true)) / pixels;
    rates.sample = ns_from_ms * work_ms(full_screen(side, false)) / pixels;

    // A list shades three corners a triangle where a strip shades one; the difference is two vertices.
    const std::uint32_t triangles = cpu ? 1U << 14U : 1U << 22U;
    const double strip = ns_from_ms * work_ms(small_triangles(triangles, Form::strip)) / triangles;
    const double list = ns_from_ms * work_ms(small_triangles(triangles, Form::list)) / triangles;
    const double culled = ns_from_ms * work_ms(small_triangles(triangles, Form::culled)) / triangles;
    const double passed = ns_from_ms * work_ms(small_triangles(triangles, Form::passed_on)) / triangles;
    rates.vertex = std::max(0.0, (list - strip) / 2);
    rates.primitive = std::max(0.0, strip - rates.vertex);
    rates.culled = std::max(0.0, culled - 3 * rates.vertex);
    rates.emitted = std::max(0.0, passed - list);
    return rates;
}

std::span<const RateRow> rate_rows() {
    static constexpr std::array rows{
        RateRow{"pass", &MachineRates::pass, "passes/s", "passes that do nothing"},
        RateRow{"madd", &MachineRates::madd, "madd/s", "multiply-adds of 32 bits"},
        RateRow{"byte", &MachineRates::byte, "B/s", "bytes read or written in a row"},
        RateRow{"vertex", &MachineRates::vertex, "vertices/s", "vertices that are only placed"},
        RateRow{"culled", &MachineRates::culled, "triangles/s", "triangles without area"},
        RateRow{"primitive", &MachineRates::primitive, "triangles/s", "triangles of half a pixel"},
        RateRow{"emitted", &MachineRates::emitted, "triangles/s", "triangles that a geometry shader passes on"},
        RateRow{"fragment", &MachineRates::fragment, "fragments/s", "fragments of one constant, four bytes each"},
        RateRow{"sample", &MachineRates::sample, "samples/s", "samples of depth without a fragment shader"},
    };
    return rows;
}

std::string spoken_rate(const RateRow& row, const MachineRates& rates) {
    const double ns = rates.*row.value;
    if (!(ns > 0)) {
        return "too fast to be told";
    }
    const double a_second = 1e9 / ns;
    const int power = std::clamp(static_cast<int>(std::log10(a_second) / 3), 0, 4);
    constexpr std::array<std::string_view, 5> prefixes{"", "k", "M", "G", "T"};
    return fmt::format("{:.3g} {}{}", a_second / std::pow(1000.0, power), prefixes[static_cast<std::size_t>(power)],
                       row.unit);
}

}  // namespace gn
