// SPDX-License-Identifier: MIT
// KHR_lights_punctual with sizes from extras.gnomon, and cameras. docs/scenes.md has the schema.
#include "shadow/scene/emission.h"
#include "shadow/scene/files/gltf_pictures.h"

#include <algorithm>

namespace gn::gltf {

namespace {

// Values that a float cannot hold become infinite or NaN here and are repaired with a note by complete_lights.
float narrow(double value) {
    constexpr double most = std::numeric_limits<float>::max();
    return std::abs(value) <= most ? static_cast<float>(value)
           : value > 0.0           ? std::numeric_limits<float>::infinity()
           : value < 0.0           ? -std::numeric_limits<float>::infinity()
                                   : std::numeric_limits<float>::quiet_NaN();
}

vec4 axis_of(const dmat4& ws_from_node, int column, double sign) {
    const dvec3 axis(ws_from_node[column]);
    const double length = glm::length(axis);
    const dvec3 unit = std::isfinite(length) && length > 0.0 ? sign * axis / length : dvec3(0.0);
    return {vec3(unit), 0.0F};
}

constexpr std::array known_keys{"radius",    "angular_radius", "angular_diameter_deg",
                                "rectangle", "intensity",      "texture"};

bool is_one_of(std::span<const char* const> keys, const std::string& key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// extras.gnomon, null where there is none.
const tinygltf::Value* gnomon_of(const tinygltf::Value& extras) {
    const bool says = extras.IsObject() && extras.Has("gnomon") && extras.Get("gnomon").IsObject();
    return says ? &extras.Get("gnomon") : nullptr;
}

// Sizes by extras.gnomon of the light, then of the node that carries it, which may also say whether its mesh casts.
void apply_extras(File& file, const tinygltf::Value& extras, Light& light, bool of_node) {
    if (gnomon_of(extras) == nullptr) {
        return;
    }
    const tinygltf::Value& sizes = *gnomon_of(extras);
    GnLight& shape = light.shape;
    for (const std::string& key : sizes.Keys()) {
        if (!is_one_of(known_keys, key) && !(of_node && is_one_of(order_keys(), key))) {
            add_note(file.notes, fmt::format("Light '{}': extras.gnomon has no key '{}'; its keys are {}.", light.name,
                                             clean_text(key), fmt::join(known_keys, ", ")));
        }
    }
    shape.radius = narrow(number(sizes, "radius").value_or(static_cast<double>(shape.radius)));
    shape.angular_radius = narrow(number(sizes, "angular_radius").value_or(static_cast<double>(shape.angular_radius)));
    if (const auto diameter = number(sizes, "angular_diameter_deg")) {
        shape.angular_radius = narrow(glm::radians(0.5 * *diameter));
    }

    // A rectangle of luminance I / A is as bright along its axis as a point of I candela.
    const tinygltf::Value& rectangle = sizes.Has("rectangle") ? sizes.Get("rectangle") : tinygltf::Value();
    const auto width = number(rectangle, "width");
    const auto height = number(rectangle, "height");
    if (width && height && *width > 0.0 && *height > 0.0 && shape.kind != GN_LIGHT_DIRECTIONAL) {
        shape.kind = GN_LIGHT_RECTANGLE;
        shape.half_size = vec2(narrow(0.5 * *width), narrow(0.5 * *height));
        shape.intensity = narrow(static_cast<double>(shape.intensity) / (*width * *height));
    } else if (sizes.Has("rectangle")) {
        add_note(file.notes, fmt::format("Light '{}': extras.gnomon.rectangle needs a positive width and height, on a "
                                         "spot or point light; it was ignored.",
                                         light.name));
    }
    shape.intensity = narrow(number(sizes, "intensity").value_or(static_cast<double>(shape.intensity)));
}

// The picture that a rectangle shows: the file's texture that the node names, else its light.
void apply_texture(File& file, const tinygltf::Value& of_node, const tinygltf::Value& of_light, Light& light,
                   Pictures& pictures) {
    const auto names = [](const tinygltf::Value& extras) {
        return gnomon_of(extras) != nullptr && gnomon_of(extras)->Has("texture");
    };
    if (!names(of_node) && !names(of_light)) {
        return;
    }
    if (!gn_takes_emission(light.shape)) {
        add_note(file.notes,
                 fmt::format("Light '{}': extras.gnomon.texture is of rectangles; it was ignored.", light.name));
        return;
    }
    const double index = number(*gnomon_of(names(of_node) ? of_node : of_light), "texture").value_or(-1);
    if (!(index >= 0 && index < static_cast<double>(file.data.textures.size()))) {
        add_note(file.notes, fmt::format("Light '{}': extras.gnomon.texture is the index of one of the file's {} "
                                         "textures; the light keeps its plain colour.",
                                         light.name, file.data.textures.size()));
        return;
    }
    set_emission(light.shape, pictures.shown_by_light(static_cast<int>(index)));
}

std::optional<std::uint32_t> kind_of(const std::string& type) {
    return type == "directional" ? std::optional<std::uint32_t>(GN_LIGHT_DIRECTIONAL)
           : type == "spot"      ? std::optional<std::uint32_t>(GN_LIGHT_SPOT)
           : type == "point"     ? std::optional<std::uint32_t>(GN_LIGHT_POINT)
                                 : std::nullopt;
}

}  // namespace

std::span<const char* const> light_keys() {
    return known_keys;
}

std::optional<PlacedLight> load_light(File& file, const tinygltf::Node& node, const dmat4& ws_from_node,
                                      Pictures& pictures) {
    // The node names a light of the file.
    const auto found = node.extensions.find("KHR_lights_punctual");
    if (found == node.extensions.end()) {
        return std::nullopt;
    }
    const std::optional<double> index = number(found->second, "light");
    if (!index || *index < 0.0 || *index >= static_cast<double>(file.data.lights.size())) {
        add_note(file.notes, fmt::format("Node '{}' names a light that is not there.", clean_text(node.name)));
        return std::nullopt;
    }
    const tinygltf::Light& data = file.data.lights[static_cast<std::size_t>(*index)];
    const std::optional<std::uint32_t> kind = kind_of(data.type);
    if (!kind) {
        add_note(file.notes, fmt::format("A light of type '{}' was skipped; types are directional, spot and point.",
                                         clean_text(data.type)));
        return std::nullopt;
    }

    // Lights look along -z of their node.
    PlacedLight placed;
    placed.light.name = clean_text(!node.name.empty() ? node.name : data.name);
    placed.position_ws = dvec3(ws_from_node[3]);
    GnLight& shape = placed.light.shape;
    shape.kind = *kind;
    shape.direction_ws = axis_of(ws_from_node, 2, -1.0);
    shape.right_ws = axis_of(ws_from_node, 0, 1.0);
    shape.up_ws = axis_of(ws_from_node, 1, 1.0);
    for (std::size_t i = 0; i < std::min<std::size_t>(data.color.size(), 3); ++i) {
        shape.color[static_cast<int>(i)] = narrow(data.color[i]);
    }
    shape.intensity = narrow(data.intensity);
    shape.range = shape.kind == GN_LIGHT_DIRECTIONAL ? 0.0F : narrow(data.range);
    shape.cos_inner = narrow(std::cos(data.spot.innerConeAngle));
    shape.cos_outer = narrow(std::cos(data.spot.outerConeAngle));
    apply_extras(file, data.extras, placed.light, false);
    apply_extras(file, node.extras, placed.light, true);
    apply_texture(file, node.extras, data.extras, placed.light, pictures);
    return placed;
}

std::optional<PlacedCamera> load_camera(File& file, const tinygltf::Node& node, const dmat4& ws_from_node) {
    if (node.camera < 0) {
        return std::nullopt;
    }
    const tinygltf::Camera& data = at(file.data.cameras, node.camera, file, "camera");
    const std::string name = clean_text(!node.name.empty() ? node.name : data.name);
    const bool orthographic = data.type == "orthographic";
    if (!orthographic && data.type != "perspective") {
        add_note(file.notes,
                 fmt::format("Camera '{}' of type '{}' was skipped; types are perspective and orthographic.", name,
                             clean_text(data.type)));
        return std::nullopt;
    }

    // No zfar means infinity, which the scene's size will replace; no znear is a mistake.
    PlacedCamera placed;
    placed.position_ws = dvec3(ws_from_node[3]);
    placed.camera.name = name.empty() ? "main" : name;
    placed.camera.forward_ws = vec3(axis_of(ws_from_node, 2, -1.0));
    placed.camera.up_ws = vec3(axis_of(ws_from_node, 1, 1.0));
    if (orthographic) {
        // The picture's own shape decides what lies to the sides. Zero is a usable near plane here.
        const tinygltf::OrthographicCamera& lens = data.orthographic;
        placed.camera.half_height = lens.ymag > 0.0 ? narrow(lens.ymag) : -1.0F;
        placed.camera.near = lens.znear >= 0.0 ? narrow(lens.znear) : -1.0F;
        placed.camera.far = lens.zfar > 0.0 ? narrow(lens.zfar) : -1.0F;
        return placed;
    }
    placed.camera.yfov = narrow(data.perspective.yfov);
    placed.camera.near = data.perspective.znear > 0.0 ? narrow(data.perspective.znear) : -1.0F;
    placed.camera.far = narrow(data.perspective.zfar);
    return placed;
}

}  // namespace gn::gltf
