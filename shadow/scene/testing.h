// SPDX-License-Identifier: MIT
// For the tests of this folder: files in a folder of their own, and small glTF files as text.
#pragma once

#include "base/error.h"
#include "shadow/scene/scene.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>

namespace gn::testing_scene {

/// A new empty folder, removed with everything in it.
class TempFolder {
  public:
    TempFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "gnomon-scene-XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~TempFolder() { std::filesystem::remove_all(path_); }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    std::string write(const std::string& name, std::string_view content) const {
        const std::filesystem::path file = path_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << content;
        return file.string();
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// The sentence of the Error that loading ends in; "" when it loads.
inline std::string error_of(const std::string& file) {
    try {
        load_scene(file);
        return "";
    } catch (const std::exception& problem) {
        return problem.what();
    }
}

/// One of the scene's notes contains `text`.
inline bool has_note(const Scene& scene, std::string_view text) {
    for (const std::string& note : scene.notes) {
        if (note.find(text) != std::string::npos) {
            return true;
        }
    }
    return false;
}

inline std::string base64(std::string_view bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : digits[group >> (18U - 6U * k) & 63U];
        }
    }
    return text;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

/// Builds the text of a glTF file around one buffer; each accessor has a buffer view of its own.
struct GltfText {
    std::string buffer, views, accessors;
    std::string primitives = R"({"attributes":{"POSITION":0}})";
    std::string nodes = R"({"mesh":0})";
    std::string scene = R"("scene":0,"scenes":[{"nodes":[0]}],)";
    std::string more;  ///< further members, each with a comma behind

    template <class T>
    int add(const std::vector<T>& values, const char* type, int component, std::size_t count, const char* extra = "") {
        const std::string bytes = bytes_of(values);
        const int index = count_++;
        const char* comma = index > 0 ? "," : "";
        views += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}}})", comma, buffer.size(), bytes.size());
        accessors += fmt::format(R"({}{{"bufferView":{},"componentType":{},"type":"{}","count":{}{}}})", comma, index,
                                 component, type, count, extra);
        buffer += bytes;
        buffer.resize((buffer.size() + 3) / 4 * 4);
        return index;
    }
    int add_points(const std::vector<float>& xyz) { return add(xyz, "VEC3", 5126, xyz.size() / 3); }

    [[nodiscard]] std::string text() const {
        const std::string data =
            buffer.empty()
                ? ""
                : fmt::format(R"("buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{}"}}],)",
                              buffer.size(), base64(buffer));
        const std::string lists =
            count_ == 0 ? "" : fmt::format(R"("bufferViews":[{}],"accessors":[{}],)", views, accessors);
        const std::string meshes =
            primitives.empty() ? "" : fmt::format(R"("meshes":[{{"primitives":[{}]}}],)", primitives);
        return fmt::format(R"({{{}{}{}{}{}"nodes":[{}],"asset":{{"version":"2.0"}}}})", data, lists, meshes, scene,
                           more, nodes);
    }

  private:
    int count_ = 0;
};

/// The corners of a right triangle in the plane z = 0.
inline const std::vector<float> triangle{0, 0, 0, 1, 0, 0, 0, 1, 0};
/// A unit square as two fan or strip triangles.
inline const std::vector<float> square{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

/// Normal of a scene's triangle by its winding; not of unit length.
inline vec3 winding(const Scene& scene, std::size_t index) {
    const uvec3 t = scene.triangles.at(index);
    const vec3 a = scene.positions_ws.at(t.x);
    return glm::cross(scene.positions_ws.at(t.y) - a, scene.positions_ws.at(t.z) - a);
}

/// Six sides around a point.
inline Scene cube(vec3 centre, float half) {
    Scene scene;
    scene.name = "cube";
    for (unsigned i = 0; i < 8; ++i) {
        const vec3 sign((i & 1U) != 0U ? 1 : -1, (i & 2U) != 0U ? 1 : -1, (i & 4U) != 0U ? 1 : -1);
        scene.positions_ws.push_back(centre + half * sign);
    }
    scene.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return scene;
}

}  // namespace gn::testing_scene
