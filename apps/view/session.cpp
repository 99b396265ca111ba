// SPDX-License-Identifier: MIT
// A session as a file, and as a command line.
#include "apps/output.h"
#include "apps/view/setup.h"
#include "base/param.h"
#include "base/toml_scalar.h"

#include <algorithm>
#include <sstream>

namespace gn {
namespace {

constexpr std::array<std::string_view, 17> session_keys{
    "scene", "ground", "up",     "assets",    "linked", "against", "other",   "split",   "error",
    "light", "stops",  "lights", "animation", "time",   "window",  "picture", "viewport"};
constexpr std::array<std::string_view, 4> viewport_keys{"recipe", "view", "camera", "show"};

std::string text_of(const Size& size) {
    return fmt::format("{}x{}", size.width, size.height);
}

std::string ground_text(const GroundOption& ground) {
    return ground.height ? fmt::format("{}", *ground.height) : ground.automatic ? "auto" : "none";
}

/// The value of a key, or what stood there before.
template <class Value>
void take(const toml::table& table, std::string_view key, Value& value, const std::string& where) {
    const toml::node* node = table.get(key);
    if (node == nullptr) {
        return;
    }
    const std::optional<Value> found = node->value<Value>();
    if (!found) {
        fail("{}: {} must be {}", where, key,
             std::is_same_v<Value, bool>          ? "true or false"
             : std::is_same_v<Value, std::string> ? "a text"
                                                  : "a number");
    }
    value = *found;
}

std::vector<std::string> texts_of(const toml::table& table, std::string_view key, const std::string& where) {
    std::vector<std::string> texts;
    if (const toml::node* node = table.get(key)) {
        const toml::array* list = node->as_array();
        for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
            texts.push_back(list->get(i)->value_or(std::string()));
        }
        if (list == nullptr || std::find(texts.begin(), texts.end(), "") != texts.end()) {
            fail("{}: {} must be a list of texts", where, key);
        }
    }
    return texts;
}

ViewportSetup viewport_of(const toml::table& table, const std::string& where) {
    check_toml_keys(table, viewport_keys, where);
    ViewportSetup viewport;
    take(table, "recipe", viewport.recipe, where);
    take(table, "view", viewport.view, where);
    take(table, "camera", viewport.camera, where);
    take(table, "show", viewport.show, where);
    return viewport;
}

toml::table table_of(const std::string& path) {
    try {
        return toml::parse(read_text(path), path);
    } catch (const toml::parse_error& error) {
        fail("{}: line {} is not valid TOML: {}", path, error.source().begin.line, error.description());
    }
}

}  // namespace

std::string toml_of(const ViewSetup& setup) {
    const auto list = [](const std::vector<std::string>& texts) {
        toml::array array;
        for (const std::string& text : texts) {
            array.push_back(text);
        }
        return array;
    };
    toml::array viewports;
    for (const ViewportSetup& viewport : setup.viewports) {
        viewports.push_back(toml::table{{"recipe", viewport.recipe},
                                        {"view", viewport.view},
                                        {"camera", viewport.camera},
                                        {"show", viewport.show}});
    }
    toml::table table{{"scene", setup.scene},
                      {"ground", ground_text(setup.file.ground)},
                      {"up", setup.file.up == UpAxis::z ? "z" : "y"},
                      {"assets", list(setup.file.assets)},
                      {"linked", setup.linked},
                      {"against", against_names[static_cast<std::size_t>(setup.against)]},
                      {"other", setup.other},
                      {"split", static_cast<double>(setup.split)},
                      {"error", setup.error},
                      {"light", setup.light},
                      {"stops", static_cast<double>(setup.stops)},
                      {"lights", list(setup.lights)},
                      {"animation", setup.file.animation},
                      {"time", setup.file.time},
                      {"window", text_of(setup.window)},
                      {"picture", setup.picture ? text_of(*setup.picture) : std::string()},
                      {"viewport", std::move(viewports)}};
    std::stringstream text;
    text << "# A session of gnomon view; docs/view.md has the keys.\n" << table << "\n";
    return text.str();
}

ViewSetup read_session(const std::string& path) {
    const toml::table table = table_of(path);
    check_toml_keys(table, session_keys, path);
    ViewSetup setup;
    std::string ground = "auto", up = "y", against = "nothing", window = text_of(setup.window), picture;
    double split = 0.5, stops = 0;
    take(table, "scene", setup.scene, path);
    take(table, "ground", ground, path);
    take(table, "up", up, path);
    take(table, "linked", setup.linked, path);
    take(table, "against", against, path);
    take(table, "other", setup.other, path);
    take(table, "split", split, path);
    take(table, "error", setup.error, path);
    take(table, "light", setup.light, path);
    take(table, "stops", stops, path);
    take(table, "animation", setup.file.animation, path);
    take(table, "time", setup.file.time, path);
    take(table, "window", window, path);
    take(table, "picture", picture, path);
    setup.lights = texts_of(table, "lights", path);
    setup.file.assets = texts_of(table, "assets", path);
    setup.file.ground = parse_ground(ground);
    setup.file.up = parse_up(up);
    setup.window = parse_size(window);
    setup.picture = picture.empty() ? std::nullopt : std::optional(parse_size(picture));
    setup.split = static_cast<float>(std::clamp(split, 0.0, 1.0));
    setup.stops = static_cast<float>(std::clamp(stops, -16.0, 16.0));
    const auto found = std::find(against_names.begin(), against_names.end(), against);
    if (found == against_names.end()) {
        fail("{}: against = '{}' is not valid; {}", path, against, suggest(against, against_names));
    }
    setup.against = static_cast<Against>(found - against_names.begin());
    if (const toml::array* list = table.get_as<toml::array>("viewport")) {
        for (std::size_t i = 0; i < list->size(); ++i) {
            const toml::table* one = list->get(i)->as_table();
            setup.viewports.push_back(
                viewport_of(one != nullptr ? *one : toml::table{}, fmt::format("{}: [[viewport]] {}", path, i + 1)));
        }
    }
    if (setup.scene.empty() || setup.viewports.empty()) {
        fail("{}: is no session; it needs scene = \"NAME\" and at least one [[viewport]]", path);
    }
    return setup;
}

ViewSetup setup_of(const ViewOptions& options) {
    if (options.scene.empty() == options.session.empty()) {
        fail("view: give either a SCENE ('gnomon list scenes', or a file) or --session FILE");
    }
    ViewSetup setup = options.session.empty() ? ViewSetup{} : read_session(options.session);
    setup.panel = !options.no_panel;
    setup.plays = options.plays;
    if (!options.session.empty()) {
        return setup;
    }
    setup.scene = options.scene;
    setup.file = options.file;
    setup.linked = !options.own_cameras;
    setup.lights = options.lights;
    setup.against = options.against.empty()      ? Against::nothing
                    : options.against == "truth" ? Against::truth
                                                 : Against::recipe;
    setup.other = setup.against == Against::recipe ? options.against : setup.other;
    setup.split = options.split;
    setup.error = options.error;
    setup.light = options.light;
    setup.stops = options.stops;
    setup.window = options.window;
    setup.picture = options.picture;
    // Words that are given once are of all viewports.
    const auto word = [](const std::vector<std::string>& words, std::size_t i) {
        const std::string given = words.empty() ? "" : words[std::min(i, words.size() - 1)];
        return given == "none" ? "" : given;
    };
    const std::size_t count = std::max<std::size_t>(
        {options.recipes.size(), options.views.size(), options.cameras.size(), options.shows.size(), 1});
    for (std::size_t i = 0; i < count; ++i) {
        ViewportSetup& viewport = setup.viewports.emplace_back();
        viewport.recipe = options.recipes.empty() ? viewport.recipe : word(options.recipes, i);
        viewport.view = word(options.views, i);
        viewport.camera = word(options.cameras, i);
        viewport.show = word(options.shows, i);
    }
    return setup;
}

std::string command_of(const ViewSetup& setup) {
    const ViewSetup usual;
    std::string line = "gnomon view " + shell_word(setup.scene);
    const auto add = [&](std::string_view option, std::string_view value, bool given) {
        line += given ? fmt::format(" {} {}", option, shell_word(value)) : "";
    };
    add("--ground", ground_text(setup.file.ground), ground_text(setup.file.ground) != "auto");
    add("--up", "z", setup.file.up == UpAxis::z);
    for (const std::string& folder : setup.file.assets) {
        add("--assets", folder, true);
    }
    add("--animation", setup.file.animation, !setup.file.animation.empty());
    add("--time", fmt::format("{}", setup.file.time), setup.file.time != 0);
    for (const ViewportSetup& viewport : setup.viewports) {
        add("-r", viewport.recipe, true);
    }
    // One camera where all look through it, else each its own; cameras that stand as the scene says only where one does not.
    const auto each = [&](std::string_view option, std::string ViewportSetup::*word, bool one) {
        const bool given = std::any_of(setup.viewports.begin(), setup.viewports.end(),
                                       [&](const ViewportSetup& viewport) { return !(viewport.*word).empty(); });
        for (std::size_t i = 0; given && i < (one ? 1 : setup.viewports.size()); ++i) {
            const std::string& value = setup.viewports[i].*word;
            add(option, value.empty() ? "none" : value, true);
        }
    };
    each("--view", &ViewportSetup::view, setup.linked);
    each("--camera", &ViewportSetup::camera, setup.linked);
    each("--show", &ViewportSetup::show, false);
    line += setup.linked ? "" : " --own-cameras";
    for (const std::string& light : setup.lights) {
        add("--move-light", light, true);
    }
    add("--against", setup.against == Against::truth ? "truth" : setup.other, setup.against != Against::nothing);
    add("--split", fmt::format("{}", setup.split), setup.split != usual.split);
    line += setup.error ? " --error" : "";
    add("--light", setup.light, !setup.light.empty());
    add("--stops", fmt::format("{}", setup.stops), setup.stops != 0.0F);
    add("--window", text_of(setup.window), text_of(setup.window) != text_of(usual.window));
    add("--size", setup.picture ? text_of(*setup.picture) : "", setup.picture.has_value());
    return line;
}

}  // namespace gn
