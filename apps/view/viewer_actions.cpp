// SPDX-License-Identifier: MIT
// What the panel, the keyboard and a session change.
#include "apps/choose.h"
#include "apps/output.h"
#include "apps/view/viewer.h"
#include "shadow/shading/tonemap.h"

namespace gn {

void Viewer::make_viewports(const std::vector<ViewportSetup>& setups) {
    std::vector<std::shared_ptr<Viewport>> made;
    for (const ViewportSetup& setup : setups) {
        made.push_back(std::make_shared<Viewport>(device_, *world_, setup, 2));
        made.back()->begin(slot_);
        if (linked) {
            made.back()->camera = made.front()->camera;
        }
        if (against == Against::recipe) {
            made.back()->other.ask(RecipeText::parse(other_text));
        }
    }
    vkDeviceWaitIdle(device_.vk());
    viewports_ = std::move(made);
    selected = std::min(selected, viewports_.size() - 1);
}

void Viewer::apply(const ViewSetup& setup) {
    linked = setup.linked;
    against = setup.against;
    other_text = setup.other;
    split = setup.split;
    error = setup.error;
    stops = setup.stops;
    panel = setup.panel;
    picture = setup.picture;
    light = setup.light.empty() ? 0 : find_light(world_->scene, setup.light);
    for (const std::string& words : setup.lights) {
        world_->move_light(words);
    }
    scene_field = world_->name;
    selected = 0;
    plays = animates = setup.plays;
}

void Viewer::swap_world(std::unique_ptr<World> world, const std::vector<ViewportSetup>& setups) {
    // What the old one left is of no use to the new one.
    finish();
    vkDeviceWaitIdle(device_.vk());
    worker_.reset();
    truth_.reset();
    truth_key_.clear();
    viewports_.clear();
    world_ = std::move(world);
    light = 0;
    path_frame = 0;
    plays = animates = false;
    scene_field = world_->name;
    make_viewports(setups);
}

void Viewer::load(const std::string& scene, const FileOptions& file) {
    trying([&] {
        FileOptions at_rest = file;
        at_rest.animation.clear();
        at_rest.time = 0;
        auto world = std::make_unique<World>(device_, scene, at_rest, first_.window);
        std::vector<ViewportSetup> setups = viewport_setups(false);
        swap_world(std::move(world), setups);
        message = fmt::format("{}: {} triangles, {} lights", scene, world_->scene.triangles.size(),
                              world_->scene.lights.size());
    });
}

void Viewer::load_session(const std::string& path) {
    trying([&] {
        const ViewSetup setup = read_session(path);
        auto world = std::make_unique<World>(device_, setup.scene, setup.file, setup.window);
        for (const std::string& words : setup.lights) {
            world->move_light(words);
        }
        ViewSetup rest = setup;
        rest.lights.clear();
        against = setup.against;
        other_text = setup.other;
        linked = setup.linked;
        swap_world(std::move(world), setup.viewports);
        apply(rest);
        message = "loaded " + path;
    });
}

void Viewer::save_session(const std::string& path) {
    trying([&] {
        write_text(path, toml_of(setup()));
        message = "saved " + path;
    });
}

std::vector<ViewportSetup> Viewer::viewport_setups(bool with_cameras) const {
    std::vector<ViewportSetup> setups;
    for (const std::shared_ptr<Viewport>& viewport : viewports_) {
        ViewportSetup& setup = setups.emplace_back();
        setup.recipe = viewport->recipe.text().text();
        setup.show = viewport->show;
        if (with_cameras) {
            // The scene's own camera goes by its name.
            const std::vector<Camera>& cameras = world_->scene.cameras;
            const std::string words = text_of(viewport->camera);
            const auto found = std::find_if(cameras.begin(), cameras.end(),
                                            [&](const Camera& camera) { return text_of(camera) == words; });
            setup.view = found != cameras.end() ? found->name : "";
            setup.camera = found != cameras.end() ? "" : words;
        }
    }
    return setups;
}

ViewSetup Viewer::setup() const {
    ViewSetup now = first_;
    now.scene = world_->name;
    now.file = world_->file;
    now.viewports = viewport_setups(true);
    now.lights = world_->moved_lights();
    now.linked = linked;
    now.against = against;
    now.other = other_text;
    now.split = split;
    now.error = error;
    now.light = light == 0 ? "" : world_->scene.lights.at(light).name;
    now.stops = stops;
    now.panel = panel;
    now.picture = picture;
    if (window_ != nullptr && window_->size().x > 0) {
        now.window = {static_cast<int>(window_->size().x), static_cast<int>(window_->size().y)};
    }
    return now;
}

void Viewer::set_recipe(std::size_t viewport, const std::string& text) {
    trying([&] { viewports_.at(viewport)->recipe.ask(RecipeText::parse(text)); });
}

void Viewer::set_key(std::size_t viewport, std::string_view key, const std::string& value) {
    trying([&] {
        LiveRecipe& live = viewports_.at(viewport)->recipe;
        ChangedRecipe changed = change_recipe(live.text(), key, value);
        live.ask(changed.text, std::move(changed.recipe));
        message.clear();
    });
}

void Viewer::set_other(const std::string& text) {
    trying([&] {
        for (const std::shared_ptr<Viewport>& viewport : viewports_) {
            viewport->other.ask(RecipeText::parse(text));
        }
        other_text = text;
    });
}

void Viewer::add_viewport() {
    if (viewports_.size() == most_viewports) {
        message = fmt::format("{} viewports are the most that are shown", most_viewports);
        return;
    }
    trying([&] {
        ViewportSetup setup = viewport_setups(true).at(selected);
        viewports_.push_back(std::make_shared<Viewport>(device_, *world_, setup, 2));
        viewports_.back()->begin(slot_);
        viewports_.back()->camera = viewports_.at(selected)->camera;
        if (against == Against::recipe) {
            viewports_.back()->other.ask(RecipeText::parse(other_text));
        }
        selected = viewports_.size() - 1;
    });
}

void Viewer::remove_viewport(std::size_t viewport) {
    if (viewports_.size() == 1) {
        message = "the last viewport stays";
        return;
    }
    vkDeviceWaitIdle(device_.vk());
    viewports_.erase(viewports_.begin() + static_cast<std::ptrdiff_t>(viewport));
    selected = std::min(selected, viewports_.size() - 1);
}

void Viewer::set_camera(std::size_t viewport, const Camera& camera, bool cut) {
    for (std::size_t i = 0; i < viewports_.size(); ++i) {
        if (linked || i == viewport) {
            viewports_[i]->camera = camera;
            if (cut) {
                viewports_[i]->cut();
            }
        }
    }
}

void Viewer::set_pose(const std::string& animation, double seconds) {
    trying([&] {
        // What is traced, is traced of the scene as it stood.
        worker_.reset();
        truth_.reset();
        truth_key_.clear();
        std::vector<std::string> looked;
        for (const Camera& camera : world_->scene.cameras) {
            looked.push_back(text_of(camera));
        }
        const std::vector<std::string> remarks = world_->pose(animation, seconds);
        message = remarks.empty() ? message : remarks.front();
        for (const std::shared_ptr<Viewport>& viewport : viewports_) {
            const auto through = std::find(looked.begin(), looked.end(), text_of(viewport->camera));
            if (through != looked.end()) {
                viewport->camera = world_->scene.cameras[static_cast<std::size_t>(through - looked.begin())];
            }
        }
    });
}

void Viewer::take_window(const std::filesystem::path& path) {
    take_window_ = path;
}

void Viewer::take_pictures(const std::filesystem::path& folder, const std::string& name) {
    trying([&] {
        std::filesystem::create_directories(folder);
        message = "wrote pictures to " + folder.string();
        for (std::size_t i = 0; i < viewports_.size(); ++i) {
            if (!viewports_[i]->show.empty()) {
                message += fmt::format("; none of viewport {}, which shows {}", i + 1, viewports_[i]->show);
                continue;
            }
            const std::string recipe = slug(viewports_[i]->recipe.text().text());
            const bool again = std::any_of(viewports_.begin(), viewports_.begin() + static_cast<std::ptrdiff_t>(i),
                                           [&](const auto& o) { return slug(o->recipe.text().text()) == recipe; });
            const std::string file = fmt::format("{}-{}{}.png", name, recipe, again ? fmt::format("-{}", i + 1) : "");
            viewports_[i]->ask_picture([this, path = folder / file](const Image& radiance) {
                trying([&] { write_png(path, tonemap(radiance, automatic_exposure(radiance))); });
            });
        }
    });
}

}  // namespace gn
