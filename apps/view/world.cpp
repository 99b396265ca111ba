// SPDX-License-Identifier: MIT
#include "apps/view/world.h"

#include "apps/choose.h"
#include "apps/notes.h"

namespace gn {

World::World(Device& device, const std::string& name_, const FileOptions& file_, const Size& window)
    : name(name_),
      file(file_),
      scene(reading([&] { return load_scene(name_, load_options(file_, window)); })),
      as_loaded(scene.lights),
      gpu(upload_scene(device, scene)) {
    say_notes(name, scene.notes);
}

void World::move_light(const std::string& words) {
    const std::size_t comma = std::min(words.find(','), words.size());
    Light& light = scene.lights[find_light(scene, words.substr(0, comma))];
    light.shape = parse_light(std::string_view(words).substr(std::min(comma + 1, words.size())), light.shape);
    ++lights_version;
}

std::vector<std::string> World::moved_lights() const {
    std::vector<std::string> moved;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const std::string words = text_of(scene.lights[i].shape, as_loaded[i].shape);
        if (!words.empty()) {
            moved.push_back(scene.lights[i].name + "," + words);
        }
    }
    return moved;
}

float World::size() const {
    return std::max(glm::length(scene.bounds_ws.max - scene.bounds_ws.min), 1e-6F);
}

}  // namespace gn
