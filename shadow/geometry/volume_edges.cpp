// SPDX-License-Identifier: MIT
// What of a scene's casters volumes are made of, whatever light there is: kept as long as the geometry stays as it is.
#include "gpu/hash.h"
#include "gpu/upload.h"
#include "shadow/geometry/caster_geometry.h"
#include "shadow/geometry/caster_proxies.h"
#include "shadow/geometry/covered_components.h"
#include "shadow/geometry/volume_passes.h"
#include "shadow/scene/casting.h"

#include <algorithm>
#include <cmath>

namespace gn {

namespace {

// Which triangles cast, and which of them wear a mask.
struct Casters {
    std::vector<std::uint8_t> casts, masked;
};
Casters find_casters(const Scene& scene, const std::vector<CasterKind>& kinds, bool skip_masked) {
    Casters found{std::vector<std::uint8_t>(scene.triangles.size(), 0),
                  std::vector<std::uint8_t>(scene.triangles.size(), 0)};
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const bool masked = kinds[i] == CasterKind::masked;
        const auto first = scene.objects[i].first_triangle, end = first + scene.objects[i].triangle_count;
        const auto solid = is_single_sided(scene, scene.objects[i]) ? casts_from_its_front : casts_from_both_sides;
        std::fill(found.casts.begin() + first, found.casts.begin() + end,
                  kinds[i] == CasterKind::opaque || (masked && !skip_masked) ? solid : casts_nothing);
        std::fill(found.masked.begin() + first, found.masked.begin() + end, masked ? 1 : 0);
    }
    return found;
}

/// What casts instead of the scene's triangles.
ProxyMesh find_proxies(const Scene& scene, const Casters& found, float share) {
    const EdgeList list = build_edges(scene.positions_ws, scene.triangles, found.casts);
    return make_proxies({scene.positions_ws, scene.triangles, found.casts, found.masked, list}, share);
}

std::shared_ptr<const EdgeBuffers::Proxies> upload_proxies(Device& device, ProxyMesh mesh) {
    auto proxies = std::make_shared<EdgeBuffers::Proxies>();
    proxies->positions = upload(device, "volume proxy positions", mesh.positions_ws,
                                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    proxies->indices = upload(device, "volume proxy indices", mesh.triangles);
    proxies->mesh = std::move(mesh);
    return proxies;
}

EdgeBuffers make_edge_buffers(Device& device, const Scene& scene, const std::vector<CasterKind>& kinds,
                              const VolumeOptions& options) {
    EdgeBuffers made;
    Casters found = find_casters(scene, kinds, options.skip_masked);
    if (options.proxies > 0.0F) {
        made.proxies = upload_proxies(device, find_proxies(scene, found, options.proxies));
        const ProxyMesh& mesh = made.proxies->mesh;
        found = {mesh.casts, mesh.masked};
    }
    made.list = build_edges(made.positions_ws(scene), made.triangles(scene), found.casts);

    // A triangle's owner is its component, and how its caps are drawn. A body within a solid is never before a sample either; the back
    // of an open sheet may be (volumes.md).
    std::vector<std::uint32_t> owners(found.casts.size());
    for (std::size_t t = 0; t < owners.size(); ++t) {
        const std::uint32_t component = made.list.component_of[t];
        const std::uint32_t masked = found.masked[t];
        const std::uint32_t front = found.casts[t] == casts_from_its_front ? 1 : 0;
        const bool open = component != EdgeList::no_component && !made.list.components[component].closed;
        const std::uint32_t compared = masked | front | (open ? 1U : 0U);
        owners[t] = component == EdgeList::no_component ? ~0U : component * 8 + masked * 4 + front * 2 + compared;
        made.opaque_triangles += compared == 0 ? 1 : 0;
    }
    std::vector<vec4> boxes;
    for (const Component& component : made.list.components) {
        boxes.emplace_back(component.bounds_ws.min, 0.0F);
        boxes.emplace_back(component.bounds_ws.max, 0.0F);
    }
    made.casts = std::move(found.casts);
    made.edges = upload(device, "volume edges", made.list.edges);
    made.first = upload(device, "volume edge starts", made.list.first);
    made.around = upload(device, "volume edge triangles", made.list.around);
    made.owners = upload(device, "volume triangle owners", owners);
    made.boxes = upload(device, "volume component boxes", boxes);
    return made;
}

constexpr std::size_t most_kept = 256;

}  // namespace

std::shared_ptr<const EdgeBuffers> edge_buffers(const FrameInput& input, const VolumeOptions& options) {
    // Lights that the same objects cast for share the edges.
    const std::vector<CasterKind> kinds = caster_kinds(input);
    std::uint64_t key = casters_key(input.scene, kinds) * 2 + (options.skip_masked ? 1 : 0);
    if (options.proxies > 0.0F) {
        key = Hasher().value(key).value(options.proxies).finish().low;
    }
    auto buffers = input.derive(options.proxies > 0.0F ? "volume proxies" : "volume edges", key,
                                [&] { return make_edge_buffers(input.device, input.scene, kinds, options); });
    if (buffers->proxies && input.late_remarks != nullptr) {
        const ProxyMesh& mesh = buffers->proxies->mesh;
        input.late_remarks->insert(fmt::format(
            "volumes.proxies: {} of {} solids cast as simpler bodies within them, of {} triangles instead of {}",
            mesh.replaced, mesh.solids, mesh.triangles_after, mesh.triangles_before));
    }
    return buffers;
}

void leave_out_covered(const FrameInput& input, const EdgeBuffers& scene, const VolumeOptions& options,
                       std::span<std::uint32_t> forms) {
    if (scene.list.components.size() < 2) {
        return;
    }
    // What covers must do so by more than rounding moves an edge: a power of two, so that it seldom changes.
    const GnLight& light = input.light().shape;
    const vec4 light_ws = light_point_ws(light);
    const double margin = std::exp2(std::ceil(std::log2(rounding_metres(input))));
    const std::uint64_t key =
        Hasher().bytes(&light_ws, sizeof light_ws).value(options.closed).value(margin).finish().low;
    auto found = std::find_if(scene.covered.begin(), scene.covered.end(), [&](const auto& f) { return f.key == key; });
    if (found == scene.covered.end()) {
        const std::vector<std::uint32_t> whole =
            component_forms(scene.list.components, light, {.closed = options.closed, .culling = false}, nullptr);
        const CoverScene asked{scene.positions_ws(input.scene), scene.triangles(input.scene), scene.casts, scene.list,
                               whole};
        scene.covered.push_front({key, covered_components(asked, light_ws, margin)});
        if (scene.covered.size() > most_kept) {
            scene.covered.pop_back();
        }
        found = scene.covered.begin();
    }
    for (std::size_t c = 0; c < found->components.size(); ++c) {
        forms[c] = found->components[c] != 0 ? GN_VOLUMES_NONE : forms[c];
    }
}

}  // namespace gn
