// SPDX-License-Identifier: MIT
#include "shadow/casters/kept_map.h"

#include "gpu/hash.h"
#include "shadow/casters/moved.h"
#include "shadow/frame/history.h"
#include "shadow/scene/casting.h"

#include <algorithm>

namespace gn {
namespace {

/// What a frame left: of what the map is made, and where its offers live.
struct KeptMap {
    Fingerprint of;
    std::vector<TextureDesc> textures;
};

bool can_be_kept(const FrameInput& input, const LightViews& views) {
    const bool still = !views.buffer.valid() && !views.data_buffer.valid() && !views.kept.has_value();
    return still && input.history != nullptr && input.parent == nullptr && input.handles.version != 0;
}

template <class T>
void add(Hasher& hasher, std::span<const T> values) {
    hasher.bytes(values.data(), values.size_bytes());
}

void add_views(Hasher& hasher, const LightViews& views) {
    add(hasher, std::span(views.views));
    hasher.value(views.kind).value(views.resolution).value(views.layers).value(views.layered);
    hasher.value(views.casters.size());
    for (const std::vector<std::uint32_t>& casters : views.casters) {
        add(hasher, std::span(casters));
    }
}

/// All parameters: who would tell those that a map reads from the others draws it too seldom some day.
void add_recipe(Hasher& hasher, const Recipe& recipe) {
    hasher.text(recipe.map->id).text(recipe.lookup->id).value(recipe.casters).value(recipe.resolution);
    add(hasher, std::span<const GnBias>(&recipe.bias, 1));
    for (const auto& [id, block] : recipe.params) {
        add(hasher, block.bytes());
    }
}

Fingerprint made_of(const FrameInput& input, const Recipe& recipe, const LightViews& views) {
    const GnLight shape = shadow_shape(input.light());
    const Fingerprint casting = casting_of(input.scene, input.light());
    Hasher hasher;
    hasher.value(input.handles.version).value(input.translucent).value(casting.low).value(casting.high);
    add(hasher, std::span<const GnLight>(&shape, 1));
    add_views(hasher, views);
    add_recipe(hasher, recipe);
    return hasher.finish();
}

/// Whether a frame before left just this, and all of it is still there.
bool is_kept(const FrameInput& input, const KeptMap* kept, const Fingerprint& of) {
    bool fresh = kept == nullptr || kept->of != of || kept->textures.empty();
    for (std::size_t i = 0; !fresh && i < kept->textures.size(); ++i) {
        static_cast<void>(input.history->texture(kept->textures[i], fresh));
    }
    return !fresh;
}

/// Lets a map's textures live in the history.
KeptMap leave(const FrameInput& input, const std::string& name, const Fingerprint& of, const ShadowMap& map) {
    KeptMap kept{of, {}};
    for (const Offer& offer : map.offers) {
        if (!input.graph.imported(offer.texture)) {
            input.graph.place(offer.texture, [&](const TextureDesc& wanted) -> Texture2D& {
                TextureDesc desc = wanted;
                desc.name = fmt::format("{} {}", name, offer.name);
                bool fresh = false;
                return input.history->texture(desc, fresh);
            });
        }
        kept.textures.push_back(input.graph.desc(offer.texture));
    }
    return kept;
}

/// The map's passes are declared in every frame, so that frames that draw it and frames that find it have one plan.
ShadowMap drawn_unless(bool kept, FrameGraph& graph, const std::function<ShadowMap()>& draw) {
    struct Rest {
        FrameGraph& graph;
        ~Rest() { graph.rest(false); }
    } const rest{graph};
    graph.rest(kept);
    return draw();
}

}  // namespace

Fingerprint casting_of(const Scene& scene, const Light& light) {
    Hasher hasher;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Material& material = scene.materials[static_cast<std::size_t>(scene.objects[i].material)];
        hasher.value(caster_class(scene, i, &light)).value(material.double_sided).value(material.alpha_mode);
        hasher.value(material.alpha_cutoff).value(material.base_color.a).value(material.base_color_texture);
        const vec3 through = transmittance(material);
        hasher.value(through.r).value(through.g).value(through.b);
    }
    return hasher.finish();
}

ShadowMap add_kept_map(const FrameInput& input, const Recipe& recipe, const LightViews& views,
                       const std::function<ShadowMap()>& draw) {
    if (!can_be_kept(input, views)) {
        return draw();
    }
    const std::string name = fmt::format("map of light {} {} {}{}", input.light_id, recipe.name, recipe.map->id,
                                         input.translucent ? " translucent" : "");
    const Fingerprint of = made_of(input, recipe, views);
    ShadowMap map = drawn_unless(is_kept(input, input.history->before<KeptMap>(name), of), input.graph, draw);
    const bool alone = std::none_of(map.offers.begin(), map.offers.end(),
                                    [&](const Offer& offer) { return input.graph.imported(offer.texture); });
    // What lives elsewhere already follows earlier frames by itself.
    input.history->leave(name, alone ? leave(input, name, of, map) : KeptMap{});
    return map;
}

}  // namespace gn
