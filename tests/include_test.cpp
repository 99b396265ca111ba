// SPDX-License-Identifier: MIT
// Every portable shader file and every shared header compiles alone inside a bare shader, and may be included twice.
// Headers on their own as C++ are the target headers_alone.
#include "gpu/shader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace gn {
namespace {

namespace fs = std::filesystem;

const fs::path root = GNOMON_SOURCE_DIR;

std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// Shared headers are guarded by #ifndef, since GLSL has no #pragma once; headers for the host alone have the pragma.
bool is_shared_header(const fs::path& path) {
    return path.extension() == ".h" && text_of(path).find("#pragma once") == std::string::npos;
}

/// Stages read their inputs under names of their own, so only the portable files are held to compiling alone: a part's
/// <id>.glsl, and what a stage's folder or shadow/ itself shares.
bool is_portable(const fs::path& relative) {
    if (relative.extension() != ".glsl") {
        return false;
    }
    const auto depth = std::distance(relative.begin(), relative.end());
    return depth <= 3 || relative.stem() == relative.parent_path().filename();
}

std::vector<std::string> includable_files() {
    std::vector<std::string> found;
    for (const char* folder : {"base", "gpu", "shadow"}) {
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
            const fs::path relative = fs::relative(entry.path(), root);
            if (entry.is_regular_file() && (is_portable(relative) || is_shared_header(entry.path()))) {
                found.push_back(relative.generic_string());
            }
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

ShaderSource bare_shader(const std::string& include) {
    return {ShaderKind::fragment, include,
            "#include \"" + include + "\"\n#include \"" + include + "\"\nvoid main() {}\n"};
}

TEST(Include, there_are_files_to_check) {
    const std::vector<std::string> files = includable_files();
    EXPECT_NE(std::find(files.begin(), files.end(), "base/shared.h"), files.end());
    EXPECT_NE(std::find(files.begin(), files.end(), "shadow/receiver/receiver.glsl"), files.end());
    EXPECT_EQ(std::find(files.begin(), files.end(), "base/math.h"), files.end()) << "a header for the host alone";
}

TEST(Include, every_portable_file_compiles_alone_and_twice) {
    ShaderCompiler compiler(root, {});
    for (const std::string& file : includable_files()) {
        try {
            EXPECT_FALSE(compiler.compile(bare_shader(file)).spirv.empty()) << file;
        } catch (const Error& error) {
            ADD_FAILURE() << file << " does not compile alone: " << error.what();
        }
    }
}

TEST(Include, a_file_that_leans_on_another_is_noticed) {
    const fs::path folder = fs::path(testing::TempDir()) / "gnomon-include-test";
    fs::create_directories(folder);
    std::ofstream(folder / "leaning.glsl") << "float gn_leaning() { return gn_defined_elsewhere(); }\n";
    ShaderCompiler compiler(folder, {});
    EXPECT_THROW(compiler.compile(bare_shader("leaning.glsl")), Error);
}

TEST(Include, an_unguarded_file_is_noticed) {
    const fs::path folder = fs::path(testing::TempDir()) / "gnomon-include-test";
    fs::create_directories(folder);
    std::ofstream(folder / "unguarded.glsl") << "float gn_unguarded() { return 1.0; }\n";
    ShaderCompiler compiler(folder, {});
    EXPECT_THROW(compiler.compile(bare_shader("unguarded.glsl")), Error);
}

}  // namespace
}  // namespace gn
