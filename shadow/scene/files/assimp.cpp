// SPDX-License-Identifier: MIT
// Formats other than glTF and OBJ, through Assimp, whose file access is kept inside the folders that may be read.
#include "base/error.h"
#include "shadow/scene/files/assimp_lights.h"
#include "shadow/scene/files/coverage.h"
#include "shadow/scene/files/files.h"
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

vec3 from_assimp(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

struct LeftOut {
    std::size_t lines_and_points = 0, faces = 0, skinned = 0, morphed = 0, colored = 0;
};

Mesh convert_mesh(const aiMesh& data, LeftOut& left_out) {
    Mesh mesh;
    mesh.name = clean_text(data.mName.C_Str());
    mesh.material = static_cast<int>(data.mMaterialIndex);
    if ((data.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0U || data.mVertices == nullptr) {
        left_out.lines_and_points += data.mNumFaces;
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
        const uvec3 t =
            face.mNumIndices == 3 ? uvec3(face.mIndices[0], face.mIndices[1], face.mIndices[2]) : uvec3(~0U);
        if (std::max({t.x, t.y, t.z}) < data.mNumVertices) {
            mesh.triangles.push_back(t);
        } else {
            ++left_out.faces;
        }
    }
    left_out.skinned += data.HasBones() ? 1U : 0U;
    left_out.colored += data.HasVertexColors(0) ? 1U : 0U;
    left_out.morphed += data.mNumAnimMeshes > 0 ? 1U : 0U;
    return mesh;
}

// The pixels of a texture that lies inside the file: a whole PNG or JPEG, or bare texels.
Image8 embedded_image(const aiTexture& data, const std::string& shown) {
    if (data.mHeight == 0) {
        return decode_image({reinterpret_cast<const std::byte*>(data.pcData), data.mWidth}, fmt::format("'{}'", shown));
    }
    constexpr unsigned widest = 16384;
    if (data.mWidth == 0 || data.mWidth > widest || data.mHeight > widest) {
        fail("'{}' has {} x {} texels; at most {} x {} are read", shown, data.mWidth, data.mHeight, widest, widest);
    }
    Image8 image{static_cast<int>(data.mWidth), static_cast<int>(data.mHeight), {}};
    const std::size_t count = std::size_t{data.mWidth} * data.mHeight;
    image.rgba.reserve(4 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const aiTexel& texel = data.pcData[i];
        image.rgba.insert(image.rgba.end(), {texel.r, texel.g, texel.b, texel.a});
    }
    return image;
}

// What is needed to read a material's pictures.
struct Source {
    const aiScene& data;
    const Folder& folder;
    Model& model;
};

std::optional<Image8> load_picture(const aiMaterial& material, aiTextureType type, const Source& source,
                                   std::string& name) {
    aiString file;
    if (material.GetTexture(type, 0, &file) != aiReturn_SUCCESS || file.length == 0) {
        return std::nullopt;
    }
    name = clean_text(file.C_Str());
    try {
        if (const aiTexture* inside = source.data.GetEmbeddedTexture(file.C_Str())) {
            return embedded_image(*inside, name);
        }
        return decode_image(read_file(source.folder.resolve(file.C_Str())), fmt::format("'{}'", name));
    } catch (const Error& problem) {
        add_note(source.model.notes, fmt::format("Texture ignored: {}.", problem.what()));
        return std::nullopt;
    }
}

bool repeats(std::vector<std::string>& notes, const aiMaterial& material, const char* key, unsigned type,
             unsigned index) {
    int mode = aiTextureMapMode_Wrap;
    material.Get(key, type, index, mode);
    if (mode == aiTextureMapMode_Mirror) {
        add_note(notes, "Mirrored repetition of a texture is shown as plain repetition.");
    }
    return mode == aiTextureMapMode_Wrap || mode == aiTextureMapMode_Mirror;
}

// The base colour's picture, with its coverage; how both count as a mask.
void load_pictures(const aiMaterial& data, const Source& source, Material& material) {
    std::string color_name, mask_name;
    std::optional<Image8> image = load_picture(data, aiTextureType_DIFFUSE, source, color_name);
    const std::optional<Image8> mask = load_picture(data, aiTextureType_OPACITY, source, mask_name);
    if (!mask && !mask_name.empty()) {
        note_lost_mask(source.model.notes, material.name);
    }
    if (image) {
        material.base_color = vec4(1.0F, 1.0F, 1.0F, material.base_color.w);
        const bool holes =
            !mask && mask_of_color(*image, material.name, "opacity map", "diffuse map", source.model.notes);
        material.alpha_mode = holes ? AlphaMode::mask : material.alpha_mode;
    } else if (mask) {
        // White where only coverage is given.
        image = Image8{mask->width, mask->height, std::vector<std::uint8_t>(mask->rgba.size(), 255)};
    }
    if (!image) {
        return;
    }
    if (mask) {
        merge_alpha(*image, *mask);
        material.alpha_mode = AlphaMode::mask;
    }
    material.base_color_texture = static_cast<int>(source.model.textures.size());
    source.model.textures.push_back(
        {color_name.empty() ? mask_name : color_name, std::move(*image),
         repeats(source.model.notes, data, AI_MATKEY_MAPPINGMODE_U(aiTextureType_DIFFUSE, 0)),
         repeats(source.model.notes, data, AI_MATKEY_MAPPINGMODE_V(aiTextureType_DIFFUSE, 0))});
}

Material convert_material(const aiMaterial& data, const Source& source) {
    Material material;
    aiString name;
    material.name = data.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS ? clean_text(name.C_Str()) : "";
    aiColor4D color(0.8F, 0.8F, 0.8F, 1.0F);
    data.Get(AI_MATKEY_COLOR_DIFFUSE, color);
    float opacity = 1.0F;
    data.Get(AI_MATKEY_OPACITY, opacity);
    material.base_color = glm::clamp(vec4(color.r, color.g, color.b, opacity), vec4(0.0F), vec4(1.0F));
    material.alpha_mode = material.base_color.w < 1.0F ? AlphaMode::blend : AlphaMode::opaque;

    load_pictures(data, source, material);
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
        const dmat4 ws_from_node = pending.ws_from_parent * matrix_from_assimp(pending.node->mTransformation);
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

void note_left_out(const LeftOut& left_out, const aiScene& data, std::vector<std::string>& notes) {
    note_count(notes, left_out.faces, "1 face with vertices that are not there is dropped.",
               "{} faces with vertices that are not there are dropped.");
    note_count(notes, left_out.lines_and_points, "1 line or point is skipped: only faces cast shadows.",
               "{} lines and points are skipped: only faces cast shadows.");
    note_count(notes, left_out.skinned, "1 mesh hangs on bones and stands as it was bound.",
               "{} meshes hang on bones and stand as they were bound.");
    note_count(notes, left_out.morphed, "1 mesh has other shapes, which are not read.",
               "{} meshes have other shapes, which are not read.");
    note_count(notes, left_out.colored, "1 mesh has colours at its vertices, which are not read.",
               "{} meshes have colours at their vertices, which are not read.");
    note_count(notes, data.mNumAnimations, "1 animation is not played: everything stands as at rest.",
               "{} animations are not played: everything stands as at rest.");
}

}  // namespace

Model load_assimp(const std::filesystem::path& path, const Assets& assets) {
    const Folder folder(path, assets);
    const std::string shown = clean_text(path.string());
    read_file(path, largest_file);
    Assimp::Importer importer;
    importer.SetIOHandler(new FolderIo(folder, path));
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

    // Materials first: meshes refer to them.
    Model model;
    for (unsigned i = 0; i < data->mNumMaterials; ++i) {
        model.materials.push_back(convert_material(*data->mMaterials[i], {*data, folder, model}));
    }
    if (model.materials.empty()) {
        model.materials.push_back({.name = "default"});
    }
    LeftOut left_out;
    for (unsigned i = 0; i < data->mNumMeshes; ++i) {
        model.meshes.push_back(convert_mesh(*data->mMeshes[i], left_out));
        const bool known = model.meshes.back().material < static_cast<int>(model.materials.size());
        model.meshes.back().material = known ? model.meshes.back().material : 0;
    }
    place_nodes(data->mRootNode, model);
    place_assimp_lights(*data, model);
    place_assimp_cameras(*data, model);
    note_left_out(left_out, *data, model.notes);
    for (std::string& note : folder.take_notes()) {
        add_note(model.notes, std::move(note));
    }
    return model;
}

}  // namespace gn
