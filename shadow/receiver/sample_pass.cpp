// SPDX-License-Identifier: MIT
#include "shadow/receiver/sample_pass.h"

#include "shadow/placement/receivers.h"

#include <algorithm>

namespace gn {
namespace {

constexpr const char* bindings_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D gbuffer_position;
layout(binding = 1) uniform sampler2D gbuffer_normal;
#ifdef GN_VIEW_COUNT
layout(binding = 2, scalar) uniform Views { GnLightView views[GN_VIEW_COUNT]; };
#else
layout(binding = 2, scalar) readonly buffer Views { GnLightView views[]; };
#endif
layout(binding = 3, scalar) uniform Placement { GnPlacementData placement; };
layout(binding = 7, scalar) uniform Constants {
    GnViewConstants view;
    GnLight light;
    GnBias bias;
)";

constexpr const char* read_text = R"(
bool read_sample(ivec2 pixel, out GnReceiver receiver) {
    vec4 position = texelFetch(gbuffer_position, pixel, 0);
    vec4 normal = texelFetch(gbuffer_normal, pixel, 0);
    if (position.w < 0.5 || !gn_counted(u.light, position.xyz, normal.xyz)) {
        return false;
    }
    receiver = gn_receiver(u.view, pixel, position, normal);
    return true;
}
)";

}  // namespace

std::string include_line(std::string_view path) {
    return path.empty() ? "" : fmt::format("#include \"{}\"\n", path);
}

std::string sample_bindings(std::string_view members) {
    return fmt::format("{}    {}\n}} u;\n", bindings_text, members);
}

std::string sample_functions(const Part& placement) {
    return fmt::format("#define GN_CHOOSE gn_{}_choose\n{}", identifier(placement.id), read_text);
}

std::string receiver_defines(const Recipe& recipe, const LightViews& views) {
    const bool affine = std::all_of(views.views.begin(), views.views.end(), [](const GnLightView& view) {
        const mat4& m = view.cs_from_ws;
        return view.paraboloid == 0 && vec4(m[0].w, m[1].w, m[2].w, m[3].w) == vec4(0, 0, 0, 1);
    });
    // Uniform blocks of this many views fit every device; what is uniform is read once for many pixels.
    constexpr std::size_t most_uniform = 16384 / sizeof(GnLightView);
    const std::size_t count = views.views.size();
    return fmt::format("#define GN_BIAS_CONE {:d}\n#define GN_BIAS_PLANE {}\n#define GN_AFFINE_VIEWS {:d}\n",
                       recipe.bias.cone > 0, recipe.bias.receiver_plane != 0, affine) +
           (count <= most_uniform ? fmt::format("#define GN_VIEW_COUNT {}\n", count) : "");
}

GnBias applied_bias(const Recipe& recipe) {
    // A guard holds two texels beyond the kernel: the receiver's own, and the one that a tap falls into.
    const Guard guard = guard_of(recipe);
    GnBias bias = recipe.bias;
    bias.reach = std::max(0.0F, guard.texels - 2);
    bias.reach_world = guard.metres;
    bias.reach_pixels = guard.pixels;
    return bias;
}

std::vector<std::byte> sample_constants(const FrameInput& input, const Recipe& recipe) {
    std::vector<std::byte> bytes;
    const auto append = [&bytes](const auto& value) {
        const auto more = std::as_bytes(std::span(&value, 1));
        bytes.insert(bytes.end(), more.begin(), more.end());
    };
    append(input.samples.constants);
    append(input.light().shape);
    append(applied_bias(recipe));
    return bytes;
}

void declare_samples(PassBuilder& pass, const ViewSamples& samples, const LightViews& views) {
    pass.sample(samples.position);
    pass.sample(samples.normal);
    declare_views(pass, views);
}

void set_samples(Recorder& r, const ViewSamples& samples, const LightViews& views) {
    r.set("gbuffer_position", samples.position);
    r.set("gbuffer_normal", samples.normal);
    set_views(r, views);
}

void declare_views(PassBuilder& pass, const LightViews& views) {
    for (const BufferHandle buffer : {views.buffer, views.data_buffer}) {
        if (buffer.valid()) {
            pass.storage_read(buffer);
        }
    }
}

void set_views(Recorder& r, const LightViews& views) {
    if (views.buffer.valid()) {
        r.set("Views", views.buffer);
    } else {
        r.set_bytes("Views", std::as_bytes(std::span(views.views)));
    }
    if (views.data_buffer.valid()) {
        r.set("Placement", views.data_buffer);
    } else {
        r.set_value("Placement", views.data);
    }
}

}  // namespace gn
