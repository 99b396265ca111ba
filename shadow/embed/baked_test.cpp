// SPDX-License-Identifier: MIT
// Without a compiler: what a rehearsal finds is all that frames bind, and V of baked shaders is V of compiled ones.
#include "base/paths.h"
#include "gpu/baked_shaders.h"
#include "gpu/glsl.h"
#include "gpu/shader_cache.h"
#include "shadow/embed/rehearsal.h"
#include "tests/direct_scenes.h"
#include "tests/lent_renderer.h"
#include "tests/thorough.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

namespace gn::embed::baked_test {
namespace {

namespace fs = std::filesystem;
using test::device;

/// A folder of the test's own.
struct Folder {
    fs::path path;
    explicit Folder(const char* name)
        : path(fs::path(testing::TempDir()) / fmt::format("gnomon-{}-{}", name, getpid())) {
        fs::remove_all(path);
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

/// What `gnomon bake` writes.
void bake(const fs::path& folder, const std::vector<std::string>& recipes) {
    BakedManifest manifest;
    const ShaderCache shaders(folder / "shaders");
    fs::create_directories(folder / "recipes");
    for (const std::string& recipe : recipes) {
        manifest.recipes.push_back(recipe);
        const fs::path file = recipe_file(recipe.substr(0, recipe.find(',')));
        fs::copy_file(file, folder / "recipes" / file.filename(), fs::copy_options::overwrite_existing);
        for (const auto& [key, source] : rehearse(device(), recipe).shaders) {
            shaders.store(key, device().shaders().compile(source).spirv);
            manifest.shaders.emplace(key, source.name);
        }
    }
    std::ofstream(folder / "manifest.txt") << text_of(manifest);
}

Result<Shadows> make(const std::string& recipe, const fs::path& baked, const fs::path& data = {}) {
    static const test::LentDevice lent;
    return Shadows::create({.device = lent.adopted(), .recipe = recipe, .baked = baked, .data = data});
}

std::string record(Shadows& shadows, const Frame& frame) {
    std::string why;
    device().run([&](VkCommandBuffer commands) { why = shadows.record(commands, frame).why(); });
    return why;
}

/// V of every light after three frames.
std::vector<std::vector<float>> visibilities(Shadows& shadows, test::LentRenderer& renderer) {
    for (int i = 0; i < 3; ++i) {
        ++renderer.poses;
        EXPECT_EQ(record(shadows, renderer.frame()), "");
    }
    std::vector<std::vector<float>> v;
    for (std::size_t i = 0; i < renderer.scene.lights.size(); ++i) {
        v.push_back(renderer.visibility(i));
    }
    return v;
}

TEST(EmbedBaked, BakedShadersGiveTheSameVisibility) {
    const test::ValidationGuard guard;
    const Folder folder("baked");
    std::vector<std::string> recipes{"pcf,placement=cascades", "vsm", "pcf-poisson,placement=lispsm"};
    recipes.resize(test::sanitized ? 1 : 3);
    bake(folder.path, recipes);
    for (const std::string& recipe : recipes) {
        test::LentRenderer renderer(by_hand::lit_garden(), 96, 54);
        Result<Shadows> baked = make(recipe, folder.path), compiled = make(recipe, {});
        ASSERT_TRUE(baked.ok()) << baked.why();
        ASSERT_TRUE(compiled.ok()) << compiled.why();
        const auto expected = visibilities(compiled.value(), renderer);
        EXPECT_EQ(visibilities(baked.value(), renderer), expected) << recipe;
        const auto [least, most] = std::minmax_element(expected[0].begin(), expected[0].end());
        EXPECT_LT(*least, *most) << recipe;
    }
}

TEST(EmbedBaked, WhatIsMissingIsASentenceThatSaysHowToMakeIt) {
    const Folder folder("missing");
    bake(folder.path, {"pcf"});
    EXPECT_NE(make("vsm", folder.path).why().find("gnomon bake pcf vsm -o " + folder.path.string()), std::string::npos)
        << make("vsm", folder.path).why();
    const fs::path recipe = folder.path / "recipes" / "hard.toml";
    ASSERT_EQ(mkfifo(recipe.c_str(), 0600), 0);
    EXPECT_NE(make("hard", folder.path).why().find("hard"), std::string::npos) << "a pipe would never end";
    EXPECT_NE(make("pcf", folder.path / "nowhere").why().find("gnomon bake RECIPE"), std::string::npos);

    // Values that shaders are given were not baked; what composes them was.
    test::LentRenderer renderer(load_scene("contact"), 64, 48);
    Result<Shadows> other = make("pcf,resolution=512,bias.normal=2", folder.path);
    ASSERT_TRUE(other.ok()) << other.why();
    EXPECT_EQ(record(other.value(), renderer.frame()), "");
    for (const std::string& why :
         {make("pcf,placement=lispsm", folder.path).why(), other.value().set_recipe("pcf,placement=lispsm").why(),
          other.value().prepare_recipe("pcf,placement=lispsm").why()}) {
        for (const std::string part :
             {"recipe 'pcf,placement=lispsm'", "lispsm", "gnomon bake pcf pcf,placement=lispsm -o"}) {
            EXPECT_NE(why.find(part), std::string::npos) << "said before any frame: " << why;
        }
    }
    EXPECT_EQ(record(other.value(), renderer.frame()), "") << "with the recipe of before";
    EXPECT_NE(other.value().reload().why().find("baked"), std::string::npos);
}

TEST(EmbedBaked, DrawsOfARenderersOwnBindNothingElse) {
    // Moments of depths that a renderer drew are written by a shader that its buffers never need.
    const Rehearsal found = rehearse(device(), "vsm,vsm.slope_moment=0");
    const auto writes = [](const auto& shader) { return shader.second.name.ends_with(" from depth"); };
    EXPECT_TRUE(std::any_of(found.shaders.begin(), found.shaders.end(), writes));

    test::LentRenderer renderer(load_scene("contact"), 64, 48);
    Result<Shadows> made = make("vsm,vsm.slope_moment=0", {});
    ASSERT_TRUE(made.ok()) << made.why();
    Frame frame = renderer.frame();
    frame.casters.draw = [](const CasterView&) {};
    const auto rehearsed = made.value().rehearse(frame, [&](const ShaderSource& source) {
        EXPECT_TRUE(found.shaders.contains(baked_key(source))) << source.name;
    });
    ASSERT_TRUE(rehearsed.ok()) << rehearsed.why();
    EXPECT_EQ(rehearsed.value(), std::vector<std::string>{""});
}

TEST(EmbedBaked, EveryFormOfReceiversIsFound) {
    const Rehearsal found = rehearse(device(), "hard");
    test::LentRenderer renderer(load_scene("contact"), 64, 48);
    static const test::LentDevice lent;
    std::set<Fingerprint> bound;
    for (const Normals normals : {Normals::none, Normals::signed_xyz, Normals::unsigned_xyz, Normals::signed_octahedral,
                                  Normals::unsigned_octahedral}) {
        Result<Shadows> made =
            Shadows::create({.device = lent.adopted(), .recipe = "hard", .receivers = {.normals = normals}});
        ASSERT_TRUE(made.ok()) << made.why();
        const auto rehearsed = made.value().rehearse(renderer.frame(), [&](const ShaderSource& source) {
            bound.insert(baked_key(source));
            EXPECT_TRUE(found.shaders.contains(baked_key(source))) << source.name << ' ' << static_cast<int>(normals);
        });
        EXPECT_TRUE(rehearsed.ok()) << rehearsed.why();
    }
    EXPECT_GT(bound.size(), 8U) << "a shader for each form, and those that all have";
}

TEST(EmbedBaked, WithoutACompilerItIsSaidAtOnce) {
    const MakeGlslCompiler linked = register_glsl_compiler(nullptr);
    const Result<Shadows> made = make("pcf", {});
    register_glsl_compiler(linked);
    EXPECT_NE(linked, nullptr);
    EXPECT_NE(made.why().find("gnomon bake pcf -o"), std::string::npos) << made.why();
}

/// Renderers of three scenes, made once for all recipes.
std::vector<test::LentRenderer>& renderers() {
    static std::vector<test::LentRenderer> all = [] {
        std::vector<test::LentRenderer> made;
        for (const char* scene : {"courtyard", "contact", "corridor"}) {
            made.emplace_back(load_scene(scene), 64, 48);
        }
        return made;
    }();
    return all;
}

/// Every recipe that can be embedded: frames of real scenes on this device bind nothing that the rehearsal did not find.
class Rehearsed : public testing::TestWithParam<std::string> {};

TEST_P(Rehearsed, FindsAllThatFramesBind) {
    const std::string recipe = test::with_few_points(load_recipe(GetParam()), GetParam());
    std::optional<Rehearsal> found;
    try {
        found = rehearse(device(), recipe);
    } catch (const Error& error) {
        EXPECT_NE(make(recipe, {}).why(), "") << error.what();
        return;
    }
    Result<Shadows> shadows = make(recipe, {});
    ASSERT_TRUE(shadows.ok()) << shadows.why();
    std::size_t bound = 0;
    for (test::LentRenderer& renderer : renderers()) {
        for (std::uint32_t i = 0; i < 4; ++i) {
            renderer.poses += i / 2;
            const auto rehearsed = shadows.value().rehearse(renderer.frame(i % 2), [&](const ShaderSource& source) {
                ++bound;
                EXPECT_TRUE(found->shaders.contains(baked_key(source))) << source.name << " on " << renderer.scene.name;
            });
            EXPECT_TRUE(rehearsed.ok()) << rehearsed.why();
        }
    }
    EXPECT_GT(bound, 10U);
}

INSTANTIATE_TEST_SUITE_P(Recipes, Rehearsed, testing::ValuesIn(test::drawn_recipes()),
                         [](const auto& recipe) { return identifier(recipe.param); });

std::string text_of_file(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// A copy of what shaders are composed of.
void copy_data(const fs::path& to) {
    const fs::path root = data_root();
    for (const char* name : {"recipes", "base", "gpu", "shadow"}) {
        for (const auto& entry : fs::recursive_directory_iterator(root / name)) {
            const fs::path extension = entry.path().extension();
            if (extension == ".glsl" || extension == ".h" || extension == ".toml") {
                const fs::path copy = to / fs::relative(entry.path(), root);
                fs::create_directories(copy.parent_path());
                fs::copy_file(entry.path(), copy);
            }
        }
    }
}

TEST(EmbedReload, AnEditedFunctionChangesTheNextFrame) {
    const test::ValidationGuard guard;
    const Folder data("reload");
    copy_data(data.path);
    test::LentRenderer renderer(load_scene("contact"), 96, 64);
    Result<Shadows> made = make("pcf", {}, data.path);
    ASSERT_TRUE(made.ok()) << made.why();
    Shadows& shadows = made.value();
    const auto before = visibilities(shadows, renderer);
    EXPECT_EQ(shadows.reload().value(), 0U);

    // The visibility that the filter finds is halved by whoever asks for it.
    const fs::path file = data.path / "shadow/lookup/pcf/pcf.glsl";
    const std::string whole = text_of_file(file);
    const auto write = [&](const std::string& content) { std::ofstream(file) << content; };
    const std::string head = "float gn_pcf_visibility(";
    const std::string parameters = "GnLookup at, GN_PCF_MAPS, GnPcfParams params) {\n";
    std::string text = whole;
    const std::size_t begin = text.find(head + parameters);
    ASSERT_NE(begin, std::string::npos);
    text.replace(begin, head.size(), "float gn_pcf_whole(");
    text.insert(text.find("\n}\n", begin) + 3,
                head + parameters + "    return 0.5 * gn_pcf_whole(at, depth, ids, params);\n}\n");
    write(text);
    const Result<std::size_t> reloaded = shadows.reload();
    ASSERT_TRUE(reloaded.ok()) << reloaded.why();
    EXPECT_EQ(reloaded.value(), 1U);
    const auto after = visibilities(shadows, renderer);
    std::size_t halved = 0;
    for (std::size_t i = 0; i < before[0].size(); ++i) {
        // Beyond the map nobody asks; elsewhere V was clamped after it was halved, and before it was not.
        ASSERT_TRUE(std::abs(after[0][i] - 0.5F * before[0][i]) < 1e-6F || (before[0][i] == 1 && after[0][i] == 1))
            << i << ": " << before[0][i] << ", then " << after[0][i];
        halved += after[0][i] < before[0][i] ? 1 : 0;
    }
    EXPECT_GT(halved, before[0].size() / 4);

    // A mistake leaves all as it is, until it is mended.
    write(text + "float broken( {\n");
    for (int i = 0; i < 2; ++i) {
        const Result<std::size_t> broken = shadows.reload();
        EXPECT_NE(broken.why().find("shadow/lookup/pcf/pcf.glsl:"), std::string::npos) << broken.why();
        EXPECT_EQ(visibilities(shadows, renderer), after);
    }
    write(whole);
    ASSERT_TRUE(shadows.reload().ok());
    EXPECT_EQ(visibilities(shadows, renderer), before);
}

}  // namespace
}  // namespace gn::embed::baked_test
