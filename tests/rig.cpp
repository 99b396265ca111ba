// SPDX-License-Identifier: MIT
#include "tests/rig.h"

#include "shadow/recipe/recipe.h"
#include "tests/thorough.h"

#include <map>

namespace gn::test {

Device& device() {
    static const std::unique_ptr<Device> instance = Device::create({.validation = true});
    return *instance;
}

ValidationGuard::~ValidationGuard() {
    for (std::size_t i = before; i < device().messages().size(); ++i) {
        ADD_FAILURE() << "validation: " << device().messages()[i];
    }
}

const Scene& built_in(const std::string& name) {
    static std::map<std::string, Scene> made;
    const auto found = made.find(name);
    return found != made.end() ? found->second : made.emplace(name, load_scene(name)).first->second;
}

std::vector<std::string> drawn_recipes() {
    return picked(recipe_names());
}

std::string with_few_points(const Recipe& recipe, const std::string& text) {
    std::string few = text;
    for (const Part* part : recipe.parts()) {
        if (!thorough() && part->params.find("lights") != nullptr) {
            few += fmt::format(",{}.lights=4", part->id);
        } else if (!thorough() && part->add_light != nullptr && part->params.find("levels") != nullptr) {
            few += fmt::format(",{}.levels=1", part->id);
        } else if (!thorough() && part->place != nullptr && part->params.find("levels") != nullptr) {
            few += fmt::format(",{}.levels=4", part->id);
        } else if (!thorough() && part->add_direct != nullptr && part->params.find("samples") != nullptr) {
            few += fmt::format(",{}.samples=4", part->id);
        }
    }
    return few;
}

std::string with_small_maps(const std::string& recipe, uint resolution) {
    const Recipe read = load_recipe(recipe);
    const bool maps = read.map != nullptr || (read.direct != nullptr && holds(read.direct->reads, "resolution"));
    return with_few_points(read, recipe) + (maps ? fmt::format(",resolution={}", resolution) : "");
}

Comparison::Comparison(Scene given) : scene(std::move(given)) {}
Comparison::Comparison(Comparison&&) noexcept = default;
Comparison::~Comparison() = default;

Comparison compare(Scene scene, const std::string& recipe, const ComparisonOptions& options) {
    const ValidationGuard guard;
    Comparison c(std::move(scene));
    SceneGpu gpu = upload_scene(device(), c.scene);
    c.frame = render_frame(device(), gpu, c.scene.camera(options.view), load_recipe(recipe),
                           {.width = options.width, .height = options.height, .only_light = 0, .picture = false});
    EXPECT_EQ(c.frame.refused.front(), "");
    c.truth = Truth(c.scene).trace(c.frame.samples.position_ws, c.frame.samples.normal_ws, c.scene.lights.front(),
                                   {.samples = options.samples});
    c.errors = visibility_errors(c.frame.visibility.front().values, c.truth.visibility, c.truth.counted,
                                 static_cast<int>(options.width), static_cast<int>(options.height));
    // What is asserted of a comparison is asserted of a good part of the picture.
    EXPECT_GT(c.errors.samples, c.visibility().values.size() / 50) << c.scene.name << " with " << recipe;
    return c;
}

Comparison compare(const std::string& scene, const std::string& recipe, const ComparisonOptions& options) {
    return compare(scene.find('/') == std::string::npos ? built_in(scene) : load_scene(scene), recipe, options);
}

}  // namespace gn::test
