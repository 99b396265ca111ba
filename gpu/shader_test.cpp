// SPDX-License-Identifier: MIT
// Composition, error sentences, the disk cache and reflection; needs no device.
#include "gpu/pipeline_cache.h"
#include "gpu/shader_cache.h"
#include "gpu/shader_inputs.h"
#include "gpu/spirv.h"
#include "gpu/test_device.h"

#include <filesystem>
#include <fstream>
#include <set>

#include <unistd.h>

namespace gn::shader_test {
namespace {

namespace fs = std::filesystem;

TEST(ShaderInputs, ConstantsBeginWithANumberThatNeverChanges) {
    ShaderInputs none, inputs, more;
    EXPECT_EQ(none.text(), "");
    more.constant("float", "second", 2.0F);
    inputs.constant("vec4", "first", vec4(1)).add(more).add(none);
    EXPECT_EQ(inputs.text(3),
              "layout(binding = 3, scalar) uniform Constants {\n    uvec4 unread;\n    vec4 first;\n    float "
              "second;\n} u;\n");
}

/// A folder of its own for each test, with includes in it and a cache beside.
class Shaders : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        root = fs::path(::testing::TempDir()) / fmt::format("gnomon-shaders-{}-{}", info->name(), ::getpid());
        fs::remove_all(root);
        fs::create_directories(root);
    }
    void TearDown() override { fs::remove_all(root); }

    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((root / name).parent_path());
        std::ofstream(root / name) << text;
    }
    [[nodiscard]] ShaderCompiler compiler() const { return {root, root / "cache"}; }
    [[nodiscard]] std::vector<fs::path> cached() const {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(root / "cache")) {
            files.push_back(entry.path());
        }
        return files;
    }

    fs::path root;
};

constexpr const char* doubling = R"(
layout(local_size_x = 1) in;
layout(binding = 3, scalar) buffer Values { float v[]; } values;
void main() { values.v[0] *= 2.0; }
)";

TEST_F(Shaders, AnErrorNamesTheIncludesOwnLine) {
    write("shadow/broken.glsl", "float fine() { return 1.0; }\n\nfloat broken() { return missing_name; }\n");
    auto shaders = compiler();
    const std::string error = error_of(
        [&] { shaders.compile(compute_shader("outer", "\n#include \"shadow/broken.glsl\"\nvoid main() {}\n")); });
    EXPECT_NE(error.find("shader 'outer'"), std::string::npos) << error;
    EXPECT_NE(error.find("shadow/broken.glsl:3:"), std::string::npos) << error;
    EXPECT_NE(error.find("missing_name"), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << "one sentence";
}

TEST_F(Shaders, AnErrorAfterAnIncludeNamesTheTextsOwnLine) {
    write("a.glsl", "float a() { return 1.0; }\n\n\n");
    auto shaders = compiler();
    const std::string error = error_of(
        [&] { shaders.compile(compute_shader("outer", "#include \"a.glsl\"\nvoid main() {\n  nothing;\n}\n")); });
    EXPECT_NE(error.find("outer:3:"), std::string::npos) << error;
}

TEST_F(Shaders, AMissingIncludeIsNamed) {
    auto shaders = compiler();
    for (const char* path : {"no/such.glsl", "../outside.glsl", "/etc/hostname"}) {
        const std::string error = error_of([&] {
            shaders.compile(compute_shader("outer", fmt::format("#include \"{}\"\nvoid main() {{}}\n", path)));
        });
        EXPECT_NE(error.find(path), std::string::npos) << error;
    }
}

TEST_F(Shaders, AnotherProcessFindsTheCode) {
    std::vector<std::uint32_t> first;
    {
        auto shaders = compiler();
        first = shaders.compile(compute_shader("doubling", doubling)).spirv;
    }
    ASSERT_EQ(cached().size(), 1U);

    // Replace the entry by other intact code: who finds it has not compiled.
    const fs::path entry = cached().front();
    ShaderCompiler elsewhere(root, {});
    const auto other = elsewhere.compile(compute_shader("empty", "void main() {}")).spirv;
    const ShaderCache cache(root / "cache");
    cache.store({}, other);
    fs::rename(cache.file({}), entry);
    auto shaders = compiler();
    EXPECT_EQ(shaders.compile(compute_shader("doubling", doubling)).spirv, other);
    EXPECT_NE(other, first);
}

TEST_F(Shaders, ADamagedEntryIsIgnoredAndRepaired) {
    std::vector<std::uint32_t> first;
    {
        auto shaders = compiler();
        first = shaders.compile(compute_shader("doubling", doubling)).spirv;
    }
    const fs::path entry = cached().front();
    const auto whole = fs::file_size(entry);
    const auto damage = [&](const std::function<void()>& how) {
        how();
        auto shaders = compiler();
        EXPECT_EQ(shaders.compile(compute_shader("doubling", doubling)).spirv, first);
        EXPECT_EQ(fs::file_size(entry), whole) << "repaired";
    };
    damage([&] { fs::resize_file(entry, whole / 2); });
    damage([&] { fs::resize_file(entry, 0); });
    damage([&] {
        std::fstream file(entry, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(whole / 2));
        file.put('\x5A');
    });
    EXPECT_EQ(cached().size(), 1U) << "no temporary files stay";
}

TEST_F(Shaders, AChangedIncludeIsCompiledAgain) {
    const auto source = compute_shader("uses",
                                       "#include \"outer.glsl\"\n"
                                       R"(
layout(local_size_x = 1) in;
layout(binding = 0, scalar) buffer Out { float v; } result;
void main() { result.v = inner(); }
)");
    write("outer.glsl", "#include \"inner.glsl\"\n");
    write("inner.glsl", "float inner() { return 1.0; }\n");
    const auto compile = [&] {
        auto shaders = compiler();
        return shaders.compile(source).spirv;
    };
    const auto before = compile();
    write("inner.glsl", "float inner() { return 2.0; }\n");
    EXPECT_NE(compile(), before);
    EXPECT_EQ(cached().size(), 2U);
}

/// A shader that reads `value()` of an include.
ShaderSource reader(const std::string& name) {
    return compute_shader(name,
                          "#include \"value.glsl\"\n"
                          R"(
layout(local_size_x = 1) in;
layout(binding = 0, scalar) buffer Out { float v; } result;
void main() { result.v = value(); }
)");
}

TEST_F(Shaders, ReloadTakesUpWhatWasWritten) {
    write("value.glsl", "float value() { return 1.0; }\n");
    auto shaders = compiler();
    const CompiledShader& other = shaders.compile(compute_shader("doubling", doubling));
    const CompiledShader& shader = shaders.compile(reader("reader"));
    const auto first = shader.spirv, untouched = other.spirv;
    EXPECT_TRUE(shaders.reload().empty());
    write("value.glsl", "float value() { return 23.0; }\n");
    EXPECT_EQ(shader.spirv, first) << "only when it is asked for";
    EXPECT_EQ(shaders.reload(), std::vector{reader("reader").work_out()});
    EXPECT_NE(shader.spirv, first);
    EXPECT_EQ(other.spirv, untouched);
    EXPECT_TRUE(shaders.reload().empty());
    write("value.glsl", "float value() { return 23.0; } // other words, the same code\n");
    EXPECT_TRUE(shaders.reload().empty());
    write("value.glsl", "float value() { return 1.0; }\n");
    EXPECT_EQ(shaders.reload().size(), 1U);
    EXPECT_EQ(shader.spirv, first);
}

TEST_F(Shaders, AReloadThatDoesNotCompileChangesNothing) {
    write("value.glsl", "float value() { return 1.0; }\n");
    auto shaders = compiler();
    const CompiledShader& a = shaders.compile(reader("a"));
    const auto first = a.spirv;
    write("value.glsl", "float value() { return 2.0 }\n");
    for (int i = 0; i < 2; ++i) {
        const std::string error = error_of([&] { shaders.reload(); });
        EXPECT_NE(error.find("value.glsl:1:"), std::string::npos) << error;
        EXPECT_EQ(a.spirv, first);
    }
    write("value.glsl", "float value() { return 2.0; }\n");
    EXPECT_EQ(shaders.reload().size(), 1U);
    EXPECT_NE(a.spirv, first);
    fs::remove(root / "value.glsl");
    EXPECT_NE(error_of([&] { shaders.reload(); }).find("value.glsl"), std::string::npos);
}

TEST_F(Shaders, WhatIsCompiledAfterAFailedReloadBelongsToWhatIsThere) {
    write("value.glsl", "float value() { return 1.0; }\n");
    auto shaders = compiler();
    shaders.compile(reader("a"));
    write("value.glsl", "float value() { return 2.0 }\n");
    EXPECT_NE(error_of([&] { shaders.reload(); }), "");
    shaders.compile(reader("b"));
    write("value.glsl", "float value() { return 2.0; }\n");
    EXPECT_EQ(shaders.reload().size(), 2U);
}

TEST_F(Shaders, AnUndoneReloadIsTriedAgain) {
    write("value.glsl", "float value() { return 1.0; }\n");
    auto shaders = compiler();
    const CompiledShader& shader = shaders.compile(reader("reader"));
    const auto first = shader.spirv;
    write("value.glsl", "float value() { return 2.0; }\n");
    EXPECT_EQ(shaders.reload().size(), 1U);
    shaders.undo_reload();
    EXPECT_EQ(shader.spirv, first);
    EXPECT_EQ(shaders.reload().size(), 1U);
    EXPECT_NE(shader.spirv, first);
}

TEST_F(Shaders, WithoutACacheFolderNothingIsWritten) {
    ShaderCompiler shaders(root, {});
    EXPECT_FALSE(shaders.compile(compute_shader("doubling", doubling)).spirv.empty());
    EXPECT_TRUE(fs::is_empty(root));
}

TEST_F(Shaders, BindingsCarryTheAuthorsNames) {
    auto shaders = compiler();
    const CompiledShader& shader = shaders.compile(fragment_shader("bindings", R"(
struct Inner { vec2 a; float b; };
layout(binding = 0) uniform sampler2D plain;
layout(binding = 1) uniform sampler2DArrayShadow layered;
layout(binding = 2) uniform usamplerCube cube;
layout(binding = 3, r32ui) uniform uimage2D counters;
layout(binding = 4, scalar) uniform Params { mat4 m; vec3 v; Inner inner[2]; } params;
layout(binding = 5, scalar) readonly buffer Unnamed { float first; float values[]; };
layout(binding = 6) uniform sampler2D never_read;
layout(binding = 7) uniform sampler2DMS samples;
layout(push_constant, scalar) uniform Push { vec3 a; float b; mat2 c; } push;
layout(location = 0) out vec4 color;
void main() {
    color = texture(plain, vec2(0)) + texture(layered, vec4(0)) + vec4(texture(cube, vec3(1)));
    color += params.m[0] + vec4(params.inner[1].b + values[2] + push.b) + texelFetch(samples, ivec2(0), 0);
    imageAtomicAdd(counters, ivec2(0), 1u);
}
)"));
    const auto& found = shader.bindings;
    ASSERT_EQ(found.size(), 7U) << "never_read is declared but not used";
    EXPECT_EQ(found.at("plain").vk_descriptor_type, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    EXPECT_EQ(found.at("plain").image_dim, 1U);
    EXPECT_TRUE(found.at("layered").arrayed);
    EXPECT_EQ(found.at("cube").image_dim, 3U);
    EXPECT_TRUE(found.at("cube").integer);
    EXPECT_EQ(found.at("counters").vk_descriptor_type, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
    EXPECT_EQ(found.at("counters").binding, 3U);
    EXPECT_EQ(found.at("params").vk_descriptor_type, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
    EXPECT_EQ(found.at("params").block_bytes, 64U + 12 + 2 * 12) << "scalar layout";
    EXPECT_EQ(found.at("Unnamed").vk_descriptor_type, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    EXPECT_EQ(found.at("Unnamed").block_bytes, 4U);
    EXPECT_TRUE(found.at("samples").multisampled);
    EXPECT_EQ(shader.push_constant_bytes, 12U + 4 + 16);
}

TEST_F(Shaders, AResourceWithoutABindingIsAnError) {
    auto shaders = compiler();
    const std::string error = error_of([&] {
        shaders.compile(fragment_shader("unbound", R"(
uniform sampler2D loose;
layout(location = 0) out vec4 color;
void main() { color = texture(loose, vec2(0)); }
)"));
    });
    EXPECT_NE(error.find("unbound:2:"), std::string::npos) << error;
    EXPECT_NE(error.find("binding"), std::string::npos) << error;
}

TEST_F(Shaders, StagesThatDisagreeAreAnError) {
    CompiledShader vertex{.kind = ShaderKind::vertex, .name = "v", .bindings = {{"scene", {.binding = 1}}}};
    CompiledShader fragment{.kind = ShaderKind::fragment, .name = "f", .bindings = {{"scene", {.binding = 2}}}};
    const std::array<const CompiledShader*, 2> both{&vertex, &fragment};
    const std::string by_number = error_of([&] { merge_bindings(both); });
    EXPECT_NE(by_number.find("'scene'"), std::string::npos) << by_number;
    fragment.bindings = {{"lights", {.binding = 1}}};
    const std::string by_name = error_of([&] { merge_bindings(both); });
    EXPECT_NE(by_name.find("'lights'"), std::string::npos) << by_name;
    fragment.bindings = {{"scene", {.binding = 1, .block_bytes = 8}}};
    const auto merged = merge_bindings(both);
    ASSERT_EQ(merged.size(), 1U);
    EXPECT_EQ(merged[0].stages, VkShaderStageFlags{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT});
    EXPECT_EQ(merged[0].shader.block_bytes, 8U);
}

TEST_F(Shaders, DamagedCodeNeverReadsPastItsEnd) {
    auto shaders = compiler();
    const auto whole = shaders.compile(compute_shader("doubling", doubling)).spirv;
    std::size_t refused = 0;
    for (std::size_t words = 0; words < whole.size(); ++words) {
        const std::string error = error_of([&] { reflect(std::span(whole).first(words), "cut"); });
        refused += error.empty() ? 0 : 1;
    }
    EXPECT_GT(refused, whole.size() / 2) << "most cuts fall inside an instruction";
}

TEST(Fingerprints, DependOnEveryByteAndBoundary) {
    std::set<Fingerprint> seen;
    std::string text(67, 'a');
    for (std::size_t i = 0; i < text.size(); ++i) {
        std::string changed = text;
        changed[i] = 'b';
        seen.insert(Hasher().text(changed).finish());
    }
    seen.insert(Hasher().text("ab").text("c").finish());
    seen.insert(Hasher().text("a").text("bc").finish());
    seen.insert(Hasher().text("").finish());
    seen.insert(Hasher().text("").text("").finish());
    seen.insert(Hasher().value(0).value(1).finish());
    seen.insert(Hasher().value(1).value(0).finish());
    EXPECT_EQ(seen.size(), text.size() + 6);
    EXPECT_EQ((Fingerprint{0x12, 0xAB}.hex()), "00000000000000ab0000000000000012");
}

}  // namespace
}  // namespace gn::shader_test
