// SPDX-License-Identifier: MIT
#include "shadow/receiver/parallel_views.h"

#include <glm/gtc/matrix_access.hpp>

namespace gn {
namespace {

/// Axes are one where what is left of a row beside the first view's is less than this share of it: rounding.
constexpr double rounding = 1e-6;

/// Scale and offset of each row along the first row's direction; nothing where one has another direction.
std::optional<std::vector<dvec2>> along(dvec3 direction, const std::vector<dvec4>& rows) {
    std::vector<dvec2> found;
    for (const dvec4& row : rows) {
        const double scale = glm::dot(dvec3(row), direction);
        if (glm::length(dvec3(row) - scale * direction) > rounding * scale) {
            return std::nullopt;
        }
        found.emplace_back(scale, row.w);
    }
    return found;
}

struct Axis {
    vec4 direction;
    std::vector<dvec2> places;
};

template <class RowOf>
std::optional<Axis> axis_of(const LightViews& views, RowOf row_of) {
    std::vector<dvec4> rows;
    for (const GnLightView& view : views.views) {
        rows.emplace_back(row_of(view));
    }
    const dvec3 direction = glm::normalize(dvec3(rows.front()));
    const auto places = along(direction, rows);
    return places ? std::optional<Axis>({vec4(vec3(direction), 0), *places}) : std::nullopt;
}

}  // namespace

std::optional<ParallelViews> parallel_views(const LightViews& views) {
    const std::size_t count = views.views.size();
    if (views.kind != ViewKind::affine || views.buffer.valid() || count < 2 || count > most_taken) {
        return std::nullopt;
    }
    const auto x = axis_of(views, [](const GnLightView& view) { return glm::row(view.cs_from_ws, 0); });
    const auto y = axis_of(views, [](const GnLightView& view) { return glm::row(view.cs_from_ws, 1); });
    const auto depth = axis_of(views, [](const GnLightView& view) { return view.depth_from_ws; });
    if (!x || !y || !depth) {
        return std::nullopt;
    }
    ParallelViews parallel{{x->direction, y->direction, depth->direction}, {}};
    for (std::size_t i = 0; i < count; ++i) {
        parallel.places.push_back(
            {vec4(x->places[i].x, y->places[i].x, x->places[i].y, y->places[i].y), vec4(vec2(depth->places[i]), 0, 0)});
    }
    return parallel;
}

}  // namespace gn
