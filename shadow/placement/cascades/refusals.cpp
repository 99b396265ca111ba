// SPDX-License-Identifier: MIT
// What cascades cannot do, a sentence each.
#include "shadow/geometry/visible_objects.h"
#include "shadow/placement/cascades/cascade_views.h"
#include "shadow/placement/cascades/cascades.glsl"
#include "shadow/scene/simplifier.h"

#include <algorithm>
#include <bit>

namespace gn::cascades {
namespace {

/// Smaller maps must be whole squares with room for a kernel.
std::string refuses_falloff(const Scene& scene, const Light& light, const Recipe& recipe,
                            const GnCascadesParams& params) {
    const int last = params.falloff < 0 ? 0 : params.count - 1;
    const int most = glsl::gn_cascades_halvings(last, params.count, params.falloff);
    if (most == 0) {
        return {};
    }
    const int side = recipe.resolution >> most;
    const Guard guard = guard_of(recipe, light, scene.bounds_ws);
    const int least = std::max(16, static_cast<int>(std::ceil(6 * guard.texels)));
    if (side < least || recipe.resolution % (1 << most) != 0) {
        return fmt::format(
            "cascades.falloff={} gives the smallest of {} maps {} texels a side; whole squares of {} or more are "
            "needed: use a resolution that is a multiple of {}, {} or more, or less falloff",
            params.falloff, params.count, static_cast<float>(recipe.resolution) / static_cast<float>(1 << most), least,
            1 << most, least << most);
    }
    if (params.passes == GN_PASSES_LAYERED) {
        return "cascades.passes=layered draws each map into a whole layer, and cascades.falloff puts several into one; "
               "use cascades.passes=auto or separate";
    }
    if (params.scroll != 0 || params.rate > 1) {
        return "cascades.scroll and cascades.rate keep whole layers, and cascades.falloff puts several maps into one; "
               "use cascades.falloff=0";
    }
    return {};
}

/// What is left out is never read by a kernel that the recipe's guard tells of.
std::string refuses_mask(const Scene& scene, const Light& light, const Recipe& recipe, const GnCascadesParams& params) {
    if (params.mask == 0) {
        return {};
    }
    if (by_samples(params) || params.scroll != 0 || params.rate > 1) {
        return "cascades.mask asks what is seen of each slice in this frame, which splits by samples make on the "
               "device, "
               "and cascades.scroll and cascades.rate keep maps for other frames; use cascades.mask=0, or none of them";
    }
    if (params.fit == GN_FIT_WARPED) {
        return "cascades.mask measures kernels by the texels of a map, which are of one size on plain, fitted and "
               "stable "
               "maps alone; use one of these for cascades.fit";
    }
    if (!knows_what_is_seen(scene)) {
        return "cascades.mask asks which objects the camera sees, which a renderer that lends its casters does not "
               "say; "
               "use cascades.mask=0";
    }
    if (recipe.direct != nullptr || recipe.lookup == nullptr || recipe.translucent_map != nullptr) {
        return "cascades.mask leaves out what the kernels of one lookup never read, and this recipe has a direct part "
               "or "
               "a second map; use cascades.mask=0";
    }
    const std::vector<std::string_view> needs = needs_of(recipe);
    const bool plain = std::all_of(needs.begin(), needs.end(), [](std::string_view need) { return need == "depth"; });
    if (!plain || recipe.lookup->filters || guard_of(recipe, light, scene.bounds_ws).pixels > 0) {
        return fmt::format(
            "cascades.mask leaves out what lies beyond the kernel around every receiver, and lookup '{}' reads blurred "
            "maps, pyramids or footprints that reach farther; use lookup=hard or pcf, or cascades.mask=0",
            recipe.lookup->id);
    }
    return {};
}

/// Meshes are made once, for texels that keep their size.
std::string refuses_simpler(const Scene& scene, const GnCascadesParams& params) {
    if (params.simpler == 0) {
        return {};
    }
    if (by_samples(params) || params.fit != GN_FIT_STABLE || params.scroll != 0 || params.rate > 1) {
        return "cascades.simpler makes meshes for the texels of each map, which keep their size in stable windows that "
               "are "
               "drawn in every frame alone; use cascades.fit=stable, scroll=0 and rate=1 with a split other than "
               "sdsm-minmax and sdsm-histogram, or cascades.simpler=0";
    }
    if (params.passes == GN_PASSES_LAYERED) {
        return "cascades.passes=layered draws the same meshes into all maps, and cascades.simpler others into each; "
               "use "
               "cascades.passes=auto or separate";
    }
    if (!knows_what_is_seen(scene)) {
        return "cascades.simpler makes meshes of the scene's triangles, which a renderer that lends its casters keeps "
               "to "
               "itself; use cascades.simpler=0";
    }
    return simplifier() != nullptr
               ? ""
               : "cascades.simpler needs a library that simplifies meshes, and this program links none; use "
                 "cascades.simpler=0";
}

}  // namespace

std::string refuses(const Scene& scene, const Light& light, const Recipe& recipe) {
    const auto params = recipe.of<GnCascadesParams>("cascades");
    const bool kept = params.scroll != 0 || params.rate > 1;
    if (kept && (by_samples(params) || params.fit != GN_FIT_STABLE)) {
        return "cascades.scroll and cascades.rate keep maps over frames, which only stable windows allow; use "
               "cascades.fit=stable with a split other than sdsm-minmax and sdsm-histogram";
    }
    if (const std::string why = refuses_falloff(scene, light, recipe, params); !why.empty()) {
        return why;
    }
    if (const std::string why = refuses_mask(scene, light, recipe, params); !why.empty()) {
        return why;
    }
    if (const std::string why = refuses_simpler(scene, params); !why.empty()) {
        return why;
    }
    if (params.least_caster > 0 && by_samples(params)) {
        return "cascades.least_caster measures casters by the texels of a map, which splits by samples make on the "
               "device; use "
               "another cascades.split than sdsm-minmax and sdsm-histogram";
    }
    if (params.far == GN_FAR_OBJECTS && by_samples(params)) {
        return "cascades.far=objects ends the last slice by the bounds of objects, and splits by samples end at the "
               "farthest sample by themselves; use cascades.far=scene, or another cascades.split than sdsm-minmax and "
               "sdsm-histogram";
    }
    if (params.far == GN_FAR_OBJECTS && !knows_what_is_seen(scene)) {
        return "cascades.far=objects asks which objects the camera sees, which a renderer that lends its casters does "
               "not say; use cascades.far=scene";
    }
    if (params.fit == GN_FIT_WARPED && !by_samples(params) && params.select == GN_SELECT_PROJECTION) {
        return "cascades.select=projection asks which rectangle holds a receiver, and warped maps are none; use "
               "cascades.select=distance, or cascades.fit=plain, fitted or stable";
    }
    if (kept && params.snap == 0) {
        return "cascades.scroll and cascades.rate keep maps over frames, which only windows on whole texels allow; use "
               "cascades.snap=1";
    }
    if (kept && !std::has_single_bit(static_cast<unsigned>(recipe.resolution))) {
        return fmt::format(
            "cascades.scroll and cascades.rate keep whole texels exactly only at a resolution that is a "
            "power of two, not {}; use {}",
            recipe.resolution, std::bit_ceil(static_cast<unsigned>(recipe.resolution)));
    }
    return {};
}

}  // namespace gn::cascades
