// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002.
// [EK02] The draws that count.
// Based on: Hornus, Hoberock, Lefebvre, Hart. ZP+: Correct Z-pass Stencil Shadows. I3D 2005. [HHLH05]
// Departs from them: the count is a sum of blended floats, exact to 16 million, where eight bits of stencil wrap at 256; which
// side of the samples is counted each component of the mesh decides for itself.
#include "shadow/geometry/volume_steps.h"

namespace gn {

namespace {

// The vertex shaders clip at the near plane themselves, as volume_side.glsl does.
// An opaque cap's vertex, as it is, at the far end or on the near plane.
constexpr const char* opaque_text = R"(
layout(constant_id = 2) const int FAR = 0;
layout(location = 0) in vec3 in_position_ws;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
invariant gl_Position;
void main() {
    vec4 corner_ws = FAR != 0 ? gn_volumes_extrude(in_position_ws, u.frame.light_ws, u.frame.reach)
                              : vec4(in_position_ws, 1.0);
    gl_Position = gn_view_position(u.frame.cs_from_ws, corner_ws);
    gl_ClipDistance[0] = gn_volumes_beyond_near(gl_Position);
}
)";

constexpr const char* opaque_near_text = R"(
layout(location = 0) in vec3 in_position_ws;
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[1]; };
invariant gl_Position;
void main() {
    vec4 corner_cs = gn_view_position(u.frame.cs_from_ws, vec4(in_position_ws, 1.0));
    vec4 light_cs = gn_view_position(u.frame.cs_from_ws, u.frame.light_ws);
    gl_Position = gn_volumes_on_near(corner_cs, light_cs);
    gl_ClipDistance[0] = gn_volumes_before_near(corner_cs, light_cs);
}
)";

// A compared cap's vertex.
constexpr const char* compared_text = "#include \"shadow/geometry/volume_compared.glsl\"\n";

// Behind the sample a ray leaves volumes (+1) and enters them (-1); before it, it enters (+1) and leaves (-1). The far end is a
// mirror image.
constexpr const char* count_text = R"(
layout(constant_id = 1) const int TURNED = 0;
layout(constant_id = 2) const int FAR = 0;
layout(constant_id = 5) const int BEFORE = 0;
layout(location = 0) out float count;
void main() {
    count = (gl_FrontFacing == (TURNED == FAR)) == (BEFORE != 0) ? 1.0 : -1.0;
}
)";

constexpr const char* compared_count_text = R"(
layout(constant_id = 5) const int BEFORE = 0;
layout(location = 0) flat in int turned;
layout(location = 1) flat in vec3 to_eye_ws;
layout(location = 2) flat in vec3 corner_of_ws;
layout(location = 0) out float count;
void main() {
    if (to_eye_ws != vec3(0.0)) {
        vec4 p_ws = gbuffer_position_texel(ivec2(gl_FragCoord.xy));
        if (gn_volumes_beyond(to_eye_ws, corner_of_ws, p_ws.xyz) != (BEFORE != 0)) {
            discard;
        }
    }
    count = (gl_FrontFacing == (turned == 0)) == (BEFORE != 0) ? 1.0 : -1.0;
}
)";

// What lies between a point of the near plane and the light begins with one volume more.
constexpr const char* one_text = R"(
layout(location = 0) out float count;
void main() { count = 1.0; }
)";

enum Constant : std::uint32_t {
    is_strip = 0,
    is_turned = 1,
    is_far = 2,
    listed_before = 3,
    on_near = 4,
    counts_before = 5
};

/// Which samples a step counts at.
enum class At { all, marked, unmarked };

/// Lists of steps for one shader's inputs. Behind: what lies at or behind the sample counts; depth is reversed, so that this is
/// LESS_OR_EQUAL, and before it is all else (volumes.md derives both).
class Steps {
  public:
    Steps(const ShaderInputs& inputs, const StepOptions& options)
        : inputs_(inputs), all_fragments_(options.all_fragments), sliced_(options.sliced) {}

    /// The sides and the compared caps of one list, counted before the samples or behind them.
    void add_compared(std::uint32_t listed, bool before, At at) {
        const VkCompareOp compare = before ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS_OR_EQUAL;
        const SpecConstants constants{{listed_before, listed}, {counts_before, before ? 1U : 0U}};
        const bool sliced = sliced_ && listed == 1 && before;
        add({"volume-side.vert", side_body, count_text, compare, constants, false, sliced}, sides_draw + 4 * listed,
            at);
        add({"volume-compared.vert", compared_text, compared_count_text, compare, constants, false, sliced, true},
            compared_draw + 4 * listed, at);
    }
    /// The opaque caps of one list: no sample is behind them, so that they always count.
    void add_caps(std::uint32_t listed, bool far_caps, At at) {
        for (std::uint32_t turned = 0; turned < 2; ++turned) {
            for (std::uint32_t far = 0; far < (far_caps ? 2U : 1U); ++far) {
                add({"volume-cap.vert",
                     opaque_text,
                     count_text,
                     VK_COMPARE_OP_ALWAYS,
                     {{is_turned, turned}, {is_far, far}},
                     true},
                    opaque_draw + 5 * listed + 10 * turned, at);
            }
        }
    }
    /// What closes the volumes of the second list at the near plane.
    void add_near_ends(At at) {
        for (std::uint32_t turned = 0; turned < 2; ++turned) {
            add({"volume-cap-near.vert", opaque_near_text, one_text, VK_COMPARE_OP_ALWAYS, {}, true},
                opaque_draw + 5 + 10 * turned, at);
        }
        add({"volume-compared.vert", compared_text, one_text, VK_COMPARE_OP_ALWAYS, {{listed_before, 1}, {on_near, 1}}},
            compared_draw + 4, at);
    }
    /// Where sides hang from the edges of silhouettes.
    void add_silhouettes() {
        for (std::uint32_t listed = 0; listed < 2; ++listed) {
            add({"volume-side.vert",
                 side_body,
                 one_text,
                 VK_COMPARE_OP_ALWAYS,
                 {{is_strip, 1}, {listed_before, listed}}},
                strips_draw + 4 * listed, At::all);
        }
    }
    std::vector<Step> list;

  private:
    struct Shader {
        std::string_view name;
        std::string_view body;
        const char* count;
        VkCompareOp compare;
        SpecConstants constants;
        bool indexed = false;
        bool sliced = false;
        bool reads = false;  ///< its fragments read the inputs
    };
    void add(const Shader& shader, std::uint32_t word, At at) {
        RasterDesc desc;
        const std::string defines = shader.sliced ? "#define GN_VOLUMES_RUNS\n" : "";
        desc.vertex = {ShaderKind::vertex, std::string(shader.name),
                       volume_shader(inputs_, defines + std::string(shader.body))};
        desc.fragment = ShaderSource{ShaderKind::fragment, "volume-count.frag",
                                     all_fragments_ ? one_text
                                     : shader.reads ? volume_shader(inputs_, shader.count)
                                                    : shader.count};
        desc.constants = shader.constants;
        desc.blend = Blend::add;
        desc.depth_test = desc.depth_clamp = true;
        desc.depth_compare = all_fragments_ ? VK_COMPARE_OP_ALWAYS : shader.compare;
        if (at != At::all) {
            desc.stencil = volume_stencil(VK_COMPARE_OP_EQUAL, VK_STENCIL_OP_KEEP);
        }
        if (shader.indexed) {
            desc.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT}};
            desc.vertex_stride = sizeof(vec3);
        }
        list.push_back({sealed(std::move(desc)), word, shader.indexed, at == At::marked ? 1U : 0U});
    }

    const ShaderInputs& inputs_;
    bool all_fragments_, sliced_;
};

}  // namespace

StencilOps volume_stencil(VkCompareOp compare, VkStencilOp pass) {
    const VkStencilOpState state{.failOp = VK_STENCIL_OP_KEEP,
                                 .passOp = pass,
                                 .depthFailOp = VK_STENCIL_OP_KEEP,
                                 .compareOp = compare,
                                 .compareMask = 0xFF,
                                 .writeMask = 0xFF,
                                 .reference = 0};
    return {state, state};
}

std::vector<Step> count_steps(const ShaderInputs& inputs, const StepOptions& options) {
    Steps steps(inputs, options);
    const At at = options.alone ? At::marked : At::all;
    // What is listed as behind the samples, in any mode.
    steps.add_compared(0, false, at);
    steps.add_caps(0, options.far_caps, at);
    // What is listed as before them.
    if (options.mode == VolumeMode::split) {
        steps.add_compared(1, true, At::marked);
        steps.add_compared(1, false, At::unmarked);
        steps.add_caps(1, options.far_caps, At::unmarked);
        return std::move(steps.list);
    }
    steps.add_compared(1, true, at);
    if (options.mode == VolumeMode::capped) {
        steps.add_near_ends(at);
    }
    return std::move(steps.list);
}

std::vector<Step> silhouette_steps(const ShaderInputs& inputs) {
    Steps steps(inputs, {.all_fragments = true});
    steps.add_silhouettes();
    return std::move(steps.list);
}

void draw_steps(Recorder& r, const std::vector<Step>& steps, BufferHandle draws) {
    for (const Step& step : steps) {
        r.bind(step.pipeline);
        r.stencil_reference(step.mark);
        const VkDeviceSize at = step.word * sizeof(std::uint32_t);
        if (step.indexed) {
            r.draw_indexed_indirect(draws, at);
        } else {
            r.draw_indirect(draws, at);
        }
    }
}

}  // namespace gn
