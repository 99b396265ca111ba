// SPDX-License-Identifier: MIT
// The masked casters of a scene as a tree of boxes that shaders follow rays through, with the texels that cut them out: what
// decides for them where a technique knows surfaces and no alpha.
#pragma once

#include "gpu/shader_inputs.h"
#include "shadow/stages.h"

#include <memory>
#include <optional>

namespace gn {

/// A box and what is in it. A node's first half follows it, so that a ray needs no memory: where it misses the box, and after a
/// leaf, it goes on behind all that the box holds.
struct TreeNode {
    vec3 low_ws{0};            ///< grown by what rounding moves a ray
    std::uint32_t behind = 0;  ///< the node behind all that it holds; the number of nodes at the end
    vec3 high_ws{0};
    std::uint32_t held = 0;  ///< of leaves: the first of its triangles times 8, plus their number; else 0
};
struct TriangleTree {
    std::vector<TreeNode> nodes;           ///< the root first; empty where there is no triangle
    std::vector<std::uint32_t> triangles;  ///< in the order of the leaves
};
/// Halves the triangles by their middles along the widest axis until four are left. Less deep than 32 for any scene that fits
/// 32-bit indices.
TriangleTree build_tree(std::span<const vec3> positions_ws, std::span<const uvec3> all,
                        std::vector<std::uint32_t> triangles);

/// The masked casters of the input's light, made once a geometry; nothing where there is none.
class MaskedTree {
  public:
    static std::optional<MaskedTree> of(const FrameInput& input);
    /// Adds what the shader reads; positions, indices and uvs too.
    void add_to(ShaderInputs& inputs, const FrameInput& input) const;
    /// GLSL, before the inputs' declarations: their types.
    static std::string types(const Device& device);
    /// GLSL, after them: `bool masked_hides(vec3 p_ws, vec3 n_ws, vec4 light_ws)`, whether any masked triangle hides the sample
    /// from the light (w = 1: a point, w = 0: the direction towards it), by the texel that the ray meets.
    static std::string functions();

  private:
    struct Buffers;
    std::shared_ptr<const Buffers> buffers_;
};

}  // namespace gn
