// SPDX-License-Identifier: MIT
// .toml scenes: files, lights, cameras and camera paths placed by hand. docs/scenes.md has the keys.
#include "shadow/scene/cookie.h"
#include "shadow/scene/emission.h"
#include "shadow/scene/files/given_sky.h"
#include "shadow/scene/files/toml_table.h"
#include "shadow/scene/files/upright.h"
#include "shadow/scene/model.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>

namespace gn {

namespace {

constexpr std::size_t largest_scene_file = std::size_t{16} << 20U;
constexpr std::size_t most_frames = 100'000;

// Where a file stands: scale, then rotate (degrees about x, then y, then z; or a quaternion x y z w), then translate.
dmat4 placement(const TomlTable& table) {
    dmat4 rotation(1.0);
    if (table.has("quaternion")) {
        if (table.has("rotate")) {
            fail("{}: give either rotate or quaternion", table.where());
        }
        const std::vector<double> q = *table.numbers("quaternion", 4);
        const glm::dquat turn(q[3], q[0], q[1], q[2]);
        if (!(glm::length(turn) > 1e-9)) {
            table.wrong("quaternion", "a list x, y, z, w that is not zero");
        }
        rotation = glm::mat4_cast(glm::normalize(turn));
    } else {
        const dvec3 angles = glm::radians(table.vector("rotate", dvec3(0.0)));
        rotation = glm::rotate(dmat4(1.0), angles.z, dvec3(0, 0, 1)) *
                   glm::rotate(dmat4(1.0), angles.y, dvec3(0, 1, 0)) *
                   glm::rotate(dmat4(1.0), angles.x, dvec3(1, 0, 0));
    }
    const dvec3 scale = table.is_list("scale") ? table.vector("scale", dvec3(1.0)) : dvec3(table.number("scale", 1.0));
    return glm::translate(dmat4(1.0), table.vector("translate", dvec3(0.0))) * rotation * glm::scale(dmat4(1.0), scale);
}

// casts and receives, for every instance that the table speaks of.
void order(const TomlTable& table, std::span<Instance> instances) {
    for (Instance& instance : instances) {
        instance.casts = table.has("casts") ? table.flag("casts") : instance.casts;
        instance.receives = table.has("receives") ? table.flag("receives") : instance.receives;
    }
}

// Orders for what has a name, whatever file it comes from.
void order_object(const TomlTable& table, Model& model) {
    static constexpr std::array<std::string_view, 3> keys{"name", "casts", "receives"};
    table.check_keys(keys);
    const std::string name = clean_text(table.text("name", ""));
    std::size_t found = 0;
    for (Instance& instance : model.instances) {
        if (instance.name == name) {
            order(table, std::span(&instance, 1));
            ++found;
        }
    }
    if (found == 0) {
        fail("{}: no object is named '{}'; the names are those of the files' nodes and groups", table.where(), name);
    }
}

// Stood up where the table says that the file's z points up; looked at where it says nothing.
dmat4 upright(const TomlTable& table, Model& part) {
    const std::string up = table.text("up", "");
    if (!up.empty() && up != "y" && up != "z") {
        table.wrong("up", "y or z");
    }
    if (up.empty()) {
        note_side(part);
    }
    return up == "z" ? y_up_from_z_up() : dmat4(1.0);
}

void add_file(const TomlTable& table, const Folder& folder, const Assets& assets, Model& model) {
    static constexpr std::array<std::string_view, 8> keys{"path",       "up",    "translate", "rotate",
                                                          "quaternion", "scale", "casts",     "receives"};
    table.check_keys(keys);
    const std::size_t first = model.instances.size();
    const std::string name = table.text("path", "");
    std::filesystem::path path;
    try {
        path = folder.resolve(name);
    } catch (const Error& problem) {
        fail("{}: path {}", table.where(), problem.what());
    }
    Model part = load_model(path, assets, false);
    const dmat4 ws_from_model = placement(table) * upright(table, part);
    for (std::string& note : part.notes) {
        note = fmt::format("'{}': {}", clean_text(name), note);
    }
    append_model(model, std::move(part), ws_from_model);
    order(table, std::span(model.instances).subspan(first));

    // The same file placed again and again must not outgrow the limits before anyone looks.
    std::size_t triangles = 0;
    for (const Mesh& mesh : model.meshes) {
        triangles += mesh.triangles.size();
    }
    if (triangles > max_triangles) {
        fail("{}: more than {} triangles", table.where(), max_triangles);
    }
}

std::uint32_t kind_of(const TomlTable& table) {
    const std::string kind = table.text("kind", "");
    for (std::uint32_t value = GN_LIGHT_DIRECTIONAL; value <= GN_LIGHT_RECTANGLE; ++value) {
        if (kind == light_kind_names.at(value)) {
            return value;
        }
    }
    table.wrong("kind", "directional, spot, point or rectangle");
}

// A unit vector, from `direction` or towards `look_at`.
dvec3 read_direction(const TomlTable& table, dvec3 position, dvec3 otherwise) {
    if (table.has("direction") && table.has("look_at")) {
        fail("{}: give either direction or look_at", table.where());
    }
    const bool looks = table.has("look_at");
    const dvec3 direction =
        looks ? table.vector("look_at", otherwise) - position : table.vector("direction", otherwise);
    if (!(glm::length(direction) > 0.0)) {
        table.wrong(looks ? "look_at" : "direction",
                    looks ? "a point other than the position" : "a list of 3 numbers, not all 0");
    }
    return glm::normalize(direction);
}

double not_negative(const TomlTable& table, std::string_view key, double otherwise) {
    const double value = table.number(key, otherwise);
    if (value < 0.0) {
        table.wrong(key, "0 or more");
    }
    return value;
}

// The picture in front of a light, as a texture of the model.
int add_cookie(const TomlTable& table, const GnLight& shape, const Folder& folder, Model& model) {
    if (!table.has("cookie")) {
        return -1;
    }
    if (!gn_takes_cookie(shape)) {
        fail("{}: key 'cookie' is of directional lights, of points and of spots with outer_deg below 90; {}",
             table.where(),
             shape.kind == GN_LIGHT_RECTANGLE ? "rays from a rectangle cross, so that it throws no picture"
                                              : "this spot's cone is no narrower than a half space");
    }
    const std::string name = table.text("cookie", "");
    model.textures.push_back({.name = clean_text(name),
                              .image = decode_image(read_file(folder.resolve(name)), clean_text(name)),
                              .repeat_u = shape.kind != GN_LIGHT_SPOT,
                              .repeat_v = shape.kind == GN_LIGHT_DIRECTIONAL});
    return static_cast<int>(model.textures.size()) - 1;
}

// The picture that a rectangle shows, likewise.
int add_emission(const TomlTable& table, const GnLight& shape, const Folder& folder, Model& model) {
    if (!table.has("texture")) {
        return -1;
    }
    if (!gn_takes_emission(shape)) {
        fail("{}: key 'texture' is of rectangles; {} has none", table.where(), light_kind_names.at(shape.kind));
    }
    const std::string name = table.text("texture", "");
    model.textures.push_back({.name = clean_text(name),
                              .image = decode_image(read_file(folder.resolve(name)), clean_text(name)),
                              .repeat_u = false,
                              .repeat_v = false});
    return static_cast<int>(model.textures.size()) - 1;
}

void add_light(const TomlTable& table, const Folder& folder, Model& model) {
    static constexpr std::array<std::string_view, 16> keys{
        "kind",      "name",   "position",           "direction", "look_at",   "up",        "color",
        "intensity", "radius", "angular_radius_deg", "size",      "inner_deg", "outer_deg", "range",
        "cookie",    "texture"};
    table.check_keys(keys);
    PlacedLight placed;
    GnLight& shape = placed.light.shape;
    shape.kind = kind_of(table);
    placed.light.name = clean_text(table.text("name", fmt::format("light {}", model.lights.size() + 1)));
    placed.position_ws = table.vector("position", dvec3(0.0));

    // Axes.
    const dvec3 direction = read_direction(table, placed.position_ws, dvec3(0, -1, 0));
    const bool vertical = std::abs(direction.y) > 0.999;
    dvec3 up = table.vector("up", vertical ? dvec3(0, 0, -1) : dvec3(0, 1, 0));
    up -= direction * glm::dot(direction, up);
    if (!(glm::length(up) > 1e-6)) {
        table.wrong("up", "a direction not parallel to the light's");
    }
    up = glm::normalize(up);
    shape.direction_ws = vec4(vec3(direction), 0.0F);
    shape.up_ws = vec4(vec3(up), 0.0F);
    shape.right_ws = vec4(vec3(glm::cross(direction, up)), 0.0F);

    // Brightness and size.
    shape.color = vec4(vec3(table.vector("color", dvec3(1.0))), 1.0F);
    shape.intensity = static_cast<float>(not_negative(table, "intensity", 1.0));
    shape.radius = static_cast<float>(not_negative(table, "radius", 0.0));
    shape.range = static_cast<float>(not_negative(table, "range", 0.0));
    shape.angular_radius = static_cast<float>(glm::radians(not_negative(table, "angular_radius_deg", 0.0)));
    if (const auto size = table.numbers("size", 2)) {
        if ((*size)[0] <= 0.0 || (*size)[1] <= 0.0) {
            table.wrong("size", "a list of 2 positive numbers, metres");
        }
        shape.half_size = vec2(0.5 * (*size)[0], 0.5 * (*size)[1]);
    } else if (shape.kind == GN_LIGHT_RECTANGLE) {
        fail("{}: a rectangle needs size = [width, height]", table.where());
    }
    const double outer = not_negative(table, "outer_deg", 45.0);
    shape.cos_outer = static_cast<float>(std::cos(glm::radians(outer)));
    shape.cos_inner = static_cast<float>(std::cos(glm::radians(not_negative(table, "inner_deg", 0.8 * outer))));
    placed.light.cookie = add_cookie(table, shape, folder, model);
    set_emission(shape, add_emission(table, shape, folder, model));
    model.lights.push_back(std::move(placed));
}

Light read_environment(const TomlTable& table) {
    table.check_keys(sky_keys);
    const auto number = [&](std::string_view key) {
        return table.has(key) ? std::optional(table.number(key, 0)) : std::nullopt;
    };
    const auto color = [&](std::string_view key) {
        return table.has(key) ? std::optional(table.vector(key, dvec3(0))) : std::nullopt;
    };
    const GivenSky given{.name = clean_text(table.text("name", "")),
                         .radiance = number("radiance"),
                         .illuminance = number("illuminance"),
                         .color = color("color"),
                         .above = color("above"),
                         .below = color("below"),
                         .zenith = color("zenith"),
                         .horizon = color("horizon"),
                         .seen = number("seen")};
    if (const std::string mistake = sky_mistake(given); !mistake.empty()) {
        fail("{}: {}", table.where(), mistake);
    }
    return light_of(given);
}

PlacedCamera read_camera(const TomlTable& table, const PlacedCamera& before) {
    PlacedCamera placed = before;
    placed.position_ws = table.vector("position", before.position_ws);
    const dvec3 otherwise(before.camera.forward_ws);
    placed.camera.forward_ws = vec3(read_direction(table, placed.position_ws, otherwise));
    placed.camera.up_ws = vec3(table.vector("up", dvec3(before.camera.up_ws)));
    const double degrees = table.number("yfov_deg", glm::degrees(static_cast<double>(before.camera.yfov)));
    if (!(degrees > 0.1 && degrees < 175.0)) {
        table.wrong("yfov_deg", "between 0.1 and 175");
    }
    placed.camera.yfov = static_cast<float>(glm::radians(degrees));
    if (table.has("half_height") && table.has("yfov_deg")) {
        table.wrong("yfov_deg", "absent where half_height is given: an orthographic camera has no angle");
    }
    placed.camera.half_height =
        static_cast<float>(not_negative(table, "half_height", static_cast<double>(before.camera.half_height)));
    placed.camera.near = static_cast<float>(not_negative(table, "near", static_cast<double>(before.camera.near)));
    placed.camera.far = static_cast<float>(not_negative(table, "far", static_cast<double>(before.camera.far)));
    return placed;
}

PlacedCamera unset_camera(std::string name) {
    PlacedCamera placed;
    placed.camera.name = std::move(name);
    placed.camera.near = 0.0F;
    placed.camera.far = 0.0F;
    return placed;
}

void add_camera(const TomlTable& table, Model& model) {
    static constexpr std::array<std::string_view, 9> keys{"name",     "position",    "look_at", "direction", "up",
                                                          "yfov_deg", "half_height", "near",    "far"};
    table.check_keys(keys);
    const std::string otherwise = model.cameras.empty() ? "main" : fmt::format("view {}", model.cameras.size() + 1);
    model.cameras.push_back(read_camera(table, unset_camera(clean_text(table.text("name", otherwise)))));
}

PlacedCamera between(const PlacedCamera& a, const PlacedCamera& b, double t) {
    PlacedCamera frame = a;
    const auto s = static_cast<float>(t);
    frame.position_ws = glm::mix(a.position_ws, b.position_ws, t);
    // Great-circle arcs keep the angular speed even.
    const double angle =
        std::acos(std::clamp(glm::dot(dvec3(a.camera.forward_ws), dvec3(b.camera.forward_ws)), -1.0, 1.0));
    if (angle > 1e-6 && angle < 3.14) {
        const double sine = std::sin(angle);
        frame.camera.forward_ws = vec3((std::sin((1.0 - t) * angle) * dvec3(a.camera.forward_ws) +
                                        std::sin(t * angle) * dvec3(b.camera.forward_ws)) /
                                       sine);
    }
    frame.camera.up_ws = glm::mix(a.camera.up_ws, b.camera.up_ws, s);
    frame.camera.yfov = glm::mix(a.camera.yfov, b.camera.yfov, s);
    frame.camera.half_height = glm::mix(a.camera.half_height, b.camera.half_height, s);
    frame.camera.near = glm::mix(a.camera.near, b.camera.near, s);
    frame.camera.far = glm::mix(a.camera.far, b.camera.far, s);
    return frame;
}

// Keyframes become frames: key i stands at frame `frame` (in order), the frames between are interpolated.
void add_path(const TomlTable& table, Model& model) {
    static constexpr std::array<std::string_view, 2> path_keys{"name", "key"};
    static constexpr std::array<std::string_view, 9> frame_keys{"frame",    "position",    "look_at", "direction", "up",
                                                                "yfov_deg", "half_height", "near",    "far"};
    table.check_keys(path_keys);
    PlacedPath path{clean_text(table.text("name", fmt::format("path {}", model.paths.size() + 1))), {}};
    PlacedCamera before = unset_camera(path.name);
    for (const TomlTable& key : table.tables("key")) {
        key.check_keys(frame_keys);
        const PlacedCamera camera = read_camera(key, before);
        const auto first = static_cast<double>(path.frames.size());
        const double frame = key.number("frame", path.frames.empty() ? 0.0 : first);
        if (frame != std::floor(frame) || frame > most_frames || (path.frames.empty() ? frame != 0.0 : frame < first)) {
            key.wrong("frame",
                      fmt::format("a whole number, 0 for the first key and then growing, at most {}", most_frames));
        }
        if (!path.frames.empty() && is_orthographic(camera.camera) != is_orthographic(before.camera)) {
            key.wrong("half_height", "above 0 in all keys of a path or in none");
        }
        const double span = frame - first + 1.0;
        for (double i = 1.0; i < span; i += 1.0) {
            path.frames.push_back(between(before, camera, i / span));
        }
        path.frames.push_back(camera);
        before = camera;
    }
    if (path.frames.empty()) {
        fail("{}: a path needs at least one [[path.key]]", table.where());
    }
    model.paths.push_back(std::move(path));
}

}  // namespace

Model load_toml(const std::filesystem::path& path, const Assets& assets) {
    const std::string shown = clean_text(path.string());
    const std::vector<std::byte> bytes = read_file(path, largest_scene_file);
    toml::table root;
    try {
        root = toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), shown);
    } catch (const toml::parse_error& problem) {
        fail("{}: line {}: {}", shown, problem.source().begin.line, clean_text(problem.description()));
    }

    static constexpr std::array<std::string_view, 6> keys{"file", "object", "light", "environment", "camera", "path"};
    const TomlTable table(root, shown);
    table.check_keys(keys);
    const Folder folder(path, assets);
    // The user named this folder: what the scene places may use all of it, not only the folder that it lies in itself.
    Assets allowed = assets;
    allowed.push_back(folder.root());
    Model model;
    for (const TomlTable& light : table.tables("light")) {
        add_light(light, folder, model);
    }
    if (const std::optional<TomlTable> sky = table.inner("environment")) {
        model.environment = read_environment(*sky);
    }
    for (const TomlTable& camera : table.tables("camera")) {
        add_camera(camera, model);
    }
    for (const TomlTable& file : table.tables("file")) {
        add_file(file, folder, allowed, model);
    }
    for (std::string& note : folder.take_notes()) {
        add_note(model.notes, std::move(note));
    }
    for (const TomlTable& object : table.tables("object")) {
        order_object(object, model);
    }
    for (const TomlTable& moving : table.tables("path")) {
        add_path(moving, model);
    }
    return model;
}

}  // namespace gn
