// SPDX-License-Identifier: MIT
// From a name on the command line to a finished scene.
#include "base/error.h"
#include "shadow/scene/files.h"
#include "shadow/scene/model.h"

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

}  // namespace

Model load_model(const std::filesystem::path& path, bool toml_allowed) {
    const std::string extension = lower_extension(path);
    if (extension == ".gltf" || extension == ".glb") {
        return load_gltf(path);
    }
    if (extension == ".obj") {
        return load_obj(path);
    }
    if (extension == ".toml" && toml_allowed) {
        return load_toml(path);
    }
    if (std::find(through_assimp.begin(), through_assimp.end(), extension) != through_assimp.end()) {
        return load_assimp(path);
    }
    fail("{}: files of type '{}' are not read; known are .glb .gltf .obj{} {}", clean_text(path.string()),
         clean_text(extension), toml_allowed ? " .toml" : "", fmt::join(through_assimp, " "));
}

Scene load_scene(const std::string& name_or_path, const LoadOptions& options) {
    // A path is what exists or looks like one; everything else is a built-in name.
    const std::filesystem::path path(name_or_path);
    std::error_code error;
    const bool is_path = is_known(lower_extension(path)) || name_or_path.find('/') != std::string::npos ||
                         std::filesystem::exists(path, error);
    Scene scene;
    try {
        if (is_path) {
            scene = flatten(load_model(path, true));
            scene.name = clean_text(path.stem().string());
        } else {
            scene = make_builtin_scene(name_or_path);
            if (options.ground.kind == Ground::at_height) {
                fail("scene '{}' is built in and has its own ground; a height is for files", name_or_path);
            }
        }
        finish_scene(scene, {is_path ? options.ground : Ground{}, options.aspect});
    } catch (const std::bad_alloc&) {
        fail("{}: not enough memory for the scene", clean_text(name_or_path));
    } catch (const std::length_error&) {
        fail("{}: not enough memory for the scene", clean_text(name_or_path));
    }
    return scene;
}

}  // namespace gn
