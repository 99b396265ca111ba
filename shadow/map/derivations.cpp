// SPDX-License-Identifier: MIT
// The names by which lookups ask for what is made of a map.
#include "shadow/casters/peel.h"
#include "shadow/casters/slices.h"
#include "shadow/map/derived.h"
#include "shadow/map/steps.h"
#include "shadow/map/sums.h"
#include "shadow/receiver/map_range.glsl"
#include "shadow/recipe/part.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace gn {
namespace {

TextureHandle add_sums(const DerivedFrom& from) {
    return add_sat(from.input.graph, from.source, {.table = GN_SAT_FLOAT32}, from.input.prepared);
}

TextureHandle add_all_mips(const DerivedFrom& from) {
    return add_mipmapped(from.input.graph, from.source);
}

TextureHandle slices_of(const DerivedFrom& from) {
    return add_slices(from.input, from.recipe, from.views, from.count);
}

constexpr std::array<Derivation, 15> all_derivations{{
    {"min-max", "depth", "A pyramid of least and greatest depths.", 0, false,
     [](const DerivedFrom& from) { return add_min_max_pyramid(from.input.graph, from.source); }},
    {"block-min-max", "depth", "The same from blocks of 8 x 8 texels on.", 0, false,
     [](const DerivedFrom& from) { return add_min_max_pyramid(from.input.graph, from.source, glsl::gn_coarse_mip); }},
    {"lower-planes", "depth", "Planes before all depths of blocks of 8 x 8 texels and of larger ones.", 0, false,
     [](const DerivedFrom& from) { return add_lower_planes(from.input.graph, from.source); }},
    {"n-buffers", "depth", "Least and greatest depths of any square of 2^l texels.", 0, false,
     [](const DerivedFrom& from) { return add_n_buffer(from.input.graph, from.source, NBuffer::min_max); }},
    {"coarse-n-buffers", "min-max", "The same of any square of 2^l blocks of 8 texels.", 0, false,
     [](const DerivedFrom& from) {
         return add_n_buffer(from.input.graph, from.source, NBuffer::ranges, 16, glsl::gn_coarse_mip);
     }},
    {"mean-n-buffers", "moments", "Means of any square of 2^l texels.", 0, false,
     [](const DerivedFrom& from) { return add_n_buffer(from.input.graph, from.source, NBuffer::mean); }},
    {"summed-depths", "depth", "A table of sums, which answers with the mean depth of any rectangle of texels.", 0,
     false, add_sums},
    {"summed-moments", "moments", "A table of sums, which answers with the mean of any rectangle of texels.", 0, false,
     add_sums},
    {"mip-depths", "depth", "Depths with all mips.", 0, true, add_all_mips},
    {"mip-moments", "moments", "Moments with all mips.", 0, true, add_all_mips},
    {"steps-", "depth", "Where the nearest texel lies that stands behind a step of depth, up to so many texels away.",
     128, false, [](const DerivedFrom& from) { return add_steps(from.input.graph, from.source, from.count); }},
    {"slice-n-buffers-", "depth", "How much of any square of 2^l texels so many slices of the scene cover.",
     most_slices, true,
     [](const DerivedFrom& from) { return add_n_buffer(from.input.graph, slices_of(from), NBuffer::mean); }},
    {"summed-slices-", "depth", "Tables of sums of what so many slices of the scene cover.", most_slices, false,
     [](const DerivedFrom& from) {
         return add_sat(from.input.graph, slices_of(from), {.table = GN_SAT_FLOAT32}, from.input.prepared);
     }},
    {"mip-slices-", "depth", "What so many slices of the scene cover, with all mips.", most_slices, true,
     [](const DerivedFrom& from) { return add_mipmapped(from.input.graph, slices_of(from)); }},
    {"peeled-", "depth", "The nearest surfaces under each texel, nearest first.", most_peeled, false,
     [](const DerivedFrom& from) { return add_peeled(from.input, from.recipe, from.views, from.count); }},
}};

/// A derivation by the name that a lookup asks with, and the number that ends it: "peeled-4" asks for 4.
struct Asked {
    const Derivation* derivation = nullptr;
    int count = 0;
};

Asked asked(std::string_view name) {
    for (const Derivation& d : all_derivations) {
        if (d.most == 0 && d.name == name) {
            return {&d, 0};
        }
        if (d.most == 0 || !name.starts_with(d.name)) {
            continue;
        }
        int count = 0;
        const char* const end = name.data() + name.size();
        const auto read = std::from_chars(name.data() + d.name.size(), end, count);
        if (read.ec == std::errc() && read.ptr == end && count >= 1 && count <= d.most) {
            return {&d, count};
        }
    }
    return {};
}

/// Whether the device's blits and samplers filter the texture's texels.
bool filters(const Device& device, const TextureDesc& desc) {
    const bool float32 =
        is_depth(desc.format) || format_bytes(desc.format) / static_cast<VkDeviceSize>(channels_of(desc.format)) == 4;
    return !float32 || device.has(Feature::float32_filter);
}

}  // namespace

std::span<const Derivation> derivations() {
    return all_derivations;
}

bool map_gives(const Part& map, std::string_view need) {
    const Derivation* derived = asked(need).derivation;
    return holds(map.gives, need) || (derived != nullptr && map_gives(map, derived->from));
}

void add_derived(const FrameInput& input, const Recipe& recipe, const LightViews& views, ShadowMap& map) {
    for (const std::string_view need : needs_of(recipe)) {
        const auto [derivation, count] = asked(need);
        const Offer* from = derivation != nullptr ? map.find(derivation->from) : nullptr;
        if (from == nullptr || map.find(need) != nullptr) {
            continue;
        }
        const TextureHandle texture = derivation->add({input, recipe, views, from->texture, count});
        if (derivation->filters && !filters(input.device, input.graph.desc(texture))) {
            refuse("lookup '{}' reads {}, which needs the feature {}, which device '{}' lacks", recipe.lookup->id, need,
                   feature_name(Feature::float32_filter), input.device.info().name);
        }
        map.offers.push_back({std::string(need), texture, derivation->filters ? trilinear() : nearest()});
    }
}

}  // namespace gn
