// SPDX-License-Identifier: MIT
// Every portable shader file and every shared header compiles alone inside a bare shader, and may be included twice.
// Headers on their own as C++ are the target headers_alone.
#include "base/paths.h"
#include "gpu/shader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace gn::include_test {
namespace {

namespace fs = std::filesystem;

const fs::path root = data_root();

std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// Shared headers are guarded by #ifndef, since GLSL has no #pragma once; headers for the host alone have the pragma.
bool is_shared_header(const fs::path& path) {
    return path.extension() == ".h" && text_of(path).find("#pragma once") == std::string::npos;
}

/// Functions for anybody's shader are guarded. A .glsl without a guard is the body of one shader, which a source completes
/// (tests/layout_rules.py holds it to that): it names inputs that are declared there.
bool is_portable(const fs::path& path) {
    return path.extension() == ".glsl" && text_of(path).find("#ifndef GN_") != std::string::npos;
}

std::vector<std::string> includable_files() {
    std::vector<std::string> found;
    for (const char* folder : {"base", "gpu", "shadow"}) {
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
            const fs::path relative = fs::relative(entry.path(), root);
            if (entry.is_regular_file() && (is_portable(entry.path()) || is_shared_header(entry.path()))) {
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

/// A comment of a portable file that shows what a host may define: `//   #define GN_X 1`, and on lines `//   with #define ...`
/// what it must define with it.
struct Optional {
    std::string name, text;
};

std::vector<Optional> shown_defines(const std::string& text) {
    static const std::regex line(R"(//   (with )?(#define (GN_\w+).*))");
    std::vector<Optional> shown;
    for (std::sregex_iterator found(text.begin(), text.end(), line), end; found != end; ++found) {
        if ((*found)[1].matched && !shown.empty()) {
            shown.back().text += (*found)[2].str() + "\n";
        } else {
            shown.push_back({(*found)[3], (*found)[2].str() + "\n"});
        }
    }
    return shown;
}

/// Names that a file asks for by #if, its own guard left out.
std::set<std::string> asked_defines(const std::string& text) {
    static const std::regex line(R"(#(?:ifdef|ifndef|if|elif).*)");
    static const std::regex name(R"(GN_\w+)");
    std::set<std::string> asked;
    for (std::sregex_iterator found(text.begin(), text.end(), line), end; found != end; ++found) {
        const std::string condition = found->str();
        for (std::sregex_iterator word(condition.begin(), condition.end(), name); word != end; ++word) {
            if (!word->str().ends_with("_GLSL") && !word->str().ends_with("_H")) {
                asked.insert(word->str());
            }
        }
    }
    return asked;
}

TEST(Include, every_portable_file_compiles_under_each_of_its_optional_defines) {
    ShaderCompiler compiler(root, {});
    int compiled = 0;
    for (const std::string& file : includable_files()) {
        const std::string text = text_of(root / file);
        const std::vector<Optional> shown = shown_defines(text);
        for (const std::string& name : asked_defines(text)) {
            EXPECT_TRUE(std::any_of(shown.begin(), shown.end(), [&](const Optional& o) { return o.name == name; }))
                << file << " asks for " << name << " and shows no host how to define it: //   #define " << name
                << " ...";
        }
        for (const Optional& define : shown) {
            ShaderSource source = bare_shader(file);
            source.text = define.text + source.text;
            try {
                EXPECT_FALSE(compiler.compile(source).spirv.empty()) << file;
                ++compiled;
            } catch (const Error& error) {
                ADD_FAILURE() << file << " does not compile with " << define.text << error.what();
            }
        }
    }
    EXPECT_GT(compiled, 8);
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
}  // namespace gn::include_test
