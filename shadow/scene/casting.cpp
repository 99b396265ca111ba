// SPDX-License-Identifier: MIT
// Completing what casts: glass, and the bulbs that lamps spare.
#include "shadow/scene/casting.h"

#include "base/error.h"
#include "shadow/scene/model.h"

#include <algorithm>
#include <numbers>

namespace gn {

CasterClass caster_class(const Scene& scene, std::size_t object, const Light* light) {
    const Object& asked = scene.objects[object];
    const Material& material = scene.materials[static_cast<std::size_t>(asked.material)];
    const bool spared = light != nullptr && std::binary_search(light->spared.begin(), light->spared.end(), object);
    if (spared || !asked.casts.value_or(true)) {
        return CasterClass::none;
    }
    // Glass that was told to cast is taken for solid.
    if (!asked.casts && !material.casts) {
        return lets_light_through(scene, material) ? CasterClass::translucent : CasterClass::none;
    }
    return material.alpha_mode == AlphaMode::opaque ? CasterClass::opaque : CasterClass::masked;
}

bool casts(const Scene& scene, std::size_t object, const Light* light) {
    const CasterClass found = caster_class(scene, object, light);
    return found == CasterClass::opaque || found == CasterClass::masked;
}

vec3 transmittance(const Material& material) {
    return material.transmission > 0.0F ? glm::clamp(vec3(material.base_color), 0.0F, 1.0F) * material.transmission
                                        : vec3(1.0F - std::clamp(material.base_color.a, 0.0F, 1.0F));
}

std::vector<std::uint32_t> casters(const Scene& scene, const Light& light) {
    std::vector<std::uint32_t> found;
    found.reserve(scene.objects.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        if (casts(scene, i, &light)) {
            found.push_back(static_cast<std::uint32_t>(i));
        }
    }
    return found;
}

std::vector<std::uint32_t> translucent_casters(const Scene& scene, const Light& light) {
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        if (caster_class(scene, i, &light) == CasterClass::translucent) {
            found.push_back(static_cast<std::uint32_t>(i));
        }
    }
    return found;
}

namespace {

bool has_alpha(const Texture& texture) {
    const std::vector<std::uint8_t>& rgba = texture.image.rgba;
    for (std::size_t i = 3; i < rgba.size(); i += 4) {
        if (rgba[i] != 255) {
            return true;
        }
    }
    return false;
}

// The signed part of the sphere around p that a triangle covers, 1 being all of it.
// tan(omega / 2) = det(a, b, c) / (1 + a b + b c + c a) for unit vectors towards the corners.
double share_of_sphere(const Scene& scene, uvec3 t, dvec3 p_ws) {
    std::array<dvec3, 3> to{};
    for (int i = 0; i < 3; ++i) {
        const dvec3 d = dvec3(scene.positions_ws[t[i]]) - p_ws;
        const double length = glm::length(d);
        if (!(length > 0.0)) {
            return 0.0;
        }
        to[static_cast<std::size_t>(i)] = d / length;
    }
    const double above = glm::dot(to[0], glm::cross(to[1], to[2]));
    const double below = 1.0 + glm::dot(to[0], to[1]) + glm::dot(to[1], to[2]) + glm::dot(to[2], to[0]);
    return std::atan2(above, below) / (2.0 * std::numbers::pi);
}

dvec3 nearest_on_segment(dvec3 a, dvec3 b, dvec3 p) {
    const dvec3 d = b - a;
    const double t = std::clamp(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-300), 0.0, 1.0);
    return a + t * d;
}

double distance_to_triangle(const Scene& scene, uvec3 t, dvec3 p) {
    const dvec3 a(scene.positions_ws[t.x]);
    const dvec3 b(scene.positions_ws[t.y]);
    const dvec3 c(scene.positions_ws[t.z]);
    const dvec3 n = glm::cross(b - a, c - a);
    const bool above = glm::dot(glm::cross(b - a, p - a), n) >= 0.0 && glm::dot(glm::cross(c - b, p - b), n) >= 0.0 &&
                       glm::dot(glm::cross(a - c, p - c), n) >= 0.0;
    if (above) {
        return std::abs(glm::dot(p - a, n)) / glm::length(n);
    }
    return std::min({glm::distance(p, nearest_on_segment(a, b, p)), glm::distance(p, nearest_on_segment(b, c, p)),
                     glm::distance(p, nearest_on_segment(c, a, p))});
}

// How near to its lamp a bulb's surface may lie where it does not enclose it, against its own size: a tenth of its least
// extent, which a bulb beside its lamp has, or a hundredth of its diagonal, for panes of light.
double reach_of(const Box& box) {
    const vec3 extent = box.extent();
    return std::max(0.1 * static_cast<double>(std::min({extent.x, extent.y, extent.z})),
                    0.01 * static_cast<double>(box.diagonal()));
}

// Whether the object lies around a point, or all but touches it.
bool is_around(const Scene& scene, const Object& object, dvec3 p_ws) {
    const double reach = reach_of(object.bounds_ws);
    const dvec3 nearest = glm::clamp(p_ws, dvec3(object.bounds_ws.min), dvec3(object.bounds_ws.max));
    if (glm::distance(nearest, p_ws) > reach) {
        return false;
    }
    double covered = 0;
    for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
        const uvec3 t = scene.triangles[object.first_triangle + i];
        if (distance_to_triangle(scene, t, p_ws) <= reach) {
            return true;
        }
        covered += share_of_sphere(scene, t, p_ws);
    }
    // More than half of all directions: a bulb has a socket, a shade is open below.
    return std::abs(covered) > 0.5;
}

bool glows(const Scene& scene, const Object& object) {
    const vec3 e = scene.materials[static_cast<std::size_t>(object.material)].emissive;
    return std::max({e.x, e.y, e.z}) > 0.0F;
}

void note_glass(Scene& scene, const Material& glass) {
    if (is_wholly_transparent(glass)) {
        return;  // said already
    }
    add_note(
        scene.notes,
        fmt::format("Material '{}' lets light through ({}): what wears it casts no shadow, because shadows have no "
                    "colour.",
                    glass.name,
                    glass.transmission > 0.0F ? fmt::format("transmission {:.3g}", glass.transmission)
                                              : fmt::format("blended with alpha {:.3g}", glass.base_color.a)));
}

}  // namespace

bool lets_light_through(const Scene& scene, const Material& material) {
    const bool textured = material.base_color_texture >= 0 &&
                          has_alpha(scene.textures[static_cast<std::size_t>(material.base_color_texture)]);
    return material.transmission > 0.0F ||
           (material.alpha_mode == AlphaMode::blend && material.base_color.a < 1.0F && !textured);
}

void complete_casting(Scene& scene) {
    // Lamps spare what glows around them, unless it was told to cast.
    for (Light& light : scene.lights) {
        light.spared.clear();
        for (std::size_t i = 0; light.shape.kind != GN_LIGHT_DIRECTIONAL && i < scene.objects.size(); ++i) {
            const Object& object = scene.objects[i];
            if (!object.casts.has_value() && glows(scene, object) &&
                is_around(scene, object, dvec3(light.shape.position_ws))) {
                light.spared.push_back(static_cast<std::uint32_t>(i));
                add_note(scene.notes, fmt::format("'{}' glows around the lamp '{}' and casts no shadow of it.",
                                                  object.name, light.name));
            }
        }
    }

    // Glass casts nothing; it is named where something wears it that nobody told to cast or not to.
    std::vector<std::uint8_t> worn(scene.materials.size(), 0);
    for (const Object& object : scene.objects) {
        worn[static_cast<std::size_t>(object.material)] |= object.casts.has_value() ? 0U : 1U;
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        scene.materials[i].casts = !lets_light_through(scene, scene.materials[i]);
        if (!scene.materials[i].casts && worn[i] != 0) {
            note_glass(scene, scene.materials[i]);
        }
    }
}

}  // namespace gn
