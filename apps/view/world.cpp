// SPDX-License-Identifier: MIT
#include "apps/view/world.h"

#include "apps/choose.h"
#include "apps/notes.h"

namespace gn {

World::World(Device& device, const std::string& name_, const FileOptions& file_, const Size& window)
    : name(name_),
      file(file_),
      loaded(reading([&] { return load_asked(name_, file_, window); })),
      as_loaded(scene.lights),
      gpu(upload_scene(device, scene)),
      staging_{UploadArena(device), UploadArena(device)} {
    say_notes(name, scene.notes);
}

void World::move_light(const std::string& words) {
    const std::size_t comma = std::min(words.find(','), words.size());
    Light& light = scene.lights[find_light(scene, words.substr(0, comma))];
    light.shape = parse_light(std::string_view(words).substr(std::min(comma + 1, words.size())), light.shape);
    ++lights_version;
}

std::vector<std::string> World::pose(const std::string& animation, double seconds) {
    // Lights as the scene has them move; what a hand changed of them is laid over that again.
    std::vector<std::string> words;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        words.push_back(text_of(scene.lights[i].shape, as_loaded[i].shape));
    }
    std::vector<std::string> remarks = pose_asked(loaded, animation, seconds);
    for (const CarriedLight& carried : loaded.rig.lights) {
        as_loaded[carried.light].shape = scene.lights[carried.light].shape;
        scene.lights[carried.light].shape = parse_light(words[carried.light], as_loaded[carried.light].shape);
        ++lights_version;
    }
    file.animation = animation;
    file.time = seconds;
    return remarks;
}

void World::bring(VkCommandBuffer commands, std::uint32_t slot) {
    staging_[slot].reset();
    record_refresh(commands, gpu, staging_[slot]);
    // The other frame in flight needs as much room.
    staging_[1 - slot].match(staging_[slot]);
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
