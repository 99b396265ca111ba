// SPDX-License-Identifier: MIT
// From instances in double precision to one flat scene of floats in world space.
#include "base/error.h"
#include "shadow/scene/emission.h"
#include "shadow/scene/main_mass.h"
#include "shadow/scene/model.h"

#include <cmath>

namespace gn {

void add_note(std::vector<std::string>& notes, std::string note) {
    constexpr std::size_t most = 200;
    if (notes.size() < most) {
        notes.push_back(std::move(note));
    } else if (notes.size() == most) {
        notes.emplace_back("Further notes were left out.");
    }
}

void note_count(std::vector<std::string>& notes, std::size_t count, const char* one, const char* many) {
    if (count > 0) {
        add_note(notes, count == 1 ? one : fmt::format(fmt::runtime(many), count));
    }
}

void note_lost_mask(std::vector<std::string>& notes, const std::string& material) {
    add_note(notes, fmt::format("Material '{}' has lost its mask: where it had holes it is solid.", material));
}

namespace {

bool finite_d(dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check_size(const Model& model) {
    std::size_t triangles = 0;
    for (const Instance& instance : model.instances) {
        triangles += model.meshes[instance.mesh].triangles.size();
    }
    if (triangles > max_triangles) {
        fail("the scene has {} triangles after instancing; at most {} are supported", triangles, max_triangles);
    }
    if (model.instances.size() > max_instances) {
        fail("the scene has {} instances; at most {} are supported", model.instances.size(), max_instances);
    }
}

std::array<dvec3, 3> corners_of(const Model& model, const Instance& instance, uvec3 t) {
    const Mesh& mesh = model.meshes[instance.mesh];
    const auto corner = [&](uint v) { return dvec3(instance.ws_from_os * dvec4(mesh.positions_os.at(v), 1.0)); };
    return {corner(t.x), corner(t.y), corner(t.z)};
}

template <class Visit>
void visit_triangles(const Model& model, std::size_t step, const Visit& visit) {
    std::size_t index = 0;
    for (const Instance& instance : model.instances) {
        const Mesh& mesh = model.meshes[instance.mesh];
        for (const uvec3 t : mesh.triangles) {
            const bool inside = std::max({t.x, t.y, t.z}) < mesh.positions_os.size();
            if (index++ % step == 0 && inside) {
                const std::array<dvec3, 3> corners = corners_of(model, instance, t);
                if (finite_d(corners[0]) && finite_d(corners[1]) && finite_d(corners[2])) {
                    visit(corners);
                }
            }
        }
    }
}

// The origin from the exact positions, so that subtracting it comes before rounding.
dvec3 find_origin(const Model& model) {
    // Learn from a part of the triangles where the main mass is.
    std::size_t count = 0;
    for (const Instance& instance : model.instances) {
        count += model.meshes[instance.mesh].triangles.size();
    }
    std::vector<TriangleSample> samples;
    visit_triangles(model, std::max<std::size_t>(1, count / most_triangle_samples), [&](const auto& corners) {
        samples.push_back(
            {corners, std::sqrt(0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])))});
    });
    const Fence fence = find_fence(samples);

    // Bound all that belongs to it.
    dvec3 min(std::numeric_limits<double>::max());
    dvec3 max(std::numeric_limits<double>::lowest());
    visit_triangles(model, 1, [&](const auto& corners) {
        const dvec3 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
        const dvec3 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
        if (fence.meets(low, high)) {
            min = glm::min(min, low);
            max = glm::max(max, high);
        }
    });
    return min.x > max.x
               ? dvec3(0.0)
               : choose_origin(samples, min, max, model.cameras.empty() ? nullptr : &model.cameras.front().position_ws);
}

// Normals go with the cofactors, which unlike the inverse exist for every matrix; a zero result is completed later.
vec3 turn_normal(const glm::dmat3& cofactors, vec3 n_os) {
    const dvec3 n_ws = cofactors * dvec3(n_os);
    const double length = glm::length(n_ws);
    return std::isfinite(length) && length > 0.0 ? vec3(n_ws / length) : vec3(0.0F);
}

void write_instance(Scene& scene, const Mesh& mesh, const Instance& instance) {
    const auto first_vertex = static_cast<std::uint32_t>(scene.positions_ws.size());
    const glm::dmat3 linear(instance.ws_from_os);
    const double determinant = glm::determinant(linear);
    const bool mirrored = determinant < 0.0;
    glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                         glm::cross(linear[0], linear[1]));
    cofactors *= mirrored ? -1.0 : 1.0;

    // Move the vertices.
    for (std::size_t v = 0; v < mesh.positions_os.size(); ++v) {
        const dvec3 p_ws = dvec3(instance.ws_from_os * dvec4(mesh.positions_os[v], 1.0)) - scene.origin;
        scene.positions_ws.emplace_back(p_ws);
        scene.normals_ws.push_back(turn_normal(cofactors, mesh.normals_os[v]));
        scene.uvs.push_back(mesh.uvs[v]);
    }
    if (!mesh.colors.empty()) {
        scene.colors.resize(first_vertex, vec4(1.0F));
        scene.colors.insert(scene.colors.end(), mesh.colors.begin(), mesh.colors.end());
    }

    // Keep the winding's meaning under mirroring.
    Object object{.name = instance.name,
                  .first_triangle = static_cast<std::uint32_t>(scene.triangles.size()),
                  .triangle_count = static_cast<std::uint32_t>(mesh.triangles.size()),
                  .material = mesh.material,
                  .casts = instance.casts,
                  .receives = instance.receives.value_or(true)};
    for (const uvec3 t : mesh.triangles) {
        scene.triangles.push_back((mirrored ? uvec3(t.x, t.z, t.y) : t) + first_vertex);
    }
    scene.objects.push_back(std::move(object));
}

Camera place(const PlacedCamera& placed, dvec3 origin) {
    Camera camera = placed.camera;
    camera.position_ws = vec3(placed.position_ws - origin);
    return camera;
}

}  // namespace

Scene flatten(const Model& model) {
    check_size(model);
    Scene scene;
    scene.materials = model.materials;
    scene.textures = model.textures;
    scene.environment = model.environment;
    scene.notes = model.notes;
    scene.origin = find_origin(model);

    // Reserve once: growth by doubling would cost a second copy of the largest scenes.
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    for (const Instance& instance : model.instances) {
        vertices += model.meshes[instance.mesh].positions_os.size();
        triangles += model.meshes[instance.mesh].triangles.size();
    }
    if (vertices > std::numeric_limits<std::uint32_t>::max()) {
        fail("the scene has {} vertices after instancing; at most {} are supported", vertices,
             std::numeric_limits<std::uint32_t>::max());
    }
    scene.positions_ws.reserve(vertices);
    scene.normals_ws.reserve(vertices);
    scene.uvs.reserve(vertices);
    scene.triangles.reserve(triangles);
    scene.objects.reserve(model.instances.size());

    // Write geometry, lights and cameras relative to the origin.
    for (const Instance& instance : model.instances) {
        write_instance(scene, model.meshes[instance.mesh], instance);
    }
    for (const PlacedLight& placed : model.lights) {
        scene.lights.push_back(placed.light);
        scene.lights.back().shape.position_ws = vec4(vec3(placed.position_ws - scene.origin), 1.0F);
    }
    for (const PlacedCamera& placed : model.cameras) {
        scene.cameras.push_back(place(placed, scene.origin));
    }
    for (const PlacedPath& path : model.paths) {
        scene.paths.push_back({path.name, {}});
        for (const PlacedCamera& frame : path.frames) {
            scene.paths.back().frames.push_back(place(frame, scene.origin));
        }
    }
    return scene;
}

namespace {

vec3 turn_axis(const glm::dmat3& linear, vec3 axis) {
    const dvec3 turned = linear * dvec3(axis);
    const double length = glm::length(turned);
    return std::isfinite(length) && length > 0.0 ? vec3(turned / length) : axis;
}

}  // namespace

void move_camera(PlacedCamera& placed, const dmat4& ws_from_model) {
    const glm::dmat3 linear(ws_from_model);
    placed.position_ws = dvec3(ws_from_model * dvec4(placed.position_ws, 1.0));
    placed.camera.forward_ws = turn_axis(linear, placed.camera.forward_ws);
    placed.camera.up_ws = turn_axis(linear, placed.camera.up_ws);
    const auto scale = static_cast<float>(std::cbrt(std::abs(glm::determinant(linear))));
    placed.camera.half_height *= scale;
    placed.camera.near *= scale;
    placed.camera.far *= scale;
}

void move_light(PlacedLight& placed, const dmat4& ws_from_model) {
    const glm::dmat3 linear(ws_from_model);
    GnLight& shape = placed.light.shape;
    placed.position_ws = dvec3(ws_from_model * dvec4(placed.position_ws, 1.0));
    shape.direction_ws = vec4(turn_axis(linear, vec3(shape.direction_ws)), 0.0F);
    shape.right_ws = vec4(turn_axis(linear, vec3(shape.right_ws)), 0.0F);
    shape.up_ws = vec4(turn_axis(linear, vec3(shape.up_ws)), 0.0F);
    const auto scale = static_cast<float>(std::cbrt(std::abs(glm::determinant(linear))));
    shape.radius *= scale;
    shape.range *= scale;
    shape.half_size *= scale;
}

void append_model(Model& whole, Model part, const dmat4& ws_from_model) {
    // Renumber what the part refers to.
    const std::size_t first_mesh = whole.meshes.size();
    const int first_material = static_cast<int>(whole.materials.size());
    const int first_texture = static_cast<int>(whole.textures.size());
    for (Material& material : part.materials) {
        material.base_color_texture += material.base_color_texture >= 0 ? first_texture : 0;
    }
    for (Mesh& mesh : part.meshes) {
        mesh.material += first_material;
    }
    const std::size_t first_follower = whole.rig.followers.size();
    for (CarriedLight& carried : part.rig.lights) {
        carried.light += whole.lights.size();
    }
    for (CarriedCamera& carried : part.rig.cameras) {
        carried.camera += whole.cameras.size();
    }
    append_rig(whole.rig, std::move(part.rig), ws_from_model);
    for (Instance& instance : part.instances) {
        instance.mesh += first_mesh;
        instance.follower = instance.follower ? std::optional(*instance.follower + first_follower) : std::nullopt;
        instance.ws_from_os = ws_from_model * instance.ws_from_os;
    }

    // Move what stands in the world.
    for (PlacedLight& light : part.lights) {
        light.light.cookie += light.light.cookie >= 0 ? first_texture : 0;
        const int emission = gn_emission_texture(light.light.shape);
        set_emission(light.light.shape, emission + (emission >= 0 ? first_texture : 0));
        move_light(light, ws_from_model);
    }
    for (PlacedCamera& camera : part.cameras) {
        move_camera(camera, ws_from_model);
    }
    for (PlacedPath& path : part.paths) {
        for (PlacedCamera& frame : path.frames) {
            move_camera(frame, ws_from_model);
        }
    }

    const auto take = [](auto& to, auto& from) {
        to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
    };
    take(whole.meshes, part.meshes);
    take(whole.instances, part.instances);
    take(whole.materials, part.materials);
    take(whole.textures, part.textures);
    take(whole.lights, part.lights);
    whole.environment = whole.environment ? whole.environment : part.environment;
    take(whole.cameras, part.cameras);
    take(whole.paths, part.paths);
    for (std::string& sentence : part.notes) {
        add_note(whole.notes, std::move(sentence));
    }
}

}  // namespace gn
