// SPDX-License-Identifier: MIT
// Files that models name as another machine would: other letter case, backslashes, drives, folders of somebody else.
#include "shadow/scene/testing.h"

namespace gn::paths_test {
namespace {

using namespace testing_scene;

constexpr std::string_view quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl m\nf 1 2 3 4\n";
constexpr std::string_view red = "newmtl m\nKd 1 0 0\n", blue = "newmtl m\nKd 0 0 1\n";

Scene load_with(const TempFolder& folder, std::string_view library, const LoadOptions& options = {}) {
    return load_scene(folder.write("model/a.obj", fmt::format("mtllib {}\n{}", library, quad)), options);
}

bool is_red(const Scene& scene) {
    return vec3(scene.materials.at(0).base_color) == vec3(1, 0, 0);
}

std::string notes_of(const Scene& scene) {
    return fmt::format("{}", fmt::join(scene.notes, "\n"));
}

std::string error_with(const std::string& file, const LoadOptions& options) {
    try {
        load_scene(file, options);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(Paths, SeparatorsOfEitherSystemAreTheFilesOwn) {
    const TempFolder folder;
    folder.write("model/Parts/Red.mtl", red);
    for (const char* name :
         {"Parts/Red.mtl", "Parts\\Red.mtl", ".\\Parts\\Red.mtl", "Parts\\..\\Parts/Red.mtl", "\"Parts\\Red.mtl\""}) {
        const Scene scene = load_with(folder, name);
        EXPECT_TRUE(is_red(scene)) << name;
        EXPECT_TRUE(scene.notes.empty()) << name << ": " << notes_of(scene);
    }
}

TEST(Paths, OtherSpellingsFindTheFileAndAreSaid) {
    const TempFolder folder;
    folder.write("model/Parts/Red.mtl", red);
    for (const char* name :
         {"parts/RED.MTL", ".\\parts\\red.mtl", "C:\\Users\\artist\\project\\Parts\\Red.mtl", "C:Parts\\Red.mtl",
          "/home/artist/project/parts/red.mtl", "\\\\server\\share\\parts\\red.mtl", "../elsewhere/parts/red.mtl"}) {
        const Scene scene = load_with(folder, name);
        EXPECT_TRUE(is_red(scene)) << name << ": " << notes_of(scene);
        ASSERT_EQ(scene.notes.size(), 1U) << name << ": " << notes_of(scene);
        EXPECT_TRUE(has_note(scene, name)) << notes_of(scene);
        EXPECT_TRUE(has_note(scene, "'Parts/Red.mtl'")) << notes_of(scene);
    }
    // The base name alone, beside the file; and one that is nowhere.
    folder.write("model/beside.mtl", red);
    const Scene beside = load_with(folder, "D:\\x\\Beside.mtl");
    EXPECT_TRUE(is_red(beside));
    EXPECT_TRUE(has_note(beside, "'beside.mtl'")) << notes_of(beside);
    EXPECT_TRUE(has_note(load_with(folder, "D:\\x\\no.mtl"), "'D:\\x\\no.mtl'"));
}

TEST(Paths, SeveralFilesThatWouldDoAreSaid) {
    const TempFolder folder;
    folder.write("model/Red.mtl", red);
    folder.write("model/red.mtl", red);
    EXPECT_TRUE(load_with(folder, "red.mtl").notes.empty());
    const Scene either = load_with(folder, "RED.MTL");
    EXPECT_TRUE(is_red(either));
    EXPECT_TRUE(has_note(either, "the first of 2")) << notes_of(either);
}

TEST(Paths, LibrariesInSubfoldersNameFilesBesideThem) {
    const TempFolder folder;
    const std::vector<std::byte> png = encode_png(Image(2, 2, 3, 1.0F));
    folder.write("model/parts/white.png", {reinterpret_cast<const char*>(png.data()), png.size()});
    folder.write("model/parts/a.mtl", "newmtl m\nmap_Kd white.png\n");
    const Scene scene = load_with(folder, "parts/a.mtl");
    EXPECT_EQ(scene.textures.size(), 1U);
    EXPECT_TRUE(scene.notes.empty()) << notes_of(scene);
}

TEST(Paths, OtherFoldersAreReadOnlyWhereTheUserAllowsThem) {
    const TempFolder folder;
    folder.write("library/red.mtl", red);
    folder.write("secret/blue.mtl", blue);

    // Never by default; the sentence says how.
    const Scene refused = load_with(folder, "../library/red.mtl");
    EXPECT_FALSE(is_red(refused));
    EXPECT_TRUE(has_note(refused, "'../library/red.mtl' lies outside the model's folder; allow it with --assets DIR"))
        << notes_of(refused);

    // The folder itself, or one above it, by the name as it stands; nothing else.
    const auto allowed = [&](const char* name, const char* library = "../library/red.mtl") {
        return load_with(folder, library, {.assets = {folder.path() / name}});
    };
    EXPECT_TRUE(is_red(allowed("library")));
    EXPECT_TRUE(allowed("library").notes.empty());
    EXPECT_TRUE(is_red(allowed("")));
    EXPECT_FALSE(is_red(allowed("secret")));
    EXPECT_TRUE(is_red(
        load_with(folder, "../library/red.mtl", {.assets = {folder.path() / "secret", folder.path() / "library"}})));
    EXPECT_NE(error_with(folder.path() / "model/a.obj", {.assets = {folder.path() / "missing"}}).find("missing"),
              std::string::npos);

    // What another machine named is looked for there too.
    EXPECT_TRUE(is_red(allowed("library", "C:\\job\\library\\Red.mtl")));
    EXPECT_TRUE(is_red(allowed("", "C:\\job\\library\\Red.mtl")));
    EXPECT_TRUE(is_red(allowed("", (folder.path() / "library/red.mtl").c_str())));
}

TEST(Paths, LinksAndDetoursLeadNowhereElse) {
    const TempFolder folder;
    folder.write("secret/blue.mtl", blue);
    folder.write("library/red.mtl", red);
    folder.write("model/a.obj", quad);
    std::filesystem::create_symlink(folder.path() / "secret/blue.mtl", folder.path() / "library/blue.mtl");
    std::filesystem::create_symlink(folder.path() / "secret", folder.path() / "model/inside");
    const std::string absolute = (folder.path() / "secret/blue.mtl").string();
    for (const std::string& name : std::vector<std::string>{
             "../library/blue.mtl", "inside/blue.mtl", "INSIDE/Blue.mtl", "inside/../../secret/blue.mtl",
             "../library/../secret/blue.mtl", "x/../../secret/blue.mtl", absolute, "/" + absolute}) {
        const Scene scene = load_with(folder, name, {.assets = {folder.path() / "library"}});
        EXPECT_NE(vec3(scene.materials.at(0).base_color), vec3(0, 0, 1)) << name;
        EXPECT_FALSE(scene.notes.empty()) << name;
    }
}

TEST(Paths, APlusInANameIsAPlus) {
    const TempFolder folder;
    folder.write("two+two.bin", bytes_of(triangle));
    folder.write("two two.bin", bytes_of(triangle));
    for (const char* uri : {"two+two.bin", "two%2Btwo.bin", "two%20two.bin", "two two.bin"}) {
        GltfText gltf;
        gltf.add_points(triangle);
        gltf.buffer.clear();
        gltf.more = fmt::format(R"("buffers":[{{"uri" : "{}","byteLength":36}}],)", uri);
        const Scene scene = load_scene(folder.write("a.gltf", gltf.text()));
        EXPECT_EQ(scene.triangles.size(), 1U) << uri;
        EXPECT_TRUE(scene.notes.empty()) << uri << ": " << notes_of(scene);
    }
    std::filesystem::remove(folder.path() / "two two.bin");
    GltfText gltf;
    gltf.add_points(triangle);
    gltf.buffer.clear();
    gltf.more = R"("buffers":[{"byteLength":36,"uri":"two+two.bin"}],)";
    EXPECT_EQ(error_of(folder.write("a.gltf", gltf.text())), "");
}

TEST(Paths, GltfBuffersAndPicturesFollowTheSameRules) {
    const TempFolder folder;
    folder.write("data/Points.bin", bytes_of(triangle));
    const std::vector<std::byte> png = encode_png(Image(2, 2, 3, 1.0F));
    folder.write("data/my white.png", {reinterpret_cast<const char*>(png.data()), png.size()});
    const auto file = [&](const std::string& buffer, const std::string& picture) {
        GltfText gltf;
        gltf.add_points(triangle);
        gltf.buffer.clear();
        gltf.primitives = R"({"attributes":{"POSITION":0},"material":0})";
        gltf.more = fmt::format(
            R"("buffers":[{{"byteLength":36,"uri":"{}"}}],"images":[{{"uri":"{}"}}],"textures":[{{"source":0}}],)"
            R"("materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],)",
            buffer, picture);
        return folder.write("models/a.gltf", gltf.text());
    };
    const std::string name = file("../data/Points.bin", "../data/my%20white.png");
    const std::string refusal = error_of(name);
    EXPECT_NE(refusal.find("'../data/Points.bin' lies outside the model's folder; allow it with --assets DIR"),
              std::string::npos)
        << refusal;
    const Scene found = load_scene(name, {.assets = {folder.path() / "data"}});
    EXPECT_EQ(found.triangles.size(), 1U);
    EXPECT_EQ(found.textures.size(), 1U);
    EXPECT_FALSE(has_note(found, "white")) << notes_of(found);
    const Scene other = load_scene(file("../data/points.BIN", "C:\\\\x\\\\my white.png"), {.assets = {folder.path()}});
    EXPECT_EQ(other.triangles.size(), 1U);
    EXPECT_TRUE(has_note(other, "Points.bin")) << notes_of(other);
    // A picture costs the picture, and the same sentence says how.
    folder.write("models/points.bin", bytes_of(triangle));
    const Scene bare = load_scene(file("points.bin", "../data/my%20white.png"));
    EXPECT_TRUE(has_note(bare, "allow it with --assets DIR")) << notes_of(bare);
}

TEST(Paths, TomlScenesReachNoFurther) {
    const TempFolder folder;
    folder.write("library/a.obj", quad);
    const std::string scene = folder.write("scenes/a.toml", "[[file]]\npath = \"../library/a.obj\"\n");
    EXPECT_NE(error_of(scene).find("allow it with --assets DIR"), std::string::npos) << error_of(scene);
    EXPECT_EQ(load_scene(scene, {.assets = {folder.path() / "library"}}).triangles.size(), 2U);
    // What a scene places may use what lies in the scene's own folder: that one the user named.
    folder.write("set/textures/red.mtl", red);
    folder.write("set/models/a.obj", fmt::format("mtllib ../textures/red.mtl\n{}", quad));
    EXPECT_TRUE(is_red(load_scene(folder.write("set/a.toml", "[[file]]\npath = \"models/a.obj\"\n"))));
}

TEST(Paths, NotesOfPlacedFilesCarryTheirName) {
    const TempFolder folder;
    folder.write("gate/a.obj", fmt::format("l 1 2\n{}", quad));
    const Scene scene = load_scene(folder.write("a.toml", "[[file]]\npath = \"gate/a.obj\"\n"));
    EXPECT_TRUE(has_note(scene, "'gate/a.obj': Skipped 1 line or point")) << notes_of(scene);
}

}  // namespace
}  // namespace gn::paths_test
