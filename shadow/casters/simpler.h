// SPDX-License-Identifier: MIT
// Casters of few triangles for views whose texels hide what is missing.
//
// Based on: Akenine-Möller, Haines, Hoffman et al. Real-Time Rendering, Fourth Edition. 2018. [AHH18] section 7.4.1
#pragma once

#include "gpu/memory.h"
#include "shadow/geometry/draw.h"
#include "shadow/scene/simplifier.h"

#include <memory>
#include <span>
#include <vector>

namespace gn {

/// What an object was simplified from.
struct SimplerSource {
    bool asked = false;  ///< whether it is an object that is simplified where that saves anything
    OwnMesh mesh;
    std::uint64_t version = 0;  ///< Object::version
    dmat4 now_from_first{1};    ///< Object::now_from_first
};

/// Simpler meshes of the opaque casters, each of its object's own vertices.
struct SimplerCasters {
    Buffer indices;             ///< uvec3 a triangle
    std::vector<float> errors;  ///< metres, one a level
    /// Of each level a range an object; empty where edge collapses within the error leave out less than an eighth of its triangles.
    std::vector<std::vector<DrawRange>> ranges;
    std::size_t objects = 0;                                ///< that have a simpler mesh on the last level
    std::size_t triangles_before = 0, triangles_after = 0;  ///< of these
    std::vector<SimplerSource> sources;                     ///< an object each
    std::vector<std::uint32_t> list;                        ///< what `indices` holds
    std::weak_ptr<const Kept> geometry;                     ///< SceneHandles::derived
    /// Of an error's level, an object's range; null where it is drawn as it is.
    [[nodiscard]] const DrawRange* find(float error, std::uint32_t object) const;
};

/// How far from the scene's surfaces simpler ones may lie, a level each; ascending. Kept with the geometry, and over a history's frames
/// while objects rest or move rigidly; what bends, stretches or begins to cast is simplified anew. Null where nothing is asked.
std::shared_ptr<const SimplerCasters> simpler_casters(const FrameInput& input, std::span<const float> errors);

/// The same view of what lies nearer to an affine view's light by so many metres.
GnLightView set_back(GnLightView view, float metres);

}  // namespace gn
