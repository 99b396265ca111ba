// SPDX-License-Identifier: MIT
// From a name on the command line to a finished scene.
#include "base/error.h"
#include "shadow/scene/files/files.h"
#include "shadow/scene/files/upright.h"
#include "shadow/scene/model.h"
#include "shadow/scene/rig.h"

#include <algorithm>

namespace gn {

namespace {

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return extension;
}

// What Assimp reads and is worth the risk of its parsers.
constexpr std::array through_assimp{".ply", ".stl", ".off", ".dae", ".fbx", ".3ds"};

bool is_known(const std::string& extension) {
    static constexpr std::array own{".gltf", ".glb", ".obj", ".toml"};
    return std::find(own.begin(), own.end(), extension) != own.end() ||
           std::find(through_assimp.begin(), through_assimp.end(), extension) != through_assimp.end();
}

// Turned where that is asked for, pointed out where it shows and is not.
Model load_upright(const std::filesystem::path& path, const LoadOptions& options) {
    Model model = load_model(path, options.assets, true);
    if (options.up == UpAxis::y) {
        // What a scene places has been looked at one by one.
        if (lower_extension(path) != ".toml") {
            note_side(model);
        }
        return model;
    }
    Model upright;
    append_model(upright, std::move(model), y_up_from_z_up());
    return upright;
}

}  // namespace

Model load_model(const std::filesystem::path& path, const Assets& assets, bool toml_allowed) {
    const std::string extension = lower_extension(path);
    if (extension == ".gltf" || extension == ".glb") {
        return load_gltf(path, assets);
    }
    if (extension == ".obj") {
        return load_obj(path, assets);
    }
    if (extension == ".toml" && toml_allowed) {
        return load_toml(path, assets);
    }
    if (std::find(through_assimp.begin(), through_assimp.end(), extension) != through_assimp.end()) {
        return load_assimp(path, assets);
    }
    fail("{}: files of type '{}' are not read; known are .glb .gltf .obj{} {}", clean_text(path.string()),
         clean_text(extension), toml_allowed ? " .toml" : "", fmt::join(through_assimp, " "));
}

namespace {

// Where the vertices of every instance begin in the flat scene.
void number_followers(Model& model) {
    std::size_t vertex = 0;
    for (const Instance& instance : model.instances) {
        if (instance.follower) {
            model.rig.followers[*instance.follower].first_vertex = static_cast<std::uint32_t>(vertex);
        }
        vertex += model.meshes[instance.mesh].positions_os.size();
    }
}

}  // namespace

Scene load_scene(const std::string& name_or_path, const LoadOptions& options) {
    return load_animated_scene(name_or_path, options).scene;
}

AnimatedScene load_animated_scene(const std::string& name_or_path, const LoadOptions& options) {
    // A path is what exists or looks like one; everything else is a built-in name.
    const std::filesystem::path path(name_or_path);
    std::error_code error;
    const bool is_path = is_known(lower_extension(path)) || name_or_path.find('/') != std::string::npos ||
                         std::filesystem::exists(path, error);
    AnimatedScene loaded;
    Scene& scene = loaded.scene;
    try {
        if (is_path) {
            Model model = load_upright(path, options);
            scene = flatten(model);
            number_followers(model);
            loaded.rig = std::move(model.rig);
            scene.name = clean_text(path.stem().string());
        } else {
            scene = make_builtin_scene(name_or_path);
            if (options.ground.kind == Ground::at_height) {
                fail("scene '{}' is built in and has its own ground; a height is for files", name_or_path);
            }
            if (options.up != UpAxis::y) {
                fail("scene '{}' is built in and stands upright; --up is for files", name_or_path);
            }
        }
        LoadOptions finish = options;
        finish.ground = is_path ? options.ground : Ground{};
        const std::size_t vertices = scene.positions_ws.size();
        const std::vector<std::uint32_t> copies = finish_and_copy(scene, finish);
        if (loaded.rig.moves()) {
            bind_rig(scene, loaded.rig, vertices, copies);
        }
    } catch (const std::bad_alloc&) {
        fail("{}: not enough memory for the scene", clean_text(name_or_path));
    } catch (const std::length_error&) {
        fail("{}: not enough memory for the scene", clean_text(name_or_path));
    }
    return loaded;
}

}  // namespace gn
