// SPDX-License-Identifier: MIT
#include "shadow/scene/files/assimp_lights.h"

#include "base/error.h"
#include "shadow/scene/files/files.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace gn {
namespace {

dvec3 vector(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

// From the root down to the node of a name; nothing where none has it.
std::optional<dmat4> ws_from_node(const aiScene& data, const aiString& name) {
    const aiNode* node = data.mRootNode->FindNode(name);
    if (node == nullptr) {
        return std::nullopt;
    }
    dmat4 ws_from_here(1.0);
    for (; node != nullptr; node = node->mParent) {
        ws_from_here = matrix_from_assimp(node->mTransformation) * ws_from_here;
    }
    return ws_from_here;
}

dvec3 turned(const dmat4& ws_from_node, dvec3 axis, dvec3 otherwise) {
    const dvec3 axis_ws = glm::dmat3(ws_from_node) * axis;
    const double length = glm::length(axis_ws);
    return std::isfinite(length) && length > 0.0 ? axis_ws / length : otherwise;
}

std::optional<std::uint32_t> kind_of(const aiLight& data) {
    switch (data.mType) {
        case aiLightSource_DIRECTIONAL: return GN_LIGHT_DIRECTIONAL;
        case aiLightSource_POINT: return GN_LIGHT_POINT;
        case aiLightSource_SPOT: return GN_LIGHT_SPOT;
        case aiLightSource_AREA:
            return data.mSize.x > 0.0F && data.mSize.y > 0.0F ? std::optional<std::uint32_t>(GN_LIGHT_RECTANGLE)
                                                              : std::nullopt;
        default: return std::nullopt;
    }
}

void set_cone(const aiLight& data, GnLight& shape) {
    // Whole angles; without an outer one the rim is sharp.
    const float inner = 0.5F * data.mAngleInnerCone;
    const float outer = std::max(0.5F * data.mAngleOuterCone, inner);
    shape.cos_inner = std::cos(inner);
    shape.cos_outer = std::cos(outer);
}

// I / (k0 + k1 d + k2 d^2) falls off as a light of I / k2 candela does where only k2 is there.
float intensity_of(const aiLight& data, float brightest, std::vector<std::string>& notes, const std::string& name) {
    const bool positional = data.mType == aiLightSource_POINT || data.mType == aiLightSource_SPOT;
    if (!positional) {
        return brightest;
    }
    const float k2 = data.mAttenuationQuadratic;
    const bool square = k2 > 0.0F && data.mAttenuationConstant == 0.0F && data.mAttenuationLinear == 0.0F;
    if (!square) {
        add_note(
            notes,
            fmt::format("Light '{}' falls off by another law in its file than by the square of the distance.", name));
    }
    return k2 > 0.0F ? brightest / k2 : brightest;
}

}  // namespace

dmat4 matrix_from_assimp(const aiMatrix4x4& m) {
    return glm::transpose(
        dmat4(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4));
}

void place_assimp_lights(const aiScene& data, Model& model) {
    for (unsigned i = 0; i < data.mNumLights; ++i) {
        const aiLight& from = *data.mLights[i];
        const std::string name = clean_text(from.mName.C_Str());
        const std::optional<std::uint32_t> kind = kind_of(from);
        const std::optional<dmat4> ws_from_here = ws_from_node(data, from.mName);
        if (!kind || !ws_from_here) {
            add_note(model.notes,
                     fmt::format("Light '{}' is left out: {}.", name,
                                 kind ? "no node carries it" : "it is neither a sun, a spot, a point nor a rectangle"));
            continue;
        }
        PlacedLight placed;
        placed.light.name = name;
        GnLight& shape = placed.light.shape;
        shape.kind = *kind;
        placed.position_ws = dvec3(*ws_from_here * dvec4(vector(from.mPosition), 1.0));
        shape.direction_ws = vec4(turned(*ws_from_here, vector(from.mDirection), dvec3(0, -1, 0)), 0.0F);
        shape.up_ws = vec4(turned(*ws_from_here, vector(from.mUp), dvec3(0, 0, 1)), 0.0F);
        shape.half_size = 0.5F * vec2(from.mSize.x, from.mSize.y);
        if (shape.kind == GN_LIGHT_SPOT) {
            set_cone(from, shape);
        }

        // Intensities stand in the colours.
        const aiColor3D& color = from.mColorDiffuse;
        const float brightest = std::max({color.r, color.g, color.b, 0.0F});
        shape.color =
            brightest > 0.0F ? vec4(color.r / brightest, color.g / brightest, color.b / brightest, 1.0F) : vec4(1.0F);
        shape.intensity = intensity_of(from, brightest, model.notes, name);
        const bool candela = shape.kind == GN_LIGHT_POINT || shape.kind == GN_LIGHT_SPOT;
        add_note(model.notes, fmt::format("Light '{}' has no unit in such a file: its intensity counts as {:.4g} {}.",
                                          name, shape.intensity,
                                          candela                              ? "cd"
                                          : shape.kind == GN_LIGHT_DIRECTIONAL ? "lux"
                                                                               : "cd/m^2"));
        model.lights.push_back(std::move(placed));
    }
}

void place_assimp_cameras(const aiScene& data, Model& model) {
    for (unsigned i = 0; i < data.mNumCameras; ++i) {
        const aiCamera& from = *data.mCameras[i];
        const std::string name = clean_text(from.mName.C_Str());
        const std::optional<dmat4> ws_from_here = ws_from_node(data, from.mName);
        if (!ws_from_here) {
            add_note(model.notes, fmt::format("Camera '{}' is left out: no node carries it.", name));
            continue;
        }
        PlacedCamera placed;
        placed.camera.name = name;
        placed.position_ws = dvec3(*ws_from_here * dvec4(vector(from.mPosition), 1.0));
        placed.camera.forward_ws = vec3(turned(*ws_from_here, vector(from.mLookAt), dvec3(0, 0, -1)));
        placed.camera.up_ws = vec3(turned(*ws_from_here, vector(from.mUp), dvec3(0, 1, 0)));
        // The whole horizontal angle, or half the width of a box; where no aspect is given, of a picture of 16 by 9.
        const float aspect = from.mAspect > 0.0F ? from.mAspect : 16.0F / 9.0F;
        placed.camera.yfov = 2.0F * std::atan(std::tan(0.5F * from.mHorizontalFOV) / aspect);
        placed.camera.half_height = std::max(from.mOrthographicWidth, 0.0F) / aspect;
        // What Assimp fills in where a file says nothing is left to the scene.
        const bool given =
            from.mClipPlaneNear != aiCamera{}.mClipPlaneNear || from.mClipPlaneFar != aiCamera{}.mClipPlaneFar;
        placed.camera.near = given ? from.mClipPlaneNear : 0.0F;
        placed.camera.far = given ? from.mClipPlaneFar : 0.0F;
        model.cameras.push_back(std::move(placed));
    }
}

}  // namespace gn
