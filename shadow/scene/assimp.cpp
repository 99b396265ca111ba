// SPDX-License-Identifier: MIT
// Formats other than glTF and OBJ, through Assimp, whose file access is kept inside the model's folder.
#include "base/error.h"
#include "shadow/scene/files.h"
#include "shadow/scene/model.h"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <cstring>

namespace gn {

namespace {

constexpr std::size_t largest_file = std::size_t{512} << 20U;

// Files as copies in memory: nothing can be opened that Folder would not resolve, and nothing is written.
class FolderIo : public Assimp::IOSystem {
  public:
    FolderIo(const Folder& folder, std::filesystem::path model) : folder_(folder), model_(std::move(model)) {}

    bool Exists(const char* name) const override { return find(name).has_value(); }
    char getOsSeparator() const override { return '/'; }
    void Close(Assimp::IOStream* stream) override { delete stream; }

    Assimp::IOStream* Open(const char* name, const char* mode) override {
        const std::optional<std::filesystem::path> file = find(name);
        if (!file || std::strchr(mode, 'w') != nullptr) {
            return nullptr;
        }
        try {
            const std::vector<std::byte> bytes = read_file(*file, largest_file);
            auto* copy = new std::uint8_t[bytes.size()];
            std::memcpy(copy, bytes.data(), bytes.size());
            return new Assimp::MemoryIOStream(copy, bytes.size(), true);
        } catch (const Error&) {
            return nullptr;
        }
    }

  private:
    std::optional<std::filesystem::path> find(const char* name) const {
        if (model_ == name) {
            return model_;
        }
        try {
            return folder_.resolve(name);
        } catch (const Error&) {
            return std::nullopt;
        }
    }

    const Folder& folder_;
    std::filesystem::path model_;
};

dmat4 from_assimp(const aiMatrix4x4& m) {
    return glm::transpose(
        dmat4(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4));
}

vec3 from_assimp(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

Mesh convert_mesh(const aiMesh& data) {
    Mesh mesh;
    mesh.name = clean_text(data.mName.C_Str());
    mesh.material = static_cast<int>(data.mMaterialIndex);
    if ((data.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0U || data.mVertices == nullptr) {
        return mesh;
    }
    for (unsigned v = 0; v < data.mNumVertices; ++v) {
        mesh.positions_os.emplace_back(from_assimp(data.mVertices[v]));
        mesh.normals_os.push_back(data.HasNormals() ? from_assimp(data.mNormals[v]) : vec3(0.0F));
        const vec3 uv = data.HasTextureCoords(0) ? from_assimp(data.mTextureCoords[0][v]) : vec3(0.0F);
        mesh.uvs.emplace_back(uv.x, 1.0F - uv.y);
    }
    for (unsigned f = 0; f < data.mNumFaces; ++f) {
        const aiFace& face = data.mFaces[f];
        if (face.mNumIndices == 3) {
            const uvec3 t(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
            if (std::max({t.x, t.y, t.z}) < data.mNumVertices) {
                mesh.triangles.push_back(t);
            }
        }
    }
    return mesh;
}

Material convert_material(const aiMaterial& data, const Folder& folder, Model& model) {
    Material material;
    aiString name;
    material.name = data.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS ? clean_text(name.C_Str()) : "";
    aiColor4D color(0.8F, 0.8F, 0.8F, 1.0F);
    data.Get(AI_MATKEY_COLOR_DIFFUSE, color);
    float opacity = 1.0F;
    data.Get(AI_MATKEY_OPACITY, opacity);
    material.base_color = glm::clamp(vec4(color.r, color.g, color.b, opacity), vec4(0.0F), vec4(1.0F));
    material.alpha_mode = material.base_color.w < 1.0F ? AlphaMode::blend : AlphaMode::opaque;

    aiString file;
    if (data.GetTexture(aiTextureType_DIFFUSE, 0, &file) == aiReturn_SUCCESS && file.length > 0) {
        try {
            Image8 image = decode_image(read_file(folder.resolve(file.C_Str())), clean_text(file.C_Str()));
            material.base_color_texture = static_cast<int>(model.textures.size());
            material.base_color = vec4(1.0F, 1.0F, 1.0F, material.base_color.w);
            model.textures.push_back({clean_text(file.C_Str()), std::move(image), true, true});
        } catch (const Error& problem) {
            add_note(model.notes, fmt::format("Texture ignored: {}.", problem.what()));
        }
    }
    return material;
}

// Depth first with a stack of our own: the file decides how deep.
void place_nodes(const aiNode* root, Model& model) {
    struct Pending {
        const aiNode* node;
        dmat4 ws_from_parent;
    };
    std::vector<Pending> stack{{root, dmat4(1.0)}};
    std::size_t triangles = 0;
    while (!stack.empty()) {
        const Pending pending = stack.back();
        stack.pop_back();
        const dmat4 ws_from_node = pending.ws_from_parent * from_assimp(pending.node->mTransformation);
        for (unsigned i = 0; i < pending.node->mNumMeshes; ++i) {
            const std::size_t mesh = pending.node->mMeshes[i];
            if (mesh >= model.meshes.size() || model.meshes[mesh].triangles.empty()) {
                continue;
            }
            triangles += model.meshes[mesh].triangles.size();
            if (model.instances.size() >= max_instances || triangles > max_triangles) {
                fail("the file has more than {} instances or {} triangles", max_instances, max_triangles);
            }
            model.instances.push_back({mesh, ws_from_node, clean_text(pending.node->mName.C_Str())});
        }
        for (unsigned i = pending.node->mNumChildren; i-- > 0;) {
            stack.push_back({pending.node->mChildren[i], ws_from_node});
        }
    }
}

}  // namespace

Model load_assimp(const std::filesystem::path& path, const Assets& assets) {
    const Folder folder(path, assets);
    const std::string shown = clean_text(path.string());
    read_file(path, largest_file);
    Assimp::Importer importer;
    importer.SetIOHandler(new FolderIo(folder, path));
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* data = nullptr;
    try {
        data = importer.ReadFile(path.string(),
                                 aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_JoinIdenticalVertices);
    } catch (const std::exception& problem) {
        fail("{}: cannot be read ({})", shown, clean_text(problem.what()));
    }
    if (data == nullptr || data->mRootNode == nullptr) {
        fail("{}: cannot be read ({})", shown, clean_text(importer.GetErrorString()));
    }

    Model model;
    for (unsigned i = 0; i < data->mNumMaterials; ++i) {
        model.materials.push_back(convert_material(*data->mMaterials[i], folder, model));
    }
    if (model.materials.empty()) {
        model.materials.push_back({.name = "default"});
    }
    for (unsigned i = 0; i < data->mNumMeshes; ++i) {
        model.meshes.push_back(convert_mesh(*data->mMeshes[i]));
        const bool known = model.meshes.back().material < static_cast<int>(model.materials.size());
        model.meshes.back().material = known ? model.meshes.back().material : 0;
    }
    place_nodes(data->mRootNode, model);
    for (std::string& note : folder.take_notes()) {
        add_note(model.notes, std::move(note));
    }
    return model;
}

}  // namespace gn
