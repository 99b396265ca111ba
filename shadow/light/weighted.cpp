// SPDX-License-Identifier: MIT
// Based on: Eisemann, Assarsson, Schwarz, Wimmer. Casting Shadows in Real Time. SIGGRAPH Asia Courses 2009. [EASW09]
// Eq. 1.6, with weights: V of an area is the mean of the V of its points.
#include "shadow/light/weighted.h"

#include "gpu/graph_rounds_scope.h"
#include "shadow/frame/frame.h"
#include "shadow/receiver/channels.h"
#include "shadow/receiver/expect.h"
#include "shadow/receiver/sample_pass.h"

namespace gn {
namespace {

constexpr const char* begin_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    ivec2 pixel = u.first + u.step * place;
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec4 position = gbuffer_position_texel(pixel);
    vec3 n_ws = gbuffer_normal_texel(pixel).xyz;
    bool counted = position.w > 0.5 && gn_counted(u.light, position.xyz, n_ws);
)";

// Adds w V and w of one light to the sums.
constexpr const char* add_text = R"(
    float weight = counted ? GN_WEIGHT(u.light, u.one, position.xyz, pixel, u.index, u.count) : 0.0;
    bool above = dot(n_ws, gn_to_light(u.one, position.xyz)) > 0.0;
    GN_V v = above ? GN_V_OF(texelFetch(visibility, u.few != 0 ? place : pixel, 0)) : GN_V(0.0);
#ifdef GN_LIGHT_FUSION
    if (GN_LIGHT_FUSION(u.params) != GN_FUSION_SUM) {
        GnFused fused = u.begins != 0 ? gn_unfused() : fused_of(imageLoad(sums, pixel));
        imageStore(sums, pixel, texel_of(gn_fuse(fused, 1.0 / float(u.count) - v / float(u.count))));
        return;
    }
#endif
    vec4 before = u.begins != 0 ? vec4(0.0) : imageLoad(sums, pixel);
    imageStore(sums, pixel, before + (weight > 0.0 ? weight * GN_SUM(v) : vec4(0.0)));
}
)";

// A light part whose pieces may be united otherwise than by their sum says how: GN_LIGHT_FUSION(params), one of
// shadow/receiver/fusion.h. What each hides is then a share of the whole light, V has one channel, and the sums hold the greatest
// and either the sum or what is left.
constexpr const char* fusion_text = R"(
#ifdef GN_LIGHT_FUSION
#include "shadow/receiver/fusion.glsl"
bool multiplies() { return GN_LIGHT_FUSION(u.params) == GN_FUSION_PRODUCT; }
GnFused fused_of(vec4 texel) { return GnFused(texel.x, texel.y, texel.x); }
vec4 texel_of(GnFused fused) { return vec4(multiplies() ? fused.left : fused.sum, fused.most, 0.0, 0.0); }
#endif
)";

constexpr const char* mean_text = R"(
    vec4 sum = imageLoad(sums, pixel);
    GN_V v = GN_SUM_WEIGHT(sum) > 0.0 ? GN_V_OF(sum) / GN_SUM_WEIGHT(sum) : GN_V(1.0);
#ifdef GN_LIGHT_FUSION
    if (GN_LIGHT_FUSION(u.params) != GN_FUSION_SUM) {
        v = 1.0 - gn_fused(fused_of(sum), GN_LIGHT_FUSION(u.params));
    }
#endif
    imageStore(visibility, pixel, counted ? GN_V_TEXEL(gn_unit(v)) : vec4(0.0));
}
)";

// Takes the samples of a lattice together, one beside the other; where the last ones end it holds nothing.
constexpr const char* gather_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void main() {
    ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    ivec2 pixel = u.first + u.step * place;
    bool there = all(lessThan(pixel, ivec2(u.view.size.xy)));
    if (all(lessThan(place, imageSize(few_positions)))) {
        imageStore(few_positions, place, there ? gbuffer_position_texel(pixel) : vec4(0.0));
        imageStore(few_normals, place, there ? gbuffer_normal_texel(pixel) : vec4(0.0));
    }
}
)";

/// Sums hold w V and, behind it, w.
VkFormat sums_format(uint channels) {
    return channels == 1 ? VK_FORMAT_R32G32_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

std::string sums_text(uint channels) {
    return channels_text(channels) +
           (channels == 1 ? "#define GN_SUM(v) vec4(v, 1.0, 0.0, 0.0)\n#define GN_SUM_WEIGHT(sum) (sum).g\n"
                          : "#define GN_SUM(v) vec4(v, 1.0)\n#define GN_SUM_WEIGHT(sum) (sum).a\n");
}

/// The light part's functions; of V with three channels pieces are summed.
std::string part_text(const Part& part, uint channels) {
    return include_line(part.glsl) + (channels == 1 ? "" : "#undef GN_LIGHT_FUSION\n");
}

std::uint32_t of_lattice(std::uint32_t pixels, const PixelLattice& lattice) {
    const auto step = static_cast<std::uint32_t>(lattice.step);
    return (pixels + step - 1) / step;
}

/// A pass over the view samples of a lattice; its shader has u.view and what `inputs` adds, and `prologue` composes what
/// stands before them.
template <class Prologue>
void add_pass(const FrameInput& input, const char* name, const PixelLattice& lattice, ShaderInputs inputs,
              Prologue prologue, const std::string& text) {
    inputs.constant("GnViewConstants", "view", input.samples.constants)
        .constant("ivec2", "first", lattice.first)
        .constant("int", "step", lattice.step);
    add_gbuffer(inputs, input.device, input.samples);
    const auto shader = compute_once(input.prepared, name, hashed(inputs), [&] {
        return expect_text(input.device) + include_line("shadow/view/view.glsl") + prologue() + inputs.text() + text;
    });
    input.graph.add_pass(
        name, [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, shader,
         size =
             uvec2(of_lattice(input.samples.width, lattice), of_lattice(input.samples.height, lattice))](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch_pixels(size.x, size.y);
        });
}

/// Positions and normals of a lattice's samples. Nobody draws into them: they have no depth and no material.
ViewSamples create_few(const FrameInput& input, const PixelLattice& lattice) {
    ViewSamples few{.width = of_lattice(input.samples.width, lattice),
                    .height = of_lattice(input.samples.height, lattice),
                    .camera = input.samples.camera,
                    .constants = input.samples.constants};
    few.constants.size = uvec4(few.width, few.height, 0, 0);
    for (const auto& [texture, name] : {std::pair{&few.position, "few positions"}, {&few.normal, "few normals"}}) {
        *texture = input.graph.create(
            {.name = name, .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = few.width, .height = few.height});
    }
    return few;
}

void add_gather(const FrameInput& input, const PixelLattice& lattice, const ViewSamples& few) {
    ShaderInputs inputs;
    inputs.image("rgba32f", "writeonly", "image2D", "few_positions", few.position);
    inputs.image("rgba32f", "writeonly", "image2D", "few_normals", few.normal);
    add_pass(
        input, "light: gather", lattice, std::move(inputs), [] { return std::string(); }, gather_text);
}

/// Whether lookups can give V of some samples alone: nothing else makes V, and positions and normals are all they read.
bool looks_at_few(const Recipe& recipe) {
    return recipe.lookup != nullptr && recipe.direct == nullptr && recipe.translucent_map == nullptr &&
           recipe.casters != Casters::ids;
}

/// One of the lights that serve another.
struct Turn {
    int index = 0, count = 1;
    PixelLattice lattice;
    bool begins = true;  ///< no light before it was for these pixels
};

void add_one(const FrameInput& one, const Recipe& recipe, const Turn& turn, TextureHandle visibility,
             TextureHandle sums) {
    const Part& part = *recipe.light;
    ShaderInputs inputs;
    inputs.constant("GnLight", "light", one.whole_light().shape)
        .constant("GnLight", "one", one.light().shape)
        .constant("int", "index", turn.index)
        .constant("int", "count", turn.count)
        .constant("int", "begins", turn.begins ? 1 : 0)
        .constant("int", "few", one.few != nullptr ? 1 : 0);
    inputs.constant_bytes(part.params_type, "params", recipe.block(part).bytes());
    inputs.texture("sampler2D", "visibility", visibility);
    const uint channels = channels_of(one.graph, visibility);
    inputs.image(image_format(sums_format(channels)), "", "image2D", "sums", sums);
    const auto prologue = [&] {
        return sums_text(channels) + part_text(part, channels) +
               fmt::format(
                   "#define GN_WEIGHT(light, one, p_ws, pixel, index, count) "
                   "gn_{}_weight(light, one, p_ws, pixel, index, count, u.params)\n",
                   identifier(part.id));
    };
    add_pass(one, "light: add", turn.lattice, std::move(inputs), prologue,
             std::string(fusion_text) + begin_text + add_text);
}

}  // namespace

Visibility add_weighted(const FrameInput& input, const Recipe& recipe,
                        const std::function<Visibility(const FrameInput&)>& serve) {
    return recipe.light->add_light != nullptr
               ? recipe.light->add_light(input, recipe, serve)
               : add_weighted(input, recipe, recipe.light->split(input.light(), recipe), serve);
}

Visibility add_weighted(const FrameInput& input, const Recipe& recipe, std::vector<Light> given,
                        const std::function<Visibility(const FrameInput&)>& serve, const WatchLight& watch) {
    FrameGraph& graph = input.graph;
    const auto lights = std::make_shared<const std::vector<Light>>(std::move(given));
    GN_CHECK(!lights->empty());
    const auto turn_of = [&, count = static_cast<int>(lights->size())](int index) {
        const auto lattice = [&](int i) {
            return recipe.light->pixels != nullptr ? recipe.light->pixels(i, count, recipe) : PixelLattice{};
        };
        return Turn{index, count, lattice(index), index == 0 || lattice(index - 1) != lattice(index)};
    };
    // Samples that lookups are given alone, where a light is for some pixels.
    const auto few = std::make_shared<ViewSamples>();
    const bool looks = looks_at_few(recipe) && turn_of(0).lattice.step > 1;
    if (looks) {
        *few = create_few(input, turn_of(0).lattice);
    }

    // Serve light after light, each with what the one before has done with.
    TextureHandle sums;
    uint channels = 1;
    const RoundsScope rounds(graph);
    for (std::size_t i = 0; i < lights->size(); ++i) {
        rounds.next();
        const Turn turn = turn_of(static_cast<int>(i));
        FrameInput one = input;
        one.source = &lights->at(i);
        one.parent = &input.light();
        one.history = nullptr;
        one.few = looks ? few.get() : nullptr;
        if (looks && turn.begins) {
            add_gather(input, turn.lattice, *few);
        }
        const Visibility served = serve(one);
        if (!sums.valid()) {
            channels = channels_of(graph, served.image);
            sums = graph.create({.name = "light sums",
                                 .format = sums_format(channels),
                                 .width = input.samples.width,
                                 .height = input.samples.height});
        }
        add_one(one, recipe, turn, served.image, sums);
        if (watch) {
            watch(one, turn.index, served);
        }
    }
    rounds.end();

    // Passes point to the lights: they live as long as the graph.
    graph.hold(lights);
    graph.hold(few);
    Visibility result{create_visibility(graph, input.samples, channels)};
    ShaderInputs inputs;
    inputs.constant("GnLight", "light", input.whole_light().shape)
        .constant_bytes(recipe.light->params_type, "params", recipe.block(*recipe.light).bytes());
    inputs.image(image_format(sums_format(channels)), "readonly", "image2D", "sums", sums);
    inputs.image(image_format(visibility_format(channels)), "writeonly", "image2D", "visibility", result.image);
    add_pass(
        input, "light: mean", {}, std::move(inputs),
        [&] { return sums_text(channels) + part_text(*recipe.light, channels); },
        std::string(fusion_text) + begin_text + mean_text);
    return result;
}

std::string refuses_one_centre(const Light& light, const Recipe& recipe) {
    if (recipe.map != nullptr && recipe.placement != nullptr && recipe.placement->from_centre &&
        light.shape.kind == GN_LIGHT_SPOT) {
        return fmt::format(
            "placement '{}' sees the cone of light '{}' from its centre, and light '{}' looks from other points too; "
            "use placement=fit or cube",
            recipe.placement->id, light.name, recipe.light->id);
    }
    return {};
}

}  // namespace gn
