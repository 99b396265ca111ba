// SPDX-License-Identifier: MIT
#include "shadow/geometry/receiver_planes.h"

#include "gpu/hash.h"
#include "shadow/scene/clusters.h"

#include <algorithm>
#include <bit>
#include <unordered_map>

namespace gn {

namespace {

struct Facet {
    dvec3 normal{0};  // unit
    double offset = 0, area = 0;
};

Facet facet(const Scene& scene, std::size_t triangle) {
    const uvec3 t = scene.triangles[triangle];
    const dvec3 a(scene.positions_ws[t.x]), b(scene.positions_ws[t.y]), c(scene.positions_ws[t.z]);
    const dvec3 n = glm::cross(b - a, c - a);
    const double length = glm::length(n);
    if (!(length > 0.0)) {
        return {};
    }
    return {n / length, -glm::dot(n / length, a), 0.5 * length};
}

// Facets that may be coplanar: rounded normal and offset, turned so that opposite sides of a plane agree.
struct Cell {
    double area = 0, largest_area = 0;
    std::size_t largest = 0;  // triangle
};

std::uint64_t cell_key(const Facet& f, double thickness) {
    dvec3 n = f.normal;
    const dvec3 size = glm::abs(n);
    const double leading = size.x >= size.y && size.x >= size.z ? n.x : (size.y >= size.z ? n.y : n.z);
    const double sign = leading < 0.0 ? -1.0 : 1.0;
    const auto round = [](double v) { return static_cast<std::uint64_t>(std::llround(v)); };
    std::uint64_t key = round(sign * f.offset / thickness);
    for (int i = 0; i < 3; ++i) {
        key = std::rotl(key * 0x9E3779B97F4A7C15ULL, 21) ^ round(sign * n[i] * 512.0);
    }
    return key;
}

// Candidates: the cells with the largest areas, each stood for by its largest triangle.
std::vector<Cell> largest_cells(const Scene& scene, double thickness, std::size_t count, double& total) {
    std::unordered_map<std::uint64_t, Cell> cells;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const Facet f = facet(scene, t);
        if (f.area <= 0.0) {
            continue;
        }
        total += f.area;
        Cell& cell = cells[cell_key(f, thickness)];
        cell.area += f.area;
        if (f.area > cell.largest_area) {
            cell.largest_area = f.area;
            cell.largest = t;
        }
    }
    std::vector<Cell> sorted;
    sorted.reserve(cells.size());
    for (const auto& [key, cell] : cells) {
        sorted.push_back(cell);
    }
    const std::size_t kept = std::min(count, sorted.size());
    std::partial_sort(
        sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(kept), sorted.end(),
        [](const Cell& a, const Cell& b) { return a.area != b.area ? a.area > b.area : a.largest < b.largest; });
    sorted.resize(kept);
    return sorted;
}

bool lies_in(const Scene& scene, std::size_t triangle, const Facet& plane, double tolerance) {
    for (int i = 0; i < 3; ++i) {
        const dvec3 p(scene.positions_ws[scene.triangles[triangle][i]]);
        if (std::abs(glm::dot(plane.normal, p) + plane.offset) > tolerance) {
            return false;
        }
    }
    return true;
}

}  // namespace

ReceiverPlanes receiver_planes(const Scene& scene, const PlaneSearch& search) {
    ReceiverPlanes found{.tolerance = search.tolerance * largest_cluster(scene).diagonal()};
    const double tolerance = std::max(static_cast<double>(found.tolerance), 1e-30);
    double total = 0;
    std::vector<Facet> taken;
    for (const Cell& cell :
         largest_cells(scene, 4.0 * tolerance, 16 + 4 * static_cast<std::size_t>(search.planes), total)) {
        // A plane whose facets fell into two cells is taken once.
        const auto same = [&](const Facet& plane) { return lies_in(scene, cell.largest, plane, tolerance); };
        if (std::any_of(taken.begin(), taken.end(), same)) {
            continue;
        }
        // Sum the area that really lies in the candidate's plane.
        const Facet plane = facet(scene, cell.largest);
        double area = 0;
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            area += lies_in(scene, t, plane, tolerance) ? facet(scene, t).area : 0.0;
        }
        taken.push_back(plane);
        found.planes.push_back({vec4(vec3(plane.normal), static_cast<float>(plane.offset)), area / total});
    }

    // Keep the largest that are large enough.
    std::stable_sort(found.planes.begin(), found.planes.end(),
                     [](const ReceiverPlane& a, const ReceiverPlane& b) { return a.share > b.share; });
    found.largest = found.planes.empty() ? 0.0 : found.planes.front().share;
    const auto small = std::find_if(found.planes.begin(), found.planes.end(), [&](const ReceiverPlane& p) {
        return p.share < static_cast<double>(search.min_area);
    });
    found.planes.erase(small, found.planes.end());
    found.planes.resize(std::min(found.planes.size(), static_cast<std::size_t>(search.planes)));
    return found;
}

std::shared_ptr<const ReceiverPlanes> flat_receivers(const FrameInput& input, const PlaneSearch& search,
                                                     std::string_view part) {
    const std::uint64_t key = Hasher().value(search.min_area).value(search.tolerance).value(search.planes).finish().low;
    auto found = input.derive("receiver planes", key, [&] { return receiver_planes(input.scene, search); });
    if (found->planes.empty()) {
        refuse(
            "{} needs a flat receiver of at least {:.3g} % of the scene's surface, and the largest in '{}' has {:.3g} "
            "%: lower {}.min_area or take volumes",
            part, 100.0 * static_cast<double>(search.min_area), input.scene.name, 100.0 * found->largest, part);
    }
    return found;
}

}  // namespace gn
