// SPDX-License-Identifier: MIT
// Based on: Lloyd, Wendt, Govindaraju, Manocha. CC Shadow Volumes. EGSR 2004. [LWGM04] Section 3, shadow caster culling.
#include "shadow/geometry/covered_components.h"

#include "shadow/geometry/volumes.glsl"

#include <algorithm>
#include <array>
#include <cmath>

namespace gn {

namespace {

constexpr std::size_t most_coverers = 64;
constexpr std::uint32_t most_triangles = 4096;

/// The surface that a component casts with, and the border of that surface as the light sees it.
struct Coverer {
    std::uint32_t component = 0;
    std::array<dvec3, 8> corners_ws{};
    std::vector<std::array<dvec3, 3>> caps_ws;
    std::vector<std::array<dvec3, 2>> border_ws;
};

std::array<dvec3, 8> corners_of(const Box& box, double margin) {
    std::array<dvec3, 8> corners_ws{};
    for (unsigned i = 0; i < 8; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            corners_ws.at(i)[axis] = (i >> static_cast<unsigned>(axis) & 1U) != 0U
                                         ? static_cast<double>(box.max[axis]) + margin
                                         : static_cast<double>(box.min[axis]) - margin;
        }
    }
    return corners_ws;
}

/// How large a box looks from the light: its diagonal, by its distance where there is one.
double size_from_light(const Box& box, vec4 light_ws) {
    const auto size = static_cast<double>(box.diagonal());
    return light_ws.w > 0.0F ? size / std::max(glm::distance(dvec3(light_ws), dvec3(box.centre())), 1e-30) : size;
}

std::vector<std::uint32_t> choose_coverers(const CoverScene& scene, vec4 light_ws) {
    const std::vector<Component>& components = scene.list.components;
    std::vector<std::uint32_t> chosen;
    std::vector<double> sizes(components.size());
    for (std::uint32_t c = 0; c < components.size(); ++c) {
        if ((scene.forms[c] & 3U) != GN_VOLUMES_NONE && components[c].triangles <= most_triangles) {
            sizes[c] = size_from_light(components[c].bounds_ws, light_ws);
            chosen.push_back(c);
        }
    }
    const std::size_t count = std::min(chosen.size(), most_coverers);
    std::partial_sort(
        chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(count), chosen.end(),
        [&](std::uint32_t a, std::uint32_t b) { return sizes[a] != sizes[b] ? sizes[a] > sizes[b] : a < b; });
    chosen.resize(count);
    return chosen;
}

/// The caps and the borders of the chosen components.
std::vector<Coverer> make_coverers(const CoverScene& scene, vec4 light_ws) {
    std::vector<Coverer> coverers;
    std::vector<std::int32_t> number(scene.list.components.size(), -1);
    for (const std::uint32_t c : choose_coverers(scene, light_ws)) {
        number[c] = static_cast<std::int32_t>(coverers.size());
        coverers.push_back({.component = c, .corners_ws = corners_of(scene.list.components[c].bounds_ws, 0)});
    }
    const auto coverer_of = [&](std::uint32_t triangle) {
        const std::uint32_t c = scene.list.component_of[triangle];
        return c == EdgeList::no_component || number[c] < 0 ? nullptr : &coverers[static_cast<std::size_t>(number[c])];
    };
    const auto at = [&](std::uint32_t vertex) { return scene.positions_ws[vertex]; };
    std::vector<std::int8_t> multiplicity(scene.triangles.size(), 0);
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        Coverer* coverer = coverer_of(t);
        if (coverer == nullptr) {
            continue;
        }
        const uvec3 v = scene.triangles[t];
        int side = gn_volumes_side(at(v.x), at(v.y), at(v.z), light_ws);
        side = scene.casts[t] == casts_from_its_front ? std::max(side, 0) : side;
        const auto form = static_cast<int>(scene.forms[coverer->component] & 3U);
        multiplicity[t] = static_cast<std::int8_t>(gn_volumes_multiplicity(side, form));
        if (multiplicity[t] != 0) {
            coverer->caps_ws.push_back({dvec3(at(v.x)), dvec3(at(v.y)), dvec3(at(v.z))});
        }
    }
    for (std::size_t e = 0; e < scene.list.edges.size(); ++e) {
        Coverer* coverer = coverer_of(scene.list.around[scene.list.first[e]] / 2);
        if (coverer == nullptr) {
            continue;
        }
        int sum = 0;
        for (std::uint32_t i = scene.list.first[e]; i < scene.list.first[e + 1]; ++i) {
            const int m = multiplicity[scene.list.around[i] / 2];
            sum += (scene.list.around[i] & 1U) != 0U ? -m : m;
        }
        if (sum != 0) {
            coverer->border_ws.push_back({dvec3(at(scene.list.edges[e].x)), dvec3(at(scene.list.edges[e].y))});
        }
    }
    return coverers;
}

/// A bundle of rays from the light: a rectangle across one of them. Points are (x, y, h) in its frame, x / h and y / h being
/// where their ray crosses the rectangle's plane; h = 1 under a sun.
class Bundle {
  public:
    /// Around all rays that meet the corners; none where the light is among them.
    Bundle(const std::array<dvec3, 8>& corners_ws, vec4 light_ws) : light_ws_(light_ws) {
        dvec3 centre_ws(0);
        for (const dvec3 corner : corners_ws) {
            centre_ws += corner / 8.0;
        }
        axis_ws_ = centre_ws * light_ws_.w - dvec3(light_ws_);
        const double distance = glm::length(axis_ws_);
        if (!(distance > 0.0)) {
            return;
        }
        axis_ws_ /= distance;
        right_ws_ = glm::normalize(glm::cross(axis_ws_, std::abs(axis_ws_.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
        up_ws_ = glm::cross(right_ws_, axis_ws_);
        holds_ = spread(corners_ws, low_, high_);
    }
    /// Whether it is one.
    [[nodiscard]] bool valid() const { return holds_; }
    [[nodiscard]] dvec3 place(dvec3 p_ws) const {
        const dvec3 off_ws = p_ws - dvec3(light_ws_) * light_ws_.w;
        return {glm::dot(off_ws, right_ws_), glm::dot(off_ws, up_ws_),
                light_ws_.w > 0.0 ? glm::dot(off_ws, axis_ws_) : 1.0};
    }
    /// The least rectangle around all rays that meet the corners; false where the light is not on one side of them.
    bool spread(const std::array<dvec3, 8>& corners_ws, dvec2& low, dvec2& high) const {
        low = dvec2(1e300);
        high = dvec2(-1e300);
        for (const dvec3 corner_ws : corners_ws) {
            const dvec3 at = place(corner_ws);
            if (!(at.z > 0.0)) {
                return false;
            }
            low = glm::min(low, dvec2(at) / at.z);
            high = glm::max(high, dvec2(at) / at.z);
        }
        return true;
    }
    /// Whether something in these corners can cover it.
    [[nodiscard]] bool may_lie_behind(const std::array<dvec3, 8>& corners_ws) const {
        dvec2 low, high;
        return !spread(corners_ws, low, high) ||
               (glm::all(glm::lessThan(low, low_)) && glm::all(glm::lessThan(high_, high)));
    }
    /// Whether the convex polygon (a segment, a triangle) meets one of the rays.
    template <std::size_t n>
    [[nodiscard]] bool meets(const std::array<dvec3, n>& corners_ws) const {
        std::array<dvec3, n + 4> polygon{}, kept{};
        for (std::size_t i = 0; i < n; ++i) {
            polygon[i] = place(corners_ws[i]);
        }
        std::size_t count = n;
        for (int side = 0; side < 4 && count > 0; ++side) {
            std::size_t left = 0;
            for (std::size_t i = 0; i < count; ++i) {
                const dvec3 a = polygon[i], b = polygon[(i + 1) % count];
                const double inside_a = inside(a, side), inside_b = inside(b, side);
                if (inside_a >= 0.0) {
                    kept[left++] = a;
                }
                if ((inside_a > 0.0 && inside_b < 0.0) || (inside_a < 0.0 && inside_b > 0.0)) {
                    kept[left++] = a + (b - a) * (inside_a / (inside_a - inside_b));
                }
            }
            polygon = kept;
            count = left;
        }
        return count > 0;
    }
    /// Whether one of its rays, somewhere in it, meets the triangle, away from the triangle's edges.
    [[nodiscard]] bool one_meets(const std::array<dvec3, 3>& t_ws, dvec2 share) const {
        const dvec3 a = place(t_ws[0]), b = place(t_ws[1]), c = place(t_ws[2]);
        const dvec3 middle(low_ + (high_ - low_) * share, 1.0);
        const double whole = glm::dot(a, glm::cross(b, c));
        const double u = glm::dot(middle, glm::cross(b, c)) / whole, v = glm::dot(a, glm::cross(middle, c)) / whole,
                     w = glm::dot(a, glm::cross(b, middle)) / whole;
        return u > 0.0 && v > 0.0 && w > 0.0;
    }

  private:
    [[nodiscard]] double inside(dvec3 p, int side) const {
        switch (side) {
            case 0: return p.x - low_.x * p.z;
            case 1: return high_.x * p.z - p.x;
            case 2: return p.y - low_.y * p.z;
            default: return high_.y * p.z - p.y;
        }
    }
    dvec4 light_ws_;
    dvec3 axis_ws_{0}, right_ws_{0}, up_ws_{0};
    dvec2 low_{0}, high_{0};
    bool holds_ = false;
};

/// Whether all corners lie on the other side of the triangle's plane than the light.
bool behind(const std::array<dvec3, 3>& t_ws, const std::array<dvec3, 8>& corners_ws, vec4 light_ws) {
    const dvec3 n_ws = glm::cross(t_ws[1] - t_ws[0], t_ws[2] - t_ws[0]);
    const double light = glm::dot(n_ws, dvec3(light_ws) - t_ws[0] * static_cast<double>(light_ws.w));
    return std::all_of(corners_ws.begin(), corners_ws.end(),
                       [&](dvec3 corner_ws) { return glm::dot(n_ws, corner_ws - t_ws[0]) * light < 0.0; });
}

/// The border of what covers lies beside all rays of the bundle, one ray meets the surface: then all do. What they meet lies before
/// the corners where its planes do.
bool covers(const Coverer& coverer, const Bundle& bundle, const std::array<dvec3, 8>& corners_ws, vec4 light_ws) {
    const std::array<dvec2, 3> shares{dvec2(0.381966, 0.527864), dvec2(0.618034, 0.313159), dvec2(0.271828, 0.707107)};
    bool met = false;
    for (const auto& cap_ws : coverer.caps_ws) {
        if (bundle.meets(cap_ws)) {
            if (!behind(cap_ws, corners_ws, light_ws)) {
                return false;
            }
            // Rays at the edge of two caps are met by neither: of three, off all that is regular, one is at none.
            met = met || std::any_of(shares.begin(), shares.end(),
                                     [&](dvec2 share) { return bundle.one_meets(cap_ws, share); });
        }
    }
    return met && std::none_of(coverer.border_ws.begin(), coverer.border_ws.end(),
                               [&](const auto& edge_ws) { return bundle.meets(edge_ws); });
}

}  // namespace

std::vector<std::uint8_t> covered_components(const CoverScene& scene, vec4 light_ws, double margin) {
    const std::vector<Component>& components = scene.list.components;
    const std::vector<Coverer> coverers = make_coverers(scene, light_ws);
    std::vector<std::uint8_t> covered(components.size(), 0);
    for (std::uint32_t c = 0; c < components.size(); ++c) {
        const std::array<dvec3, 8> corners_ws = corners_of(components[c].bounds_ws, margin);
        const Bundle bundle(corners_ws, light_ws);
        if ((scene.forms[c] & 3U) == GN_VOLUMES_NONE || !bundle.valid()) {
            continue;
        }
        covered[c] = std::any_of(coverers.begin(), coverers.end(),
                                 [&](const Coverer& coverer) {
                                     return coverer.component != c && bundle.may_lie_behind(coverer.corners_ws) &&
                                            covers(coverer, bundle, corners_ws, light_ws);
                                 })
                         ? 1
                         : 0;
    }
    return covered;
}

}  // namespace gn
