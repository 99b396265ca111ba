// SPDX-License-Identifier: MIT
// Recipes: what the files say, what overrides change, which sentences mistakes end in, what is refused.
#include "shadow/recipe/recipe.h"

#include "base/paths.h"
#include "shadow/recipe/check_recipe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace gn::recipe_test {
namespace {

/// Every part stands in the text; the failure prints both.
void expect_has(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
        EXPECT_PRED_FORMAT2(testing::IsSubstring, part, text);
    }
}

/// The sentence that reading this recipe ends in, or "" when it is fine.
std::string sentence_of(const std::string& text) {
    try {
        load_recipe(text);
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

/// A recipe file with this text, gone at the end of the test.
class RecipeFile {
  public:
    explicit RecipeFile(const std::string& text) {
        std::string pattern = (std::filesystem::temp_directory_path() / "gnomon-recipe-XXXXXX").string();
        folder_ = mkdtemp(pattern.data());
        std::ofstream(folder_ / "mine.toml") << text;
    }
    ~RecipeFile() {
        std::error_code code;
        std::filesystem::remove_all(folder_, code);
    }
    RecipeFile(const RecipeFile&) = delete;
    RecipeFile& operator=(const RecipeFile&) = delete;
    [[nodiscard]] std::string path() const { return (folder_ / "mine.toml").string(); }

  private:
    std::filesystem::path folder_;
};

/// A device that answers questions and does nothing else.
class AnsweringDevice final : public Device {
  public:
    std::set<Feature> features;

    [[nodiscard]] const DeviceInfo& info() const override { return info_; }
    [[nodiscard]] bool has(Feature feature) const override { return features.contains(feature); }
    [[nodiscard]] VkInstance instance() const override { return VK_NULL_HANDLE; }
    [[nodiscard]] VkPhysicalDevice physical() const override { return VK_NULL_HANDLE; }
    [[nodiscard]] VkDevice vk() const override { return VK_NULL_HANDLE; }
    [[nodiscard]] VkQueue queue() const override { return VK_NULL_HANDLE; }
    [[nodiscard]] std::uint32_t queue_family() const override { return 0; }
    [[nodiscard]] const VkPhysicalDeviceProperties& properties() const override { return properties_; }
    [[nodiscard]] ShaderCompiler& shaders() override { std::abort(); }
    [[nodiscard]] PipelineCache& pipelines() override { std::abort(); }
    [[nodiscard]] MemoryPool& memory() override { std::abort(); }
    void run(const std::function<void(VkCommandBuffer)>& /*record*/) override { std::abort(); }
    [[nodiscard]] const std::vector<std::string>& messages() const override { return messages_; }

  private:
    DeviceInfo info_{"paper device", "none"};
    VkPhysicalDeviceProperties properties_{};
    std::vector<std::string> messages_;
};

Light light_of(uint kind) {
    Light light{"lamp", {}};
    light.shape.kind = kind;
    return light;
}

/// The refusal, or "" when the recipe serves the light.
std::string refusal_of(const Recipe& recipe, uint kind, const AnsweringDevice& device) {
    Scene scene;
    scene.name = "paper";
    scene.lights.push_back(light_of(kind));
    try {
        check_recipe(recipe, scene, scene.lights.front(), device);
        return {};
    } catch (const Refusal& refusal) {
        return refusal.what();
    }
}

TEST(Recipes, EveryShippedOneReadsAndExplainsItself) {
    const std::vector<std::string> names = recipe_names();
    for (const char* shipped : {"hard", "none", "pcf", "pcf-poisson", "planar", "volumes"}) {
        EXPECT_NE(std::find(names.begin(), names.end(), shipped), names.end()) << shipped;
    }
    std::ifstream stream(data_root() / "docs" / "references.bib");
    const std::string works(std::istreambuf_iterator<char>(stream), {});
    for (const std::string& name : names) {
        const Recipe recipe = load_recipe(name);
        EXPECT_EQ(recipe.name, name);
        EXPECT_FALSE(recipe.title.empty()) << name;
        EXPECT_GT(recipe.paragraph.size(), 150U) << name;
        expect_has(works, {"{" + recipe.citation + ","});
    }
}

TEST(Recipes, NameTheirParts) {
    const Recipe pcf = load_recipe("pcf"), volumes = load_recipe("volumes"), none = load_recipe("none");
    EXPECT_EQ(pcf.map->id, "depth");
    EXPECT_EQ(pcf.lookup->id, "pcf");
    EXPECT_EQ(pcf.direct, nullptr);
    EXPECT_EQ(volumes.direct->id, "volumes");
    EXPECT_EQ(volumes.map, nullptr);
    EXPECT_TRUE(none.map == nullptr && none.lookup == nullptr && none.direct == nullptr);
    EXPECT_EQ(load_recipe("pcf-poisson").block(find_part(Stage::lookup, "pcf")).get("kernel"), "rotated-poisson");
}

TEST(Recipes, NameNoKeyThatNoPartReads) {
    // Each group of keys once where it is read and once where it is not.
    const std::vector<std::pair<std::string, std::string>> pairs{
        {"volumes,placement=cascades", "hard,placement=cascades"},
        {"volumes,bias.normal=9", "hard,bias.normal=9"},
        {"none,resolution=64", "forward,resolution=64"},
        {"planar,casters=back", "pcf,casters=back"},
        {"forward,bias.cone=1", "forward,placement=single"},
        {"hard,pcf.size=5", "hard,pcf.size=5,lookup=pcf"},
        {"hard,vsm.radius=2", "vsm,vsm.radius=2"},
        {"pcf,cascades.count=2", "pcf,cascades.count=2,placement=cascades"},
        {"pcf,bilateral.radius=2", "pcf,visibility=bilateral,bilateral.radius=2"},
        {"pcf,placement=cascades,direct=volumes", "pcf,placement=cascades,cube.resolution=coverage"}};
    for (const auto& [wrong, right] : pairs) {
        expect_has(sentence_of(wrong), {"would change nothing", "keys that they read"});
        EXPECT_EQ(sentence_of(right), "") << right;
    }
    // `auto` leaves the placement to the lights, which is what a recipe without one does.
    EXPECT_EQ(sentence_of("volumes,placement=auto"), "");
}

TEST(Recipes, BlanksBetweenOverridesMeanNothing) {
    const Recipe recipe = load_recipe("pcf, resolution = 64 ,\tpcf.size=5");
    EXPECT_EQ(recipe.overrides, "resolution=64,pcf.size=5");
    EXPECT_EQ(recipe.resolution, 64);
}

TEST(Recipes, AutomaticPlacementSuitsTheLight) {
    const Recipe recipe = load_recipe("hard");
    EXPECT_EQ(recipe.placement, nullptr);
    const std::map<uint, std::string> expected{
        {GN_LIGHT_DIRECTIONAL, "fit"}, {GN_LIGHT_SPOT, "fit"}, {GN_LIGHT_POINT, "cube"}, {GN_LIGHT_RECTANGLE, "fit"}};
    for (const auto& [kind, id] : expected) {
        EXPECT_EQ(recipe.placement_for(light_of(kind).shape).id, id);
    }
}

TEST(Recipes, ANamedPlacementLeavesOtherLightsToTheAutomaticOne) {
    const Recipe recipe = load_recipe("hard,placement=cascades");
    EXPECT_EQ(recipe.placement_for(light_of(GN_LIGHT_DIRECTIONAL).shape).id, "cascades");
    EXPECT_EQ(recipe.placement_for(light_of(GN_LIGHT_POINT).shape).id, "cube");
    EXPECT_EQ(recipe.placement_for(light_of(GN_LIGHT_SPOT).shape).id, "fit");

    // It says so, and refuses where it was named for no light at all.
    Scene scene;
    const AnsweringDevice device;
    scene.lights = {light_of(GN_LIGHT_POINT), light_of(GN_LIGHT_SPOT)};
    EXPECT_THROW(check_recipe(recipe, scene, scene.lights[0], device), Refusal);
    EXPECT_EQ(placement_remark(recipe, scene), "");
    scene.lights.push_back(light_of(GN_LIGHT_DIRECTIONAL));
    EXPECT_NO_THROW(check_recipe(recipe, scene, scene.lights[0], device));
    EXPECT_EQ(placement_remark(recipe, scene),
              "placement 'cascades' serves directional lights; placed otherwise: spot lights by 'fit', point lights by "
              "'cube'");
    EXPECT_EQ(placement_remark(load_recipe("hard"), scene), "");
    EXPECT_EQ(placement_remark(load_recipe("hard,placement=lispsm"), scene), "");
}

TEST(Recipes, APlacementWithAutoBehindItIsNeverNamedInVain) {
    const Recipe recipe = load_recipe("hard,placement=cascades+auto");
    EXPECT_EQ(recipe.placement_for(light_of(GN_LIGHT_DIRECTIONAL).shape).id, "cascades");
    EXPECT_EQ(recipe.placement_for(light_of(GN_LIGHT_POINT).shape).id, "cube");
    Scene scene;
    const AnsweringDevice device;
    scene.lights = {light_of(GN_LIGHT_POINT)};
    EXPECT_NO_THROW(check_recipe(recipe, scene, scene.lights[0], device));
    scene.lights.push_back(light_of(GN_LIGHT_DIRECTIONAL));
    EXPECT_EQ(placement_remark(recipe, scene), "");

    // A file has it as a list; an override without it takes it back.
    const std::string rest = "map = \"depth\"\nlookup = \"hard\"\n";
    const RecipeFile file("placement = [\"cascades\", \"auto\"]\n" + rest);
    EXPECT_EQ(load_recipe(file.path()).placement_name(), "cascades+auto");
    EXPECT_EQ(load_recipe(file.path() + ",placement=cascades").placement_name(), "cascades");
    EXPECT_EQ(load_recipe(file.path() + ",placement=auto").placement_name(), "auto");
    for (const char* wrong : {"cascades+fit", "auto+auto", "cascades+"}) {
        expect_has(sentence_of(fmt::format("hard,placement={}", wrong)), {"placement", "+auto alone"});
    }
}

TEST(Recipes, OverridesAreLaidOverTheFile) {
    const Recipe recipe = load_recipe("pcf,resolution=2048,pcf.taps=25,placement=cube,bias.normal=1.5,casters=front");
    const Part& pcf = find_part(Stage::lookup, "pcf");
    EXPECT_EQ(recipe.overrides, "resolution=2048,pcf.taps=25,placement=cube,bias.normal=1.5,casters=front");
    EXPECT_EQ(recipe.resolution, 2048);
    EXPECT_EQ(recipe.block(pcf).get("taps"), "25");
    EXPECT_EQ(recipe.block(pcf).get("radius"), load_recipe("pcf").block(pcf).get("radius"));
    EXPECT_EQ(recipe.placement->id, "cube");
    EXPECT_EQ(recipe.bias.normal, 1.5F);
    EXPECT_EQ(recipe.bias.constant, GnBias{}.constant);
    EXPECT_EQ(recipe.casters, Casters::front);
    // The last word on a key counts; "auto" takes a placement back.
    EXPECT_EQ(load_recipe("pcf,resolution=64,resolution=128").resolution, 128);
    EXPECT_EQ(load_recipe("pcf,placement=cube,placement=auto").placement, nullptr);
}

TEST(Recipes, DashAndUnderscoreAreTheSameInNames) {
    EXPECT_EQ(load_recipe("pcf_poisson").name, "pcf-poisson");
    EXPECT_EQ(load_recipe("pcf,bias.receiver-plane=false").bias.receiver_plane, 0);
    EXPECT_EQ(load_recipe("pcf,bias.receiver_plane=off").bias.receiver_plane, 0);
    EXPECT_EQ(load_recipe("pcf,pcf.radius-world=2").block(find_part(Stage::lookup, "pcf")).get("radius_world"), "2");
}

TEST(Recipes, AnOverrideMayChangeTheKindOfTechnique) {
    const Recipe direct = load_recipe("pcf,direct=volumes");
    EXPECT_EQ(direct.direct->id, "volumes");
    EXPECT_TRUE(direct.map == nullptr && direct.lookup == nullptr && direct.placement == nullptr);
    const Recipe mapped = load_recipe("volumes,map=depth,lookup=hard");
    EXPECT_EQ(mapped.direct, nullptr);
    EXPECT_EQ(mapped.lookup->id, "hard");
}

TEST(Recipes, ADirectPartStandsBesideAMapWhereTheRecipeSaysHowTheyCombine) {
    // Wherever the combination stands in the list of overrides.
    for (const char* text : {"pcf,direct=volumes,combine=minimum", "pcf,combine=minimum,direct=volumes",
                             "volumes,map=depth,lookup=pcf,combine=minimum"}) {
        const Recipe recipe = load_recipe(text);
        ASSERT_TRUE(recipe.map != nullptr && recipe.lookup != nullptr && recipe.direct != nullptr) << text;
        EXPECT_EQ(recipe.combine, Combine::minimum) << text;
        EXPECT_EQ(refusal_of(recipe, GN_LIGHT_SPOT, {}), "direct 'volumes' needs the feature " +
                                                             std::string(feature_name(Feature::float32_blend)) +
                                                             ", which device 'paper device' lacks");
    }
    const RecipeFile file("direct = \"volumes\"\nmap = \"depth\"\nlookup = \"hard\"\ncombine = \"product\"\n");
    EXPECT_EQ(load_recipe(file.path()).combine, Combine::product);
    // Without one of the two sides a file's combination means nothing.
    EXPECT_EQ(load_recipe(file.path() + ",direct=none").combine, std::nullopt);
    EXPECT_EQ(load_recipe(file.path() + ",combine=minimum").combine, Combine::minimum);
}

TEST(Recipes, NonsenseIsRefusedByName) {
    expect_has(sentence_of("pcf,combine=product"), {"combine = product", "no direct part"});
    expect_has(sentence_of("volumes,combine=product"), {"combine = product", "no map"});
    expect_has(sentence_of("pcf,direct=volumes,combine=sum"), {"combine = sum", "product", "minimum"});
    expect_has(sentence_of("none,light=accumulate"), {"light 'accumulate'", "no part draws any", "volumes"});
    expect_has(sentence_of("none,visibility=bilateral"), {"visibility 'bilateral'", "no part draws any"});
    expect_has(sentence_of("pcf,visibility=bilateral+bilateral"), {"'bilateral' twice"});
    expect_has(sentence_of("pcf,visibility=bilateral+"), {"unknown visibility ''", "bilateral"});
    expect_has(sentence_of("hard,accumulate.lights=4"), {"accumulate.lights would change nothing"});
    Recipe recipe = load_recipe("hard");
    recipe.direct = &find_part(Stage::direct, "planar");
    expect_has(refusal_of(recipe, GN_LIGHT_SPOT, {}), {"'planar'", "'depth'", "combine is product or minimum"});
}

TEST(Recipes, TranslucentCastersMayHaveAMapAndALookup) {
    const RecipeFile file(
        "map = \"depth\"\nlookup = \"pcf\"\n[translucent]\nmap = \"vsm\"\nlookup = \"filtered\"\n[vsm]\nradius = 2\n");
    const Recipe recipe = load_recipe(file.path());
    EXPECT_EQ(recipe.map->id, "depth");
    EXPECT_EQ(recipe.translucent_map->id, "vsm");
    EXPECT_EQ(recipe.of_translucent().map->id, "vsm");
    EXPECT_EQ(recipe.of_translucent().lookup->id, "filtered");
    EXPECT_EQ(load_recipe("hard,translucent.map=depth,translucent.lookup=hard").parts().size(), 2U);
    expect_has(sentence_of("hard,translucent.map=depth"), {"translucent", "need a map and a lookup"});
    expect_has(sentence_of("hard,translucent.speed=3"), {"unknown key 'translucent'", "translucent"});
    expect_has(sentence_of("volumes,translucent.map=depth,translucent.lookup=hard"), {"would change nothing"});
    expect_has(
        refusal_of(load_recipe("hard,translucent.map=silhouette-map,translucent.lookup=silhouette"), GN_LIGHT_SPOT, {}),
        {"'silhouette-map' holds opaque casters only", "depth"});
    expect_has(refusal_of(load_recipe("hard,translucent.map=vsm,translucent.lookup=hard"), GN_LIGHT_SPOT, {}),
               {"'hard' reads depth", "'vsm' gives"});
}

TEST(Recipes, VisibilityIsOneNameOrAListInOrder) {
    EXPECT_EQ(load_recipe("pcf").visibility.size(), 0U);
    EXPECT_EQ(load_recipe("pcf,visibility=bilateral").visibility.front()->id, "bilateral");
    EXPECT_EQ(load_recipe("pcf-bilateral,visibility=none").visibility.size(), 0U);
    const std::string map = "map = \"depth\"\nlookup = \"pcf\"\nvisibility = ";
    const RecipeFile one(map + "\"bilateral\"\n"), list(map + "[\"bilateral\"]\n"), none(map + "[]\n");
    EXPECT_EQ(load_recipe(one.path()).visibility.size(), 1U);
    EXPECT_EQ(load_recipe(list.path()).visibility.size(), 1U);
    EXPECT_EQ(load_recipe(none.path()).visibility.size(), 0U);
}

TEST(Recipes, SayWhichPartsTheyUseInTheOrderOfTheFlow) {
    const auto ids = [](const Recipe& recipe) {
        std::string text;
        for (const Part* part : recipe.parts()) {
            text += fmt::format("{}/{} ", stage_names[static_cast<std::size_t>(part->stage)], part->id);
        }
        return text;
    };
    EXPECT_EQ(ids(load_recipe("none")), "");
    EXPECT_EQ(ids(load_recipe("volumes,light=accumulate")), "light/accumulate direct/volumes ");
    EXPECT_EQ(ids(load_recipe("pcf-bilateral,placement=fit,direct=planar,combine=product")),
              "placement/fit map/depth lookup/pcf direct/planar visibility/bilateral ");
}

TEST(Recipes, MistakesEndInASentenceThatNamesWhatIsValid) {
    const std::vector<std::pair<std::string, std::vector<std::string>>> cases{
        {"pfc", {"'pfc'", "did you mean 'pcf'", "volumes"}},
        {"", {"unknown recipe ''", "pcf"}},
        {"pcf,pcf.tabs=3", {"pcf.tabs", "did you mean 'taps'"}},
        {"pcf,pcf.taps=many", {"pcf.taps", "'many'"}},
        {"pcf,pcf.taps=2.5", {"taps", "whole number"}},
        {"pcf,pcf.taps=100000", {"out of range", "128"}},
        {"pcf,pcf.kernel=round", {"'round'", "gaussian"}},
        {"pcf,resolution=12.5", {"resolution", "16 to 16384"}},
        {"pcf,resolution=0", {"resolution", "16 to 16384"}},
        {"pcf,resolution=99999999999", {"resolution", "16 to 16384"}},
        {"pcf,map=dept", {"'dept'", "did you mean 'depth'"}},
        {"pcf,placement=square", {"'square'", "cube", "auto"}},
        {"pcf,casters=bakc", {"casters", "did you mean 'back'"}},
        {"pcf,bias.normel=1", {"bias.normel", "did you mean 'normal'"}},
        {"pcf,bias.normal=-1", {"out of range"}},
        {"pcf,bias.normal=nan", {"'nan'"}},
        {"pcf,resolutoin=3", {"'resolutoin'", "did you mean 'resolution'", "casters"}},
        {"pcf,nothing.taps=3", {"'nothing'", "pcf"}},
        {"pcf,resolution", {"'resolution'", "key=value"}},
        {"pcf,=3", {"'=3'", "key=value"}},
        {"pcf,,resolution=64", {"key=value"}},
        {"none,lookup=pcf", {"'pcf'", "none is named", "depth"}},
        {"none,map=depth", {"'depth'", "hard", "pcf"}},
        {"/nowhere/at/all.toml", {"/nowhere/at/all.toml", "no such recipe file"}},
    };
    for (const auto& [text, parts] : cases) {
        const std::string sentence = sentence_of(text);
        EXPECT_EQ(sentence.find('\n'), std::string::npos) << text;
        expect_has(sentence, parts);
    }
}

TEST(Recipes, FilesMayLieAnywhere) {
    const RecipeFile file(
        "title = \"Mine\"\nmap = \"depth\"\nlookup = \"pcf\"\nresolution = 512\n"
        "[pcf]\ntaps = 4\n[bias]\nnormal = 2\nreceiver_plane = false\n");
    const Recipe recipe = load_recipe(file.path() + ",pcf.taps=5");
    EXPECT_EQ(recipe.name, "mine");
    EXPECT_EQ(recipe.resolution, 512);
    EXPECT_EQ(recipe.block(find_part(Stage::lookup, "pcf")).get("taps"), "5");
    EXPECT_EQ(recipe.bias.normal, 2.0F);
    EXPECT_EQ(recipe.bias.receiver_plane, 0);
}

TEST(Recipes, FilesAreCheckedLineByLine) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"map = \"depth\"\nlookup = \n", "line 2"},
        {"map = [\"depth\"]\n", "map is neither"},
        {"direct = \"volumes\"\nmap = \"depth\"\n", "combine is product or minimum"},
        {"direct = \"volumes\"\ncombine = \"minimum\"\n", "nothing to combine"},
        {"map = \"depth\"\nlookup = \"hard\"\nvisibility = [\"bilateral\", 3]\n", "no part's name"},
        {"speed = 3\n", "unknown key 'speed'"},
        {"[speed]\nlimit = 3\n", "unknown key 'speed'"},
        {"map = \"depth\"\nlookup = \"pcf\"\n[pcf]\ntaps = {a = 1}\n", "pcf.taps is neither"},
        {std::string(2 << 20, '#'), "too many"},
    };
    for (const auto& [text, part] : cases) {
        const RecipeFile file(text);
        expect_has(sentence_of(file.path()), {"mine.toml", part});
    }
}

TEST(CheckRecipe, LightsThatAPartDoesNotServeAreRefused) {
    const AnsweringDevice device;
    const Recipe cube = load_recipe("hard,placement=cube"), single = load_recipe("hard,placement=single");
    expect_has(refusal_of(single, GN_LIGHT_POINT, device), {"'single'", "point", "lamp", "directional"});
    EXPECT_EQ(refusal_of(cube, GN_LIGHT_POINT, device), "");
    for (const uint kind : {GN_LIGHT_DIRECTIONAL, GN_LIGHT_SPOT, GN_LIGHT_POINT, GN_LIGHT_RECTANGLE}) {
        EXPECT_EQ(refusal_of(load_recipe("none"), kind, device), "");
    }
}

TEST(CheckRecipe, StagesThatDoNotFitNameWhatWould) {
    // Two made-up parts: a lookup that reads what no map gives.
    Part map, lookup;
    map.id = "paper-map";
    map.stage = Stage::map;
    map.gives = {"depth"};
    lookup.id = "paper-lookup";
    lookup.needs = {"moments of paper"};
    Recipe recipe = load_recipe("hard");
    recipe.map = &map;
    recipe.lookup = &lookup;
    expect_has(refusal_of(recipe, GN_LIGHT_SPOT, {}),
               {"'paper-lookup' reads moments of paper", "'paper-map' gives depth",
                "maps that give moments of paper: none", "lookups that read 'paper-map': ", ", hard, ", ", pcf, "});
}

TEST(CheckRecipe, MissingFeaturesAreNamed) {
    Part part;
    part.id = "paper";
    part.stage = Stage::direct;
    part.features = {Feature::ray_query};
    Recipe recipe = load_recipe("none");
    recipe.direct = &part;
    AnsweringDevice device;
    expect_has(refusal_of(recipe, GN_LIGHT_SPOT, device),
               {"'paper'", std::string(feature_name(Feature::ray_query)), "paper device"});
    device.features.insert(Feature::ray_query);
    EXPECT_EQ(refusal_of(recipe, GN_LIGHT_SPOT, device), "");
}

TEST(CheckRecipe, MapsOfThirtyTwoBitsNeedTheirLinearFilter) {
    AnsweringDevice device;
    for (const char* recipe : {"vsm", "esm", "evsm4", "msm,msm.format=float32", "lvsm,lvsm.format=float32"}) {
        expect_has(refusal_of(load_recipe(recipe), GN_LIGHT_SPOT, device),
                   {std::string(feature_name(Feature::float32_filter)), "paper device"});
    }
    for (const char* recipe : {"sat-vsm", "evsm4,evsm.format=float16", "msm", "lvsm", "convolution"}) {
        EXPECT_EQ(refusal_of(load_recipe(recipe), GN_LIGHT_SPOT, device), "") << recipe;
    }
    device.features.insert(Feature::float32_filter);
    EXPECT_EQ(refusal_of(load_recipe("vsm"), GN_LIGHT_SPOT, device), "");
}

TEST(CheckRecipe, APartsOwnSentenceIsPassedOn) {
    Part part;
    part.id = "paper";
    part.stage = Stage::direct;
    part.refuses = [](const Scene& scene, const Light&, const Recipe&) { return "no floor in " + scene.name; };
    Recipe recipe = load_recipe("none");
    recipe.direct = &part;
    EXPECT_EQ(refusal_of(recipe, GN_LIGHT_SPOT, {}), "no floor in paper");
}

TEST(Parts, IdsWithParametersAreUnique) {
    // Recipes key parameters by id alone.
    std::set<std::string> seen{"bias"};
    for (const Part* part : all_parts()) {
        if (!part->params.rows.empty()) {
            EXPECT_TRUE(seen.insert(identifier(part->id)).second) << part->id;
        }
    }
    EXPECT_GT(seen.size(), 10U);
}

TEST(Parts, EveryDefaultLiesInItsRange) {
    for (const Part* part : all_parts()) {
        for (const ParamRow& row : part->params.rows) {
            const std::string value = ParamBlock(part->params).get(row.name);
            ParamBlock block(part->params);
            EXPECT_NO_THROW(block.set(row.name, value, "default")) << part->id << "." << row.name << " = " << value;
            EXPECT_FALSE(row.sentence.empty()) << part->id << "." << row.name;
        }
    }
    for (const ParamRow& row : bias_params.rows) {
        ParamBlock block(bias_params);
        EXPECT_NO_THROW(block.set(row.name, ParamBlock(bias_params).get(row.name), "default")) << row.name;
    }
}

TEST(Recipe, EveryKindOfLightHasOnePlacementThatStandsIn) {
    for (uint kind = 0; kind < light_kind_names.size(); ++kind) {
        const auto parts = all_parts();
        EXPECT_EQ(std::count_if(parts.begin(), parts.end(),
                                [&](const Part* part) {
                                    return part->stage == Stage::placement && part->stands_in_for.has(kind);
                                }),
                  1)
            << light_kind_names.at(kind);
        GnLight shape;
        shape.kind = kind;
        EXPECT_TRUE(load_recipe("hard").placement_for(shape).stands_in_for.has(kind));
        // It serves the kind, unless nothing does.
        EXPECT_TRUE(kind == GN_LIGHT_ENVIRONMENT || load_recipe("hard").placement_for(shape).lights.has(kind));
    }
}

}  // namespace
}  // namespace gn::recipe_test
