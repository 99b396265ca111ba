// SPDX-License-Identifier: MIT
#include "apps/choose.h"

#include "base/error.h"
#include "base/param.h"

#include <cstdlib>

namespace gn {

void set_device_threads(int threads) {
    if (threads > 0) {
        setenv("LP_NUM_THREADS", fmt::format("{}", threads).c_str(), 0);
    }
}

LoadOptions load_options(const FileOptions& file, const Size& size) {
    const GroundOption& ground = file.ground;
    LoadOptions options;
    options.ground.kind = ground.height ? Ground::at_height : ground.automatic ? Ground::automatic : Ground::none;
    options.ground.height = ground.height.value_or(0.0);
    options.aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    options.up = file.up;
    options.assets.assign(file.assets.begin(), file.assets.end());
    return options;
}

AnimatedScene load_asked(const std::string& scene, const FileOptions& file, const Size& size) {
    if (file.animation.empty() && file.time != 0) {
        fail("--time {}: it is a time of an animation; name one with --animation", file.time);
    }
    AnimatedScene loaded = load_animated_scene(scene, load_options(file, size));
    if (!file.animation.empty()) {
        for (std::string& remark : pose_asked(loaded, file.animation, file.time)) {
            loaded.scene.notes.push_back(std::move(remark));
        }
    }
    return loaded;
}

std::vector<std::string> pose_asked(AnimatedScene& loaded, const std::string& animation, double seconds) {
    const std::optional<std::size_t> index =
        animation.empty() ? std::nullopt : std::optional(find_animation(loaded.rig, animation));
    return pose_scene(loaded.scene, loaded.rig, index, seconds);
}

std::size_t find_light(const Scene& scene, const std::string& name) {
    std::vector<std::string_view> known;
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        if (scene.lights[l].name == name) {
            return l;
        }
        known.push_back(scene.lights[l].name);
    }
    fail("--light: scene '{}' has no light '{}'; {}", scene.name, name, suggest(name, known));
}

const CameraPath& find_path(const Scene& scene, const std::string& name) {
    if (scene.paths.empty()) {
        fail("--path: scene '{}' has no camera path; 'corridor' has one, and .toml scenes may place them", scene.name);
    }
    std::vector<std::string_view> known;
    for (const CameraPath& path : scene.paths) {
        if (name.empty() || path.name == name) {
            return path;
        }
        known.push_back(path.name);
    }
    fail("--path: scene '{}' has no camera path '{}'; {}", scene.name, name, suggest(name, known));
}

std::optional<Recipe> recipe_if_sound(const std::string& name) {
    try {
        return load_recipe(name);
    } catch (const Error& error) {
        fmt::print(stderr, "gnomon: left out: {}\n", error.what());
        return std::nullopt;
    }
}

}  // namespace gn
