// SPDX-License-Identifier: MIT
// Folders of baked shaders: what they hold is found without any source, and what is damaged, missing or of another library is
// a sentence. Needs no device.
#include "gpu/baked_shaders.h"

#include "gpu/shader_cache.h"
#include "gpu/test_device.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace gn::baked_shaders_test {
namespace {

namespace fs = std::filesystem;

const ShaderSource doubling = compute_shader("doubling",
                                             "#include \"twice.glsl\"\n"
                                             R"(
layout(local_size_x = 1) in;
layout(binding = 3, scalar) buffer Values { float v[]; } values;
void main() { values.v[0] = twice(values.v[0]); }
)");

class Baked : public ::testing::Test {
  protected:
    fs::path root = fs::path(testing::TempDir()) / fmt::format("gnomon-baked-{}", ::getpid());
    fs::path folder = root / "baked";
    std::vector<std::uint32_t> code;

    void SetUp() override {
        fs::remove_all(root);
        fs::create_directories(folder / "shaders");
        std::ofstream(root / "twice.glsl") << "float twice(float x) { return 2.0 * x; }\n";
        ShaderCompiler compiler(root, {});
        code = compiler.compile(doubling).spirv;
        ShaderCache(folder / "shaders").store(baked_key(doubling), code);
        write(text_of(manifest()));
    }
    void TearDown() override { fs::remove_all(root); }

    [[nodiscard]] static BakedManifest manifest() {
        return {.recipes = {"pcf", "hard,placement=cascades"},
                .notes = {"a note"},
                .shaders = {{baked_key(doubling), "doubling"}}};
    }
    void write(const std::string& text) const { std::ofstream(folder / "manifest.txt", std::ios::binary) << text; }
    [[nodiscard]] fs::path shader() const { return folder / "shaders" / (baked_key(doubling).hex() + ".spv"); }
    [[nodiscard]] std::string compile_error(const ShaderSource& source) const {
        return error_of([&] { ShaderCompiler(std::make_shared<const BakedShaders>(folder)).compile(source); });
    }
};

TEST_F(Baked, ShadersAreFoundWithoutTheirSources) {
    fs::remove(root / "twice.glsl");
    ShaderCompiler shaders(std::make_shared<const BakedShaders>(folder));
    const CompiledShader& found = shaders.compile(doubling);
    EXPECT_EQ(found.spirv, code);
    EXPECT_EQ(found.bindings.at("values").binding, 3U);
    EXPECT_FALSE(shaders.has_sources());
    ShaderSource sealed = doubling;
    sealed.seal();
    EXPECT_EQ(&shaders.compile(sealed), &found);
}

TEST_F(Baked, AShaderThatIsNotThereIsNamed) {
    const ShaderCompiler shaders(std::make_shared<const BakedShaders>(folder));
    ShaderSource other = doubling;
    other.name = "another one";
    const std::string error = compile_error(other);
    EXPECT_NE(error.find("'another one' is not in " + folder.string()), std::string::npos) << error;
    other = doubling;
    other.text += "\n";
    EXPECT_NE(compile_error(other), "");
    EXPECT_EQ(BakedShaders(folder).command_with("pcf"),
              "gnomon bake pcf hard,placement=cascades -o " + folder.string());
    EXPECT_EQ(BakedShaders(folder).command_with("vsm"),
              "gnomon bake pcf hard,placement=cascades vsm -o " + folder.string());
}

TEST_F(Baked, WhatIsWrittenIsReadAgain) {
    const BakedManifest read = parse_manifest(text_of(manifest()), "here");
    EXPECT_EQ(read.recipes, manifest().recipes);
    EXPECT_EQ(read.notes, manifest().notes);
    EXPECT_EQ(read.shaders, manifest().shaders);
    EXPECT_EQ(read.library, library_stamp());
}

TEST_F(Baked, AnotherLibraryRefusesIt) {
    BakedManifest other = manifest();
    other.library = "0.0.9-0123456789abcdef";
    write(text_of(other));
    const std::string error = error_of([&] { BakedShaders baked(folder); });
    for (const std::string& part : {std::string("0.0.9-0123456789abcdef"), library_stamp(),
                                    std::string("gnomon bake pcf hard,placement=cascades -o")}) {
        EXPECT_NE(error.find(part), std::string::npos) << error;
    }
    write("gnomon baked 2\n" + text_of(manifest()));
    EXPECT_NE(error_of([&] { BakedShaders baked(folder); }).find("another gnomon"), std::string::npos);
}

TEST_F(Baked, ADamagedManifestIsASentence) {
    const std::string whole = text_of(manifest());
    for (std::size_t bytes = 0; bytes + 1 < whole.size(); ++bytes) {
        EXPECT_NE(error_of([&] { parse_manifest(whole.substr(0, bytes), "here"); }), "") << bytes;
    }
    // A changed byte is noticed, or stands in a text that is only shown.
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = '/';
        const std::string error = error_of([&] {
            for (const auto& [key, name] : parse_manifest(damaged, "here").shaders) {
                EXPECT_EQ(key, baked_key(doubling)) << i;
            }
        });
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
    for (const std::string& line :
         {std::string("shader ../../../../etc/passwd x"), std::string("shader "), std::string("shader 0123 x"),
          "shader " + std::string(31, '0') + "G x", "shader " + std::string(31, '0') + "/ x", std::string("verse 1")}) {
        const std::string error = error_of([&] {
            parse_manifest(fmt::format("gnomon baked 1\nlibrary {}\n{}\nend 1\n", library_stamp(), line), "here");
        });
        EXPECT_NE(error.find("line 3"), std::string::npos) << line << ": " << error;
    }
    EXPECT_NE(error_of([&] { parse_manifest(whole + "shader x\n", "here"); }).find("follows the end"),
              std::string::npos);
}

TEST_F(Baked, WhatIsNoPlainFileOrTooLargeIsNotRead) {
    const auto refuses = [&] {
        return error_of([&] { BakedShaders baked(folder); }).find("manifest.txt") != std::string::npos;
    };
    fs::remove(folder / "manifest.txt");
    EXPECT_TRUE(refuses());
    ASSERT_EQ(mkfifo((folder / "manifest.txt").c_str(), 0600), 0);
    EXPECT_TRUE(refuses()) << "a pipe would never end";
    fs::remove(folder / "manifest.txt");
    write("");
    fs::resize_file(folder / "manifest.txt", std::uintmax_t{1} << 40);
    EXPECT_TRUE(refuses());
    EXPECT_NE(error_of([&] { BakedShaders baked(root / "nowhere"); }), "");
}

TEST_F(Baked, ADamagedShaderIsASentence) {
    const auto damaged = [&] {
        const std::string error = compile_error(doubling);
        return error.find("missing or damaged") != std::string::npos &&
               error.find("gnomon bake pcf") != std::string::npos;
    };
    const auto bytes = fs::file_size(shader());
    std::fstream(shader(), std::ios::in | std::ios::out | std::ios::binary).seekp(-3, std::ios::end).put('!');
    EXPECT_TRUE(damaged());
    fs::resize_file(shader(), bytes / 2);
    EXPECT_TRUE(damaged());
    fs::resize_file(shader(), std::uintmax_t{1} << 34);
    EXPECT_TRUE(damaged());
    fs::remove(shader());
    EXPECT_TRUE(damaged());
    fs::create_directory(shader());
    EXPECT_TRUE(damaged());
    // Intact code that is no module is refused by whoever reads its interface.
    fs::remove(shader());
    ShaderCache(folder / "shaders").store(baked_key(doubling), {1, 2, 3, 4, 5, 6});
    EXPECT_NE(compile_error(doubling), "");
}

}  // namespace
}  // namespace gn::baked_shaders_test
