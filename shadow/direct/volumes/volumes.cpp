// SPDX-License-Identifier: MIT
// Based on: Everitt, Kilgard. Practical and Robust Stenciled Shadow Volumes for Hardware-Accelerated Rendering. 2002. [EK02]
// Based on: Kim, Kim, Turk. A Shadow-Volume Algorithm for Opaque and Transparent Nonmanifold Casters. JGT 2008. [KKJ08]
// Departs from it: silhouettes are found by a compute pass; a component that bounds a solid keeps the cheaper
// form of [EK02], all others take the general one of [KKJ08]; caps are ordered by what the view samples know
// (volumes.md).
//
// Also here: volumes_culling_test.cpp, volumes_modes_test.cpp, volumes_random_test.cpp, volumes_scenes_test.cpp. The passes stand in shadow/geometry.
#include "shadow/direct/volumes/volumes.h"

#include "shadow/geometry/draw.h"
#include "shadow/geometry/volume_passes.h"
#include "shadow/scene/casting.h"
#include "shadow/scene/simplifier.h"

namespace gn::parts::volumes {
namespace {

VolumeOptions options_of(const GnVolumesParams& params) {
    constexpr std::array modes{VolumeMode::behind, VolumeMode::before, VolumeMode::capped, VolumeMode::cheapest};
    return {.mode = modes.at(static_cast<std::size_t>(params.mode)),
            .every_side = params.extrude == GN_VOLUMES_BRUTE_FORCE,
            .skip_masked = params.masked != GN_VOLUMES_OPAQUE,
            .closed = params.closed != 0,
            .culling = params.culling != 0,
            .clamp = params.clamp != 0,
            .slices = params.slices != 0,
            // Where the camera is in shadow z-pass errs by how many volumes hold it: none is left out that would.
            .covered = params.covered != 0 && params.mode != GN_VOLUMES_Z_PASS,
            .proxies = params.proxies};
}

Visibility add_volumes(const FrameInput& input, const Recipe& recipe) {
    const auto params = recipe.of<GnVolumesParams>("volumes");
    const VolumeBuffers buffers = import_volume_buffers(input, options_of(params));
    add_facing(input, buffers);
    add_silhouettes(input, buffers);
    const TextureHandle receivers = add_receivers(input, buffers);
    const TextureHandle counts = add_counts(input, buffers, receivers);
    Visibility visibility = add_count_resolve(input, counts, {.masked = params.masked == GN_VOLUMES_EXACT});
    add_volume_sides(input, buffers, receivers, counts, visibility);
    return visibility;
}

std::string remark(const Scene& scene, const Recipe& recipe) {
    const auto params = recipe.of<GnVolumesParams>("volumes");
    std::string said;
    if (params.mode == GN_VOLUMES_Z_PASS) {
        said = "volumes.mode=z-pass is wrong wherever a shadow falls on the camera's near rectangle (auto is right)";
    }
    bool masked = false;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        masked = masked || (is_masked(scene, scene.objects[i]) && casts(scene, i, nullptr));
    }
    if (masked && params.masked != GN_VOLUMES_EXACT) {
        said += said.empty() ? "" : "; ";
        said +=
            params.masked == GN_VOLUMES_OPAQUE
                ? "volumes.masked=opaque: the masked polygons of this scene cast as a whole (exact reads their alpha)"
                : "volumes.masked=skip: the masked polygons of this scene cast nothing (exact reads their alpha)";
    }
    if (params.proxies > 0) {
        said += said.empty() ? "" : "; ";
        said += "volumes.proxies: solids cast the shadows of simpler bodies, which end too early (0 casts the solids)";
    }
    return said;
}

std::string refuses(const Scene& /*scene*/, const Light& /*light*/, const Recipe& recipe) {
    return recipe.of<GnVolumesParams>("volumes").proxies > 0 && simplifier() == nullptr
               ? "volumes.proxies needs a library that simplifies meshes, which this program does not link "
                 "(gnomon::gn_shadow does); 0 casts the solids themselves"
               : "";
}

}  // namespace
}  // namespace gn::parts::volumes

namespace gn::parts {

const Part& direct_volumes() {
    using namespace volumes;
    static const Part part = [] {
        Part p;
        p.id = "volumes";
        p.stage = Stage::direct;
        p.title = "Shadow volumes";
        p.citation = "EK02";
        p.features = {Feature::float32_blend};
        p.needs_scene = true;
        p.sides = volume_sides();
        p.params = param_table<GnVolumesParams>({
            GN_CHOICE(GnVolumesParams, mode,
                      "Counts behind the samples (right anywhere), before them (cheaper, wrong where the camera is in "
                      "shadow), before them with volumes closed at the near plane, or by each component's place.",
                      "z-fail", "z-pass", "zp+", "auto"),
            GN_CHOICE(GnVolumesParams, extrude,
                      "Volumes of silhouettes, or of every triangle by itself: the same picture, many times the fill.",
                      "silhouette", "brute-force"),
            GN_CHOICE(
                GnVolumesParams, masked,
                "Masked polygons: asked for their alpha by each sample that they may hide, whole (cheaper), or not "
                "at all.",
                "exact", "opaque", "skip"),
            GN_PARAM(GnVolumesParams, closed, boolean, 0, 1, "",
                     "Solids cast with the half of their surface that light meets first; off counts every triangle."),
            GN_PARAM(GnVolumesParams, clamp, boolean, 0, 1, "",
                     "Ends volumes that are counted before the samples where no sample is beyond; off lets them run on "
                     "without end."),
            GN_PARAM(GnVolumesParams, slices, boolean, 0, 1, "",
                     "Cuts them by rows and columns of the picture too, where no sample between can be in them."),
            GN_PARAM(GnVolumesParams, culling, boolean, 0, 1, "",
                     "Leaves out components whose shadow neither the light nor the view can show; off draws them all."),
            GN_PARAM(
                GnVolumesParams, covered, boolean, 0, 1, "",
                "Leaves out components that another hides from the light whole; off draws volumes within volumes."),
            GN_PARAM(GnVolumesParams, proxies, real, 0, 0.99, "",
                     "Share of their triangles with which solids cast, as simpler bodies within them: fewer sides, "
                     "shadows a little too small; 0 casts the solids."),
        });
        p.params_type = "GnVolumesParams";
        p.glsl = "shadow/geometry/volumes.glsl";
        p.add_direct = add_volumes;
        p.remark = remark;
        p.refuses = refuses;
        return p;
    }();
    return part;
}

}  // namespace gn::parts
