// SPDX-License-Identifier: MIT
// Based on: van Sambeek. Real-time Shadow Generation for 3D simulations using modern hardware. 2007. [Sam07] section 2.4.5
#include "shadow/geometry/caster_proxies.h"

#include "shadow/scene/simplifier.h"

#include <algorithm>
#include <cmath>

namespace gn {

namespace {

constexpr std::uint32_t least_triangles = 32;
/// Of a solid's size: what a collapse may displace, and how far inwards a body lies at least.
constexpr float most_error = 0.05F, least_inset = 1e-3F;
/// The error that is told is a mean over what an edge stood for.
constexpr float inset_of_error = 2.0F;

/// A solid by itself, its vertices welded.
struct Solid {
    std::vector<vec3> positions_ws;
    std::vector<std::uint32_t> indices;
};

Solid cut_out(const ProxySource& source, std::span<const std::uint32_t> welded,
              std::span<const std::uint32_t> members) {
    std::vector<std::uint32_t> indices;
    for (const std::uint32_t t : members) {
        for (int i = 0; i < 3; ++i) {
            indices.push_back(welded[source.triangles[t][i]]);
        }
    }
    OwnMesh own = own_mesh(source.positions_ws, std::move(indices));
    return {std::move(own.positions_ws), std::move(own.indices)};
}

std::vector<uvec3> triangles_of(std::span<const std::uint32_t> indices) {
    std::vector<uvec3> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
    }
    return triangles;
}

/// Whether the triangles bound solids whose windings run as `outward` says.
bool is_solid(std::span<const vec3> positions_ws, const std::vector<uvec3>& triangles, int outward) {
    const std::vector<std::uint8_t> casts(triangles.size(), casts_from_both_sides);
    const EdgeList list = build_edges(positions_ws, triangles, casts);
    return !list.components.empty() &&
           std::all_of(list.components.begin(), list.components.end(),
                       [&](const Component& c) { return c.closed && c.outward == outward; });
}

/// Moves every vertex inwards until the planes of its triangles have moved by `inset` metres, or three times as far.
void inset_by(std::vector<vec3>& positions_ws, const std::vector<uvec3>& triangles, int outward, float inset) {
    std::vector<vec3> normals(positions_ws.size(), vec3(0)), faces;
    for (const uvec3 t : triangles) {
        const dvec3 a(positions_ws[t.x]);
        const dvec3 across = glm::cross(dvec3(positions_ws[t.y]) - a, dvec3(positions_ws[t.z]) - a);
        const double size = glm::length(across);
        faces.push_back(size > 0 ? vec3(across * (outward / size)) : vec3(0));
        for (int i = 0; i < 3; ++i) {
            normals[t[i]] += faces.back();
        }
    }
    std::vector<float> least(positions_ws.size(), 1.0F);
    for (vec3& normal : normals) {
        normal = glm::length(normal) > 1e-6F ? glm::normalize(normal) : vec3(0);
    }
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        for (int i = 0; i < 3; ++i) {
            float& cosine = least[triangles[f][i]];
            cosine = std::min(cosine, glm::dot(normals[triangles[f][i]], faces[f]));
        }
    }
    for (std::size_t v = 0; v < positions_ws.size(); ++v) {
        positions_ws[v] -= normals[v] * (inset / std::max(least[v], 1.0F / 3.0F));
    }
}

/// The body of a solid; without indices where it casts as it is.
Solid body_of(const Solid& solid, const Component& component, float share) {
    if (simplifier() == nullptr) {
        return {};
    }
    const auto wanted = static_cast<std::size_t>(share * static_cast<float>(solid.indices.size() / 3)) * 3;
    Simplified simpler = simplifier()(solid.positions_ws, solid.indices, std::max<std::size_t>(wanted, 12), most_error);
    Solid body{solid.positions_ws, std::move(simpler.indices)};
    const std::vector<uvec3> triangles = triangles_of(body.indices);
    const bool simpler_solid = triangles.size() >= 4 && body.indices.size() < solid.indices.size();
    if (!simpler_solid || !is_solid(body.positions_ws, triangles, component.outward)) {
        return {};
    }
    inset_by(body.positions_ws, triangles, component.outward,
             std::max(inset_of_error * simpler.error, least_inset * component.bounds_ws.diagonal()));
    return is_solid(body.positions_ws, triangles, component.outward) ? body : Solid{};
}

}  // namespace

ProxyMesh make_proxies(const ProxySource& source, float share) {
    ProxyMesh mesh;
    mesh.positions_ws.assign(source.positions_ws.begin(), source.positions_ws.end());
    const auto add = [&](uvec3 triangle, std::uint8_t casts, std::uint8_t masked, bool is_proxy) {
        mesh.triangles.push_back(triangle);
        mesh.casts.push_back(casts);
        mesh.masked.push_back(masked);
        mesh.is_proxy.push_back(is_proxy ? 1 : 0);
    };

    // Triangles by component, and which components may be replaced.
    const std::size_t count = source.list.components.size();
    std::vector<std::vector<std::uint32_t>> members(count);
    std::vector<std::uint8_t> replaceable(count, 0);
    for (std::size_t c = 0; c < count; ++c) {
        const Component& component = source.list.components[c];
        replaceable[c] = component.closed && !component.one_sided && component.triangles >= least_triangles ? 1 : 0;
    }
    for (std::uint32_t t = 0; t < source.triangles.size(); ++t) {
        const std::uint32_t c = source.list.component_of[t];
        if (c == EdgeList::no_component) {
            continue;
        }
        members[c].push_back(t);
        replaceable[c] = source.masked[t] != 0 ? 0 : replaceable[c];
    }
    const std::vector<std::uint32_t> welded = weld(source.positions_ws);
    for (std::size_t c = 0; c < count; ++c) {
        const Solid body = replaceable[c] != 0
                               ? body_of(cut_out(source, welded, members[c]), source.list.components[c], share)
                               : Solid{};
        mesh.solids += replaceable[c];
        if (body.indices.empty()) {
            for (const std::uint32_t t : members[c]) {
                add(source.triangles[t], source.casts[t], source.masked[t], false);
            }
            continue;
        }
        const auto base = static_cast<std::uint32_t>(mesh.positions_ws.size());
        mesh.positions_ws.insert(mesh.positions_ws.end(), body.positions_ws.begin(), body.positions_ws.end());
        for (const uvec3 t : triangles_of(body.indices)) {
            add(t + uvec3(base), casts_from_both_sides, 0, true);
        }
        ++mesh.replaced;
        mesh.triangles_before += members[c].size();
        mesh.triangles_after += body.indices.size() / 3;
    }
    return mesh;
}

}  // namespace gn
