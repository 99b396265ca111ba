// SPDX-License-Identifier: MIT
#include "shadow/casters/solids.h"

#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/edges.h"
#include "shadow/scene/casting.h"

namespace gn {
namespace {

// An object whose solids are mixed finer than this is drawn whole.
constexpr std::size_t most_runs = 64;

int facing_of(const Component& component) {
    // The back of a one-sided triangle is not there to cast.
    const bool inwards = component.outward < 0;
    return !component.closed || (inwards && component.one_sided) ? 0 : component.outward;
}

std::vector<SolidRun> runs_of(const Object& object, const EdgeList& edges) {
    std::vector<SolidRun> runs;
    std::uint32_t last = EdgeList::no_component;
    for (std::uint32_t t = object.first_triangle; t < object.first_triangle + object.triangle_count; ++t) {
        const std::uint32_t own = edges.component_of[t];
        if (runs.empty() || own != last) {
            runs.push_back({t, 0});
            if (own != EdgeList::no_component) {
                runs.back().outward = facing_of(edges.components[own]);
                runs.back().bounds_ws = edges.components[own].bounds_ws;
            }
            last = own;
        }
        ++runs.back().count;
    }
    return runs.size() <= most_runs ? runs : std::vector<SolidRun>{{object.first_triangle, object.triangle_count}};
}

Solids find_solids(const Scene& scene, const std::vector<CasterKind>& kinds) {
    std::vector<std::uint8_t> casts(scene.triangles.size(), casts_nothing);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const auto opaque = is_single_sided(scene, object) ? casts_from_its_front : casts_from_both_sides;
        std::fill_n(casts.begin() + object.first_triangle, object.triangle_count,
                    kinds[i] == CasterKind::opaque ? opaque : casts_nothing);
    }
    const EdgeList edges = build_edges(scene.positions_ws, scene.triangles, casts);
    Solids solids;
    for (const Object& object : scene.objects) {
        solids.push_back(runs_of(object, edges));
    }
    return solids;
}

void append(std::vector<DrawRange>& ranges, const SolidRun& run) {
    if (!ranges.empty() && ranges.back().first_index + ranges.back().index_count == run.first * 3) {
        ranges.back().index_count += run.count * 3;
    } else {
        ranges.push_back({run.first * 3, run.count * 3});
    }
}

}  // namespace

std::shared_ptr<const Solids> solids_of(const FrameInput& input) {
    if (input.scene.positions_ws.empty()) {
        return nullptr;
    }
    const std::vector<CasterKind> kinds = caster_kinds(input);
    return input.derive("solids", casters_key(input.scene, kinds), [&] { return find_solids(input.scene, kinds); });
}

SolidFaces solid_faces(const Scene& scene, const Solids& solids, std::span<const std::uint32_t> objects,
                       const GnLight& light) {
    const vec4 light_ws = light_point_ws(light);
    SolidFaces faces;
    for (const std::uint32_t index : objects) {
        if (is_masked(scene, scene.objects[index])) {
            continue;
        }
        for (const SolidRun& run : solids[index]) {
            const bool inside = light_ws.w > 0 && run.outward != 0 && run.bounds_ws.contains(vec3(light_ws));
            append(inside || run.outward == 0 ? faces.both : run.outward > 0 ? faces.front : faces.back, run);
        }
    }
    return faces;
}

}  // namespace gn
