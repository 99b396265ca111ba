// SPDX-License-Identifier: MIT
// Based on: Johnson, Lee, Burns, Mark. The Irregular Z-Buffer: Hardware Acceleration for Irregular Data Structures. ACM TOG 2005.
// [JLBM05]
#include "shadow/direct/irregular_z/irregular_z_pairs.h"

#include "gpu/zeros_pass.h"
#include "shadow/casters/touched_texels.h"
#include "shadow/geometry/occluders.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn {
namespace {

constexpr const char* hides_text = R"(
void gn_pair(uint sample_index, vec3 p_ws, vec3 n_ws, uint triangle, GnOccluder t, bool masked) {
    uint said = gn_occluder_says(t, p_ws, n_ws, u.light_ws);
    if (masked && (said & ~gn_says_holds) != 0u) {
        vec3 origin_ws = gn_ray_origin(p_ws, n_ws);
        bool solid = gn_mask_solid(triangle, gn_hit_shares(gn_occluder_edges(t, origin_ws), gn_towards(origin_ws, u.light_ws)));
        said = solid ? said : said & gn_says_holds;
    }
    if (said != 0u) {
        atomicOr(hidden[sample_index], said);
    }
}
)";

constexpr const char* sample_main = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    GnReceiver receiver;
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy))) || !read_sample(pixel, receiver)) {
        return;
    }
    // Where two views overlap the first serves.
    ivec3 texel = gn_irregular_z_texel(views[GN_CHOOSE(receiver, placement).first], receiver.p_ws);
    uint sample_index = uint(pixel.y) * u.view.size.x + uint(pixel.x);
    if (texel.z >= 0) {
        VISIT
    }
}
)";

// A block of texels knows its sample that is farthest from the light, plus 1; 0 where it has none.
constexpr const char* add_sample = R"(
        gn_list_add(texel, sample_index);
        GnLightView view = views[GN_CHOOSE(receiver, placement).first];
        float depth = max(dot(view.depth_from_ws, vec4(receiver.p_ws, 1.0)), 0.0);
        atomicMax(block_far[gn_block(texel)], floatBitsToUint(1.0 + depth));
)";

constexpr const char* block_text = R"(
uint gn_block(ivec3 texel) { return (uint(texel.z) * u.blocks + uint(texel.y) / 8u) * u.blocks + uint(texel.x) / 8u; }
)";

// What lies beyond all samples of a block hides the light from none of them.
constexpr const char* nearest_text = R"(
    GnOccluder t = GnOccluder(a_ws, b_ws, c_ws, (occluder_kinds[triangle] & 2u) != 0u);
    vec4 depth_from_ws = views[index].depth_from_ws;
    float nearest = min(min(dot(depth_from_ws, vec4(t.a, 1.0)), dot(depth_from_ws, vec4(t.b, 1.0))),
                        dot(depth_from_ws, vec4(t.c, 1.0)));
    nearest -= 1.0e-5 * (1.0 + abs(nearest)) + u.reach * length(depth_from_ws.xyz);
)";
constexpr const char* wanted_text =
    "uintBitsToFloat(block_far[gn_block(block * ivec3(8, 8, 1))]) >= 1.0 + nearest && "
    "block_far[gn_block(block * ivec3(8, 8, 1))] != 0u";

constexpr const char* walk_triangles = R"(
        uint node = gn_list_first(texel);
        for (; node != 0u; node = gn_list_next(node)) {
            uint triangle = gn_list_value(node);
            gn_pair(sample_index, receiver.p_ws, receiver.n_ws, triangle, gn_occluder(triangle), true);
        }
        if (node != 0u) {
            atomicOr(walk_cut, 1u);
        }
)";

constexpr const char* walk_samples = R"(
            uint node = gn_list_first(texel);
            for (; node != 0u; node = gn_list_next(node)) {
                uint sample_index = gn_list_value(node);
                ivec2 pixel = ivec2(sample_index % u.width, sample_index / u.width);
                gn_pair(sample_index, gbuffer_position_texel(pixel).xyz, gbuffer_normal_texel(pixel).xyz, triangle, t,
                        GN_MASKED);
            }
            gn_cut = gn_cut || node != 0u;
)";

/// A pass over the view samples through the light views.
void add_samples_pass(const FrameInput& input, const Recipe& recipe, const LightViews& views, const std::string& name,
                      const ShaderInputs& more, const std::string& includes, const std::string& functions,
                      std::string_view visit) {
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    inputs.add(more);
    const std::string defines = receiver_defines(recipe, views);
    const std::string shared = sample_functions(input, recipe, views);
    const Hasher key =
        hashed(inputs).text(defines).text(shared).text(functions).text(includes).text(visit).text(views.part->id);
    const auto shader = compute_once(input.prepared, name, key, [&] {
        std::string main = sample_main;
        main.replace(main.find("VISIT"), 5, visit);
        return defines + include_line("shadow/view/view.glsl") + placement_text(*views.part, recipe) +
               include_line("shadow/direct/irregular_z/irregular_z.glsl") + includes + inputs.text() + shared +
               functions + main;
    });
    add_pixel_pass(input.graph, name, inputs, shader, input.samples.width, input.samples.height);
}

/// The light's triangles that are masked, or those that hide all behind them.
std::vector<TriangleRun> runs_of(const FrameInput& input, bool masked) {
    const std::vector<CasterKind> kinds = caster_kinds(input);
    if (!masked) {
        return opaque_caster_runs(input.scene, kinds);
    }
    std::vector<TriangleRun> runs;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const Object& object = input.scene.objects[i];
        if (kinds[i] == CasterKind::masked && object.triangle_count > 0) {
            runs.push_back({object.first_triangle, object.triangle_count});
        }
    }
    return runs;
}

/// Triangles reach 1/256 of a texel further, more than rounding moves them and the samples by.
std::string with_rounding(const std::string& margin) {
    return (margin.empty() ? "" : margin + " + ") + std::string("0.00390625");
}

// How long the list of each sample's texel is.
constexpr const char* lengths_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    GnReceiver receiver;
    uint length = 0u;
    if (read_sample(pixel, receiver)) {
        ivec3 texel = gn_irregular_z_texel(views[GN_CHOOSE(receiver, placement).first], receiver.p_ws);
        for (uint node = texel.z >= 0 ? gn_list_first(texel) : 0u; node != 0u; node = gn_list_next(node)) {
            ++length;
        }
    }
    imageStore(lengths, pixel, vec4(float(length)));
}
)";

}  // namespace

TextureHandle add_list_lengths(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                               const TexelLists& lists, const std::string& name) {
    const TextureHandle lengths = input.graph.create(TextureDesc{.name = name + " lengths",
                                                                 .format = VK_FORMAT_R32_SFLOAT,
                                                                 .width = input.samples.width,
                                                                 .height = input.samples.height});
    ShaderInputs inputs = sample_inputs(input, recipe, views);
    add_lists(inputs, lists, ListAccess::read);
    inputs.image("r32f", "writeonly", "image2D", "lengths", lengths);
    const std::string defines = receiver_defines(recipe, views);
    const std::string shared = sample_functions(input, recipe, views);
    const Hasher key = hashed(inputs).text(defines).text(shared).text(views.part->id);
    const auto shader = compute_once(input.prepared, name + ": lengths", key, [&] {
        return defines + include_line("shadow/view/view.glsl") + placement_text(*views.part, recipe) +
               include_line("shadow/direct/irregular_z/irregular_z.glsl") + inputs.text() + shared +
               list_functions(ListAccess::read) + lengths_text;
    });
    add_pixel_pass(input.graph, name + ": lengths", inputs, shader, input.samples.width, input.samples.height);
    return lengths;
}

TexelLists add_sample_pairs(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                            const SamplePairs& pairs) {
    const uvec3 size(views.resolution, views.resolution, views.layers);
    const std::uint64_t texels = std::uint64_t{size.x} * size.y * size.z;
    const std::uint64_t samples = std::uint64_t{input.samples.width} * input.samples.height;
    const std::uint64_t triangles = input.scene.triangles.size();
    const TexelLists lists =
        add_texel_lists(input, pairs.name, size, pairs.list_triangles ? 4 * texels + 16 * triangles : samples);
    ShaderInputs asked = pairs.inputs;
    add_occluders(asked, input);
    const std::string includes = occluder_includes() + pairs.includes;
    const std::string functions = occluder_functions() + pairs.functions;

    const std::uint32_t blocks = (size.x + 7) / 8;
    const BufferHandle block_far = input.graph.create(BufferDesc{
        .name = pairs.name + " blocks", .bytes = VkDeviceSize{blocks} * blocks * size.z * sizeof(std::uint32_t)});

    // A texel lists its samples.
    if (!pairs.list_triangles) {
        ShaderInputs inputs;
        add_lists(inputs, lists, ListAccess::add);
        inputs.buffer("buffer", "BlockFar", "uint block_far[];", block_far).constant("uint", "blocks", blocks);
        add_zeros(input.graph, pairs.name + ": blocks", {block_far});
        add_samples_pass(input, recipe, views, pairs.name + ": lists", inputs, "",
                         list_functions(ListAccess::add) + block_text, add_sample);
    }

    // Every triangle visits the texels that it touches.
    const ListAccess access = pairs.list_triangles ? ListAccess::add : ListAccess::read;
    for (const bool masked : {false, true}) {
        TouchedTexels touched{.name = pairs.name + (masked ? ": masks" : ": triangles")};
        touched.margin = with_rounding(pairs.margin);
        touched.runs = runs_of(input, masked);
        touched.alone = pairs.alone;
        touched.shares = pairs.shares;
        if (pairs.list_triangles) {
            touched.inputs = pairs.inputs;
            touched.body = "gn_list_add(texel, triangle);";
        } else {
            touched.includes = fmt::format("#define GN_MASKED {}\n", masked);
            touched.inputs = asked;
            add_gbuffer(touched.inputs, input.device, input.samples);
            touched.inputs.constant("uint", "width", input.samples.width);
            touched.functions = functions;
            touched.inputs.buffer("readonly buffer", "BlockFar", "uint block_far[];", block_far);
            touched.inputs.constant("uint", "blocks", blocks).constant("float", "reach", pairs.reach);
            touched.functions += block_text;
            touched.triangle_body = nearest_text;
            touched.wanted = wanted_text;
            touched.body = walk_samples;
        }
        touched.includes += includes;
        add_lists(touched.inputs, lists, access);
        touched.functions += list_functions(access);
        add_touched_texels(input, views, touched);
    }

    // Or samples walk the triangles that their texel lists.
    if (pairs.list_triangles) {
        ShaderInputs inputs = asked;
        add_lists(inputs, lists, ListAccess::read);
        const BufferHandle cut =
            input.graph.create(BufferDesc{.name = pairs.name + " samples cut", .bytes = sizeof(std::uint32_t)});
        add_zeros(input.graph, pairs.name + ": none is cut", {cut});
        inputs.buffer("buffer", "WalkCut", "uint walk_cut;", cut);
        add_samples_pass(input, recipe, views, pairs.name + ": samples", inputs, includes,
                         functions + list_functions(ListAccess::read), walk_triangles);
        tell_cut(input, pairs.name + ": samples", cut);
    }
    return lists;
}

HiddenSamples add_hidden_samples(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                                 bool list_triangles) {
    // Nothing is hidden yet.
    HiddenSamples found;
    const VkDeviceSize bytes = VkDeviceSize{input.samples.width} * input.samples.height * sizeof(std::uint32_t);
    found.hidden = input.graph.create(BufferDesc{.name = "irregular-z hidden", .bytes = bytes});
    add_zeros(input.graph, "irregular-z: light", {found.hidden});

    // Every triangle hides the light from the samples that it hides it from.
    SamplePairs pairs{.name = "irregular-z",
                      .includes = "",
                      .inputs = {},
                      .functions = hides_text,
                      .margin = "",
                      .list_triangles = list_triangles};
    pairs.inputs.buffer("buffer", "Hidden", "uint hidden[];", found.hidden);
    pairs.inputs.constant("vec4", "light_ws", light_point_ws(input.light().shape));
    found.lists = add_sample_pairs(input, recipe, views, pairs);
    return found;
}

std::string refuses_bent(const Light& light, const Recipe& recipe, std::string_view sentence) {
    const Part& placement = recipe.placement_for(light.shape);
    return placement.bends ? fmt::format(fmt::runtime(sentence), placement.id) + "; use auto or cube" : "";
}

}  // namespace gn
