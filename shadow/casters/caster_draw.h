// SPDX-License-Identifier: MIT
// Drawing the casters of one view (or of all views at once) inside a pass, and the passes of maps that are kept.
#pragma once

#include "shadow/casters/raster.h"
#include "shadow/casters/simpler.h"
#include "shadow/casters/solids.h"
#include "shadow/casters/tiles.h"

namespace gn {

/// Faces that one draw takes.
struct CasterFaces {
    VkCullModeFlags culled = VK_CULL_MODE_NONE;
    bool pushed = false;  ///< a little away from the light: they lose ties
    bool depth_only = false;
};

/// What the passes of all views share.
struct CasterJob {
    CasterPass pass;
    Casters kept = Casters::all;
    LightViews views;  ///< what the shaders see; `layered` draws all of them
    SceneHandles handles;
    const Scene* scene = nullptr;
    const Light* light = nullptr;  ///< whose shadow it is: not everything casts for every light
    const PreparedRecipe* prepared = nullptr;
    ShaderInputs inputs;               ///< all that the pass's shaders read
    TileLists tile_lists;              ///< with tiles
    std::vector<TextureHandle> masks;  ///< base colour textures of alpha-tested materials
    std::uint64_t shader_key = 0;      ///< what the pass adds to the casters' shaders
    bool translucent = false;          ///< the translucent casters alone, whole, instead of the others
    std::uint64_t light_id = 0;
    std::shared_ptr<const Solids> solids;  ///< with casters = auto; null: all faces are drawn
    /// Where views ask for simpler casters; behind the views then stand as many that see them farther away.
    std::shared_ptr<const SimplerCasters> simpler;
    BufferHandle simpler_indices;
};
std::shared_ptr<const CasterJob> caster_job(const FrameInput& input, const Recipe& recipe, LightViews views,
                                            const CasterPass& pass);

struct CasterDraw {
    std::shared_ptr<const CasterJob> job;
    std::size_t view = 0;  ///< index of the view; with tiles the layer

    /// What a pass must declare besides its attachments.
    void declare(PassBuilder& builder) const;
    /// Opaque casters, then alpha-tested ones; viewport and scissor are the caller's.
    void record(Recorder& r) const;

  private:
    /// What is drawn: the view's objects that cast.
    [[nodiscard]] std::vector<std::uint32_t> objects() const;
    [[nodiscard]] std::uint32_t instances() const {
        return job->views.layered ? static_cast<std::uint32_t>(job->views.views.size()) : 1;
    }
    void begin(Recorder& r, const CasterFaces& faces, bool masked) const;
    void draw(Recorder& r, const CasterFaces& faces, std::span<const std::uint32_t> objects) const;
    void opaque(Recorder& r, const CasterFaces& faces, std::span<const std::uint32_t> objects) const;
    /// Draws those that the view has simpler meshes of; the others are left.
    [[nodiscard]] std::vector<std::uint32_t> draw_simpler(Recorder& r, std::vector<std::uint32_t> objects) const;
    void both_sided(Recorder& r, std::span<const std::uint32_t> objects) const;
    void ranges(Recorder& r, const CasterFaces& faces, std::span<const DrawRange> ranges) const;
    void opaque_one_by_one(Recorder& r, const CasterFaces& faces, std::span<const std::uint32_t> objects) const;
    void masked(Recorder& r, const CasterFaces& faces, std::span<const std::uint32_t> objects) const;
    /// With tiles: which draw of the lists an object's is in this layer.
    [[nodiscard]] int tile_draw(std::uint32_t object) const;
    void draw_object(Recorder& r, std::uint32_t index) const;
    void drawn(Recorder& r) const;
};

/// Where a renderer draws the casters itself: notes what its pipelines must match, or refuses by name what they cannot fill.
void ask_drawn(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass);
/// Then draws views one by one, depth alone, and makes of it what else the map stores.
void add_drawn_passes(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass);

/// One pass that draws into the views: of one view, of all where they are layered, or of one layer's tiles.
struct ViewPass {
    std::size_t index = 0;  ///< of the view; with tiles the layer
    std::uint32_t layer = 0;
    bool first_of_layer = true;
};
std::vector<ViewPass> view_passes(const LightViews& views);

/// Viewport and scissor of a view's rectangle in its layer.
void set_viewport(Recorder& r, const GnLightView& view);

/// Whether a pass can keep its map over frames: the placement asks, and the attachments have one sample and one mip.
bool can_keep(const FrameInput& input, const LightViews& views, const CasterPass& pass);
/// Draws what the kept textures lack, then unwraps them into the pass's attachments.
void add_kept_passes(const FrameInput& input, const Recipe& recipe, const LightViews& views, const CasterPass& pass);

}  // namespace gn
