// SPDX-License-Identifier: MIT
#include "shadow/scene/files/upright.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gn {
namespace {

/// Of the model's size: how far from its end along an axis a floor may lie, and a flat foot.
constexpr double floor_share = 0.01, foot_share = 0.002;
/// Of the footprint: a floor covers more than half. Feet stand apart: the rectangle around them is no small part, and less
/// than a fiftieth is a point or a line. Of nine models, turned so that z was up, this finds a table, two teapots, two cows
/// and a fence; a chair lies on its back as well as it stands. Of 40 upright ones it takes none for lying.
constexpr double floor_area = 0.5, foot_spread = 0.07, no_foot = 0.02;
/// What is flatter than this is a wall, a card or a relief, and might hang anywhere.
constexpr double least_height = 0.1;

struct Bounds {
    dvec3 min{std::numeric_limits<double>::max()}, max{std::numeric_limits<double>::lowest()};
};

/// Areas of a model's faces at its ends along one axis, in footprints.
struct Ends {
    double floor = 0, foot = 0, top = 0;
    double spread = 0;  ///< of the rectangle that everything at the low end spans
};

template <class Visit>
void visit_triangles(const Model& model, const Visit& visit) {
    for (const Instance& instance : model.instances) {
        const Mesh& mesh = model.meshes[instance.mesh];
        const double turned = glm::determinant(glm::dmat3(instance.ws_from_os)) < 0.0 ? -1.0 : 1.0;
        for (const uvec3 t : mesh.triangles) {
            std::array<dvec3, 3> corners{};
            bool good = true;
            for (int i = 0; i < 3; ++i) {
                good = good && t[i] < mesh.positions_os.size();
                corners[static_cast<std::size_t>(i)] =
                    good ? dvec3(instance.ws_from_os * dvec4(mesh.positions_os[t[i]], 1.0)) : dvec3(0.0);
            }
            const dvec3 area = 0.5 * turned * glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
            if (good && std::isfinite(glm::dot(area, area))) {
                visit(corners, area);
            }
        }
    }
}

Ends ends_along(const Model& model, const Bounds& bounds, int axis) {
    const dvec3 extent = bounds.max - bounds.min;
    const double size = glm::length(extent);
    const int other = 3 - axis;
    Ends ends;
    Bounds low_end;
    visit_triangles(model, [&](const std::array<dvec3, 3>& p, dvec3 area) {
        const double low = std::min({p[0][axis], p[1][axis], p[2][axis]}) - bounds.min[axis];
        const double high = std::max({p[0][axis], p[1][axis], p[2][axis]}) - bounds.min[axis];
        ends.floor += high <= floor_share * size ? std::max(area[axis], 0.0) : 0.0;
        ends.foot += high <= foot_share * size ? std::max(-area[axis], 0.0) : 0.0;
        ends.top += low >= extent[axis] - foot_share * size ? std::max(area[axis], 0.0) : 0.0;
        for (const dvec3& corner : p) {
            if (corner[axis] - bounds.min[axis] <= foot_share * size) {
                low_end.min = glm::min(low_end.min, corner);
                low_end.max = glm::max(low_end.max, corner);
            }
        }
    });
    const double footprint = extent.x * extent[other];
    const dvec3 span = low_end.max - low_end.min;
    return {ends.floor / footprint, ends.foot / footprint, ends.top / footprint, span.x * span[other] / footprint};
}

}  // namespace

dmat4 y_up_from_z_up() {
    return {dvec4(1, 0, 0, 0), dvec4(0, 0, -1, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 0, 1)};
}

bool lies_on_its_side(const Model& model) {
    Bounds bounds;
    visit_triangles(model, [&](const std::array<dvec3, 3>& p, dvec3) {
        for (const dvec3& corner : p) {
            bounds.min = glm::min(bounds.min, corner);
            bounds.max = glm::max(bounds.max, corner);
        }
    });
    const dvec3 extent = bounds.max - bounds.min;
    if (!(extent.x > 0 && extent.y > 0 && extent.z > least_height * std::max(extent.x, extent.y))) {
        return false;
    }
    const Ends y = ends_along(model, bounds, 1), z = ends_along(model, bounds, 2);
    const bool floor = z.floor > floor_area && y.floor <= floor_area;
    // A wheel or a drum on its side ends in two caps; what stands on one of them does not.
    const bool drum = std::min(z.foot, z.top) > 0.5 * std::max(z.foot, z.top) && z.foot > no_foot;
    const bool stands = z.spread > foot_spread && y.spread < no_foot && y.floor < no_foot && !drum;
    return floor || stands;
}

void note_side(Model& model) {
    if (model.lights.empty() && model.cameras.empty() && lies_on_its_side(model)) {
        add_note(model.notes,
                 "The model seems to lie on its side: it stands on a plane of its least z and on none of its least y; "
                 "--up z, "
                 "or up = \"z\" in a .toml scene, stands it up.");
    }
}

}  // namespace gn
