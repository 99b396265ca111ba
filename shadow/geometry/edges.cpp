// SPDX-License-Identifier: MIT
#include "shadow/geometry/edges.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace gn {

namespace {

// One side of one triangle: the edge as a sortable number, and who runs along it.
struct HalfEdge {
    std::uint64_t key;
    std::uint32_t user;  // triangle * 2 + 1 when it runs from the larger vertex to the smaller
};

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

std::vector<HalfEdge> half_edges(std::span<const uvec3> triangles, std::span<const std::uint8_t> casts,
                                 const std::vector<std::uint32_t>& welded, EdgeList& list) {
    std::vector<HalfEdge> halves;
    halves.reserve(triangles.size() * 3);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        // Leave out what casts nothing: a triangle with two equal corners is a line.
        const std::uint32_t v[3] = {welded[triangles[t].x], welded[triangles[t].y], welded[triangles[t].z]};
        if (casts[t] == 0 || v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
            continue;
        }
        list.component_of[t] = t;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = v[i], b = v[(i + 1) % 3];
            const std::uint64_t low = std::min(a, b), high = std::max(a, b);
            halves.push_back({low << 32U | high, t * 2 + (a > b ? 1U : 0U)});
        }
    }
    std::sort(halves.begin(), halves.end(),
              [](const HalfEdge& a, const HalfEdge& b) { return a.key != b.key ? a.key < b.key : a.user < b.user; });
    return halves;
}

// Six times the signed volume between a triangle and `origin`.
double volume6(std::span<const vec3> positions, const uvec3& t, dvec3 origin) {
    const dvec3 a = dvec3(positions[t.x]) - origin, b = dvec3(positions[t.y]) - origin,
                c = dvec3(positions[t.z]) - origin;
    return glm::dot(a, glm::cross(b, c));
}

void describe_components(std::span<const vec3> positions, std::span<const uvec3> triangles,
                         std::span<const std::uint8_t> casts, EdgeList& list) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (list.component_of[t] == EdgeList::no_component) {
            continue;
        }
        Component& component = list.components[list.component_of[t]];
        ++component.triangles;
        component.one_sided = component.one_sided || casts[t] == casts_from_its_front;
        for (int i = 0; i < 3; ++i) {
            component.bounds_ws.grow(positions[triangles[t][i]]);
        }
    }
    // A component is closed when no edge has a direction left over.
    for (std::size_t e = 0; e < list.edges.size(); ++e) {
        int sum = 0;
        for (std::uint32_t i = list.first[e]; i < list.first[e + 1]; ++i) {
            sum += (list.around[i] & 1U) != 0U ? -1 : 1;
        }
        if (sum != 0) {
            list.components[list.component_of[list.around[list.first[e]] / 2]].closed = false;
        }
    }
    // The sign of the enclosed volume tells outward windings from inward ones.
    std::vector<double> volumes(list.components.size(), 0.0);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (const std::uint32_t c = list.component_of[t]; c != EdgeList::no_component) {
            volumes[c] += volume6(positions, triangles[t], dvec3(list.components[c].bounds_ws.centre()));
        }
    }
    for (std::size_t c = 0; c < volumes.size(); ++c) {
        list.components[c].outward = volumes[c] < 0.0 ? -1 : 1;
    }
}

}  // namespace

std::vector<std::uint32_t> weld(std::span<const vec3> positions_ws) {
    const std::size_t slots = std::bit_ceil(positions_ws.size() * 2 + 16);
    std::vector<std::uint32_t> table(slots, ~0U), first(positions_ws.size());
    for (std::uint32_t v = 0; v < positions_ws.size(); ++v) {
        // Hash the bits with -0 made 0, then probe linearly for an equal position.
        const vec3 p = positions_ws[v] + vec3(0.0F);
        std::uint64_t hash = std::bit_cast<std::uint32_t>(p.x) * 0x9E3779B97F4A7C15ULL;
        hash = (std::rotl(hash, 23) ^ std::bit_cast<std::uint32_t>(p.y)) * 0xBF58476D1CE4E5B9ULL;
        hash = (std::rotl(hash, 23) ^ std::bit_cast<std::uint32_t>(p.z)) * 0x94D049BB133111EBULL;
        std::size_t slot = (hash ^ (hash >> 29U)) & (slots - 1);
        while (table[slot] != ~0U && positions_ws[table[slot]] != p) {
            slot = (slot + 1) & (slots - 1);
        }
        if (table[slot] == ~0U) {
            table[slot] = v;
        }
        first[v] = table[slot];
    }
    return first;
}

EdgeList build_edges(std::span<const vec3> positions_ws, std::span<const uvec3> triangles,
                     std::span<const std::uint8_t> casts) {
    EdgeList list;
    list.component_of.assign(triangles.size(), EdgeList::no_component);
    const std::vector<HalfEdge> halves = half_edges(triangles, casts, weld(positions_ws), list);

    // Equal keys are one edge; the triangles on it belong together.
    std::vector<std::uint32_t> parent(triangles.size());
    std::iota(parent.begin(), parent.end(), 0U);
    list.around.reserve(halves.size());
    for (std::size_t i = 0; i < halves.size(); ++i) {
        if (i == 0 || halves[i].key != halves[i - 1].key) {
            list.edges.emplace_back(static_cast<std::uint32_t>(halves[i].key >> 32U),
                                    static_cast<std::uint32_t>(halves[i].key & 0xFFFFFFFFU));
            list.first.push_back(static_cast<std::uint32_t>(i));
        } else {
            parent[find_root(parent, halves[i].user / 2)] = find_root(parent, halves[i - 1].user / 2);
        }
        list.around.push_back(halves[i].user);
    }
    list.first.push_back(static_cast<std::uint32_t>(halves.size()));

    // Number the components in order of their first triangle.
    std::vector<std::uint32_t> number(triangles.size(), EdgeList::no_component);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        if (list.component_of[t] == EdgeList::no_component) {
            continue;
        }
        std::uint32_t& id = number[find_root(parent, t)];
        if (id == EdgeList::no_component) {
            id = static_cast<std::uint32_t>(list.components.size());
            list.components.push_back({.closed = true});
        }
        list.component_of[t] = id;
    }
    describe_components(positions_ws, triangles, casts, list);
    return list;
}

}  // namespace gn
