// SPDX-License-Identifier: MIT
// gnomon bake: what renderers without a compiler read at run time.
#include "apps/options.h"
#include "apps/output.h"
#include "gpu/baked_shaders.h"
#include "gpu/shader_cache.h"
#include "shadow/embed/rehearsal.h"
#include "shadow/recipe/recipe.h"

#include <spdlog/spdlog.h>

#include <unistd.h>

#include <algorithm>

namespace gn {
namespace {

namespace fs = std::filesystem;

/// A recipe that is asked for, as the folder will know it.
struct Asked {
    std::string given;  ///< name or path, and overrides
    std::string text;   ///< name and overrides
    fs::path file;
};

/// Recipes and their files; one name must mean one file.
std::vector<Asked> read_recipes(const std::vector<std::string>& texts) {
    std::vector<Asked> all;
    for (const std::string& text : texts) {
        const Recipe recipe = load_recipe(text);
        const std::string full = recipe.name + (recipe.overrides.empty() ? "" : ",") + recipe.overrides;
        Asked asked{text, full, recipe_file(text.substr(0, text.find(',')))};
        const auto named = [&](const Asked& other) { return other.file.stem() == asked.file.stem(); };
        const auto other = std::find_if(all.begin(), all.end(), named);
        if (other != all.end() && read_text(other->file) != read_text(asked.file)) {
            fail("{} and {} are both called '{}'; recipes that are baked together need names of their own",
                 other->file.string(), asked.file.string(), recipe.name);
        }
        if (std::none_of(all.begin(), all.end(), [&](const Asked& before) { return before.text == full; })) {
            all.push_back(std::move(asked));
        }
    }
    return all;
}

/// Throws Error where the folder is there and is none that was baked.
void check_folder(const fs::path& folder) {
    std::error_code code;
    const bool free = !fs::exists(folder, code) || (fs::is_directory(folder, code) && fs::is_empty(folder, code));
    if (!free && !fs::exists(folder / "manifest.txt", code)) {
        fail("-o {}: it is there and was not baked; give a new folder, or one that 'gnomon bake' wrote before",
             folder.string());
    }
}

/// A folder that is written beside and takes its place when it is whole; else nothing of it stays.
class NewFolder {
  public:
    explicit NewFolder(fs::path final)
        : final_(std::move(final)), beside_(final_.string() + fmt::format(".baking-{}", getpid())) {
        std::error_code code;
        if (!fs::create_directories(beside_ / "shaders", code) || !fs::create_directory(beside_ / "recipes", code)) {
            fs::remove_all(beside_, code);
            fail("-o {}: no folder can be written there; is the one above it writable, and the disk not full?",
                 final_.string());
        }
    }
    ~NewFolder() {
        std::error_code ignored;
        fs::remove_all(beside_, ignored);
    }
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;

    [[nodiscard]] const fs::path& path() const { return beside_; }

    void take_place() const {
        const fs::path old = final_.string() + fmt::format(".old-{}", getpid());
        std::error_code code;
        if (fs::exists(final_, code)) {
            fs::rename(final_, old, code);
        }
        if (!code) {
            fs::rename(beside_, final_, code);
        }
        if (code) {
            std::error_code ignored;
            fs::rename(old, final_, ignored);
            fail("-o {}: it cannot be replaced: {}", final_.string(), code.message());
        }
        fs::remove_all(old, code);
    }

  private:
    fs::path final_, beside_;
};

/// Compiles a shader into the folder, and reads back that it is there.
void write_shader(Device& device, const ShaderCache& shaders, const Fingerprint& key, const ShaderSource& source) {
    const std::vector<std::uint32_t>& spirv = device.shaders().compile(source).spirv;
    shaders.store(key, spirv);
    if (shaders.load(key) != spirv) {
        fail("{}: shader '{}' cannot be written; is the disk full?", shaders.file(key).string(), source.name);
    }
}

}  // namespace

int run(const BakeOptions& options) {
    // Look before leaping: recipes, folder, device.
    fs::path folder = fs::path(options.folder).lexically_normal();
    folder = folder.has_filename() ? folder : folder.parent_path();
    const std::vector<Asked> recipes = reading([&] {
        check_folder(folder);
        return read_recipes(options.recipes);
    });
    const std::unique_ptr<Device> device = Device::create();

    // Find what every recipe binds, on devices of every kind.
    BakedManifest manifest;
    std::map<Fingerprint, ShaderSource> sources;
    std::set<DeviceTrait> asked;
    for (const Asked& recipe : recipes) {
        const embed::Rehearsal found = reading([&] { return embed::rehearse(*device, recipe.given); });
        spdlog::info("{}: {} shaders", recipe.text, found.shaders.size());
        manifest.recipes.push_back(recipe.text);
        for (const std::string& why : found.refused) {
            spdlog::warn("{}: {}", recipe.text, why);
            manifest.notes.push_back(fmt::format("{}: {}", recipe.text, why));
        }
        sources.insert(found.shaders.begin(), found.shaders.end());
        asked.insert(found.asked.begin(), found.asked.end());
    }
    std::vector<std::string> traits;
    std::transform(asked.begin(), asked.end(), std::back_inserter(traits), [](const auto& t) { return t.name(); });
    manifest.notes.push_back(fmt::format("for every device: with and without {}", fmt::join(traits, ", ")));

    // Compile, then write what names it all.
    const NewFolder made(folder);
    const ShaderCache shaders(made.path() / "shaders");
    for (const auto& [key, source] : sources) {
        write_shader(*device, shaders, key, source);
        manifest.shaders.emplace(key, source.name);
    }
    for (const Asked& recipe : recipes) {
        write_text(made.path() / "recipes" / recipe.file.filename(), read_text(recipe.file));
    }
    write_text(made.path() / "manifest.txt", text_of(manifest));
    made.take_place();
    fmt::print("{}: {} shaders for {}\n", folder.string(), sources.size(), fmt::join(manifest.recipes, " "));
    return exit_done;
}

}  // namespace gn
