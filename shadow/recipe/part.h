// SPDX-License-Identifier: MIT
// A part: an idea that belongs to one stage, one folder. The folder's .cpp defines one function
//
//     const gn::Part& gn::parts::lookup_pcf();   // <stage>_<id>, with '-' of the id written as '_'
//
// and the build finds it; there is no list to add it to.
#pragma once

#include "base/param.h"
#include "shadow/stages.h"

namespace gn {

struct Recipe;

/// Which lights a part serves.
struct LightKinds {
    bool directional = false, spot = false, point = false, rectangle = false, environment = false;
    [[nodiscard]] bool has(uint kind) const;
    [[nodiscard]] std::string names() const;
};
/// All that have a place or a direction.
inline constexpr LightKinds all_lights{true, true, true, true};

// The GLSL functions that the shared resolve pass calls, by stage; <id> with '-' as '_', the params argument only where
// params_type is set:
//
//   light       float gn_<id>_weight(GnLight light, GnLight one, vec3 p_ws, ivec2 pixel, int index, int count, Params):
//               what V of light `index` of `count`, `one`, weighs at a receiver; at least 0
//   placement   GnChoice gn_<id>_choose(GnReceiver, <data_type>, sampler2DArray for each of LightViews::offers); it declares
//               `TYPE gn_<id>_<name>(int i);` of each of LightViews::tables, which the pass defines
//   lookup      float (vec3 where `channels` is 3) gn_<id>_visibility(GnLookup, sampler2DArray for each texture of `needs` and `optional`, Params)
//               float gn_<id>_<side>(the same) for each of `sides`
//   map         float gn_<id>_visibility(GnLookup, sampler2DArray for each of `textures`, vec2 ddx_ts, vec2 ddy_ts,
//               Params), for maps that are `filterable`; lookups that filter call it as
//               GN_MAP_VISIBILITY(GnLookup, ddx_ts, ddy_ts)
//               vec2 gn_<id>_blockers(the same), for maps that are filterable and give "min-max": the share of the footprint that
//               hides the light from the receiver, and its mean depth; called as GN_MAP_BLOCKERS

/// The reach of a kernel: the larger of texels and metres, and besides half of `pixels` sides of the pixel's footprint on the
/// map. Views are not widened by pixels: no receiver lies beyond the picture, and lookups leave out what lies beyond a view.
struct Guard {
    float texels = 0, metres = 0, pixels = 0;
    /// Metres before the receivers, towards the light, within which the map says how far away casters are. Nearer to the light
    /// they are clamped to a view's near plane: they cast, but nobody knows from where.
    float before = 0;
};

/// Pixels of the view: every `step`-th in both directions, from `first` on.
struct PixelLattice {
    ivec2 first{0};
    int step = 1;
    bool operator==(const PixelLattice&) const = default;
};

/// A number beside V that a lookup can tell of every view sample.
struct Side {
    std::string_view name, unit, sentence;  ///< "blocker-distance", "m", "How far ..."
};

class Part {
  public:
    std::string_view id;  ///< as users type it: "pcf", "sat-vsm"; the folder is the same with '_' for '-'
    Stage stage = Stage::lookup;
    std::string_view title;     ///< "Percentage-closer filtering"
    std::string_view citation;  ///< key in docs/references.bib
    /// lookup: what the map must give, or what is derived of that; visibility: the sides that it reads.
    std::vector<std::string_view> needs;
    std::vector<Side> sides;  ///< lookup: what it can tell beside V; costs nothing where nobody asks
    /// lookup: what it reads besides where the map gives it in this recipe ("ids"); else another texture is passed, which its
    /// GLSL must not read.
    std::vector<std::string_view> optional;
    /// lookup: what its GLSL takes with a recipe's parameters, always as many; null: `needs`.
    std::vector<std::string_view> (*needs_for)(const Recipe&) = nullptr;
    bool filters = false;  ///< lookup: asks the map's own GLSL for a footprint, which must be filterable
    /// lookup: asks what a region of the map holds through the view that shows all (GN_WHOLE_CHOICE), so that the map may be one of
    /// pages.
    bool searches_pages = false;
    /// map: what it gives: names of textures.
    std::vector<std::string_view> gives;
    bool filterable = false;  ///< map: its own GLSL answers for a footprint
    /// map: which of them its own GLSL reads, in order. One that a recipe leaves out is replaced as `optional` ones are.
    std::vector<std::string_view> textures;
    LightKinds stands_in_for{};  ///< placement: lights that get it where none that serves them is named
    /// placement: GLSL and C++ name of the struct that its choice function is given (LightViews::data); this one holds nothing.
    std::string_view data_type = "GnPlacementData";
    bool from_centre = false;                  ///< placement: sees a spot's cone from the middle of the spot alone
    bool bends = false;                        ///< placement: straight edges are not straight on its maps
    std::vector<std::string_view> view_names;  ///< placement: what its views are called, in order; empty: by number
    bool separates_casters = false;            ///< map: serves casters = midpoint, dual, ids
    bool solid_only = false;                   ///< map: cannot hold translucent casters
    uint channels = 1;                         ///< lookup: of the V that it gives, 1 or 3
    std::vector<std::string_view> reads;       ///< direct: keys of maps that it reads too ("placement", "resolution")
    LightKinds lights = all_lights;
    std::vector<Feature> features;  ///< without which the part is refused
    /// Further features that its parameters ask for; may be null.
    std::vector<Feature> (*features_for)(const Recipe&) = nullptr;
    /// It reads triangles on the CPU, or the view's depth and materials: a renderer that lends its buffers brings neither.
    bool needs_scene = false;
    ParamTable params;
    std::string_view params_type;  ///< GLSL and C++ name of the struct: "GnPcfParams"; "" when there are none
    std::string_view glsl;         ///< include path: "shadow/lookup/pcf/pcf.glsl"; "" when there is none

    // Exactly one of these is set, by stage.
    /// What serves a light in the stages behind: points or pieces of it, whose V are summed by weight. At least one.
    std::vector<Light> (*split)(const Light&, const Recipe&) = nullptr;
    /// The same where what serves a light depends on what earlier frames saw: V, by add_weighted, of the lights that it chooses.
    Visibility (*add_light)(const FrameInput&, const Recipe&,
                            const std::function<Visibility(const FrameInput&)>& serve) = nullptr;
    /// The pixels whose V light `index` of `count` is for, with weight 0 elsewhere; null: all. Lights of the same pixels follow
    /// each other.
    PixelLattice (*pixels)(int index, int count, const Recipe&) = nullptr;
    LightViews (*place)(const FrameInput&, const Recipe&) = nullptr;
    ShadowMap (*add_map)(const FrameInput&, const Recipe&, const LightViews&) = nullptr;
    /// Lookups normally leave this null: the shared resolve pass calls their GLSL function for every sample.
    Visibility (*add_lookup)(const FrameInput&, const Recipe&, const LightViews&, const ShadowMap&) = nullptr;
    Visibility (*add_direct)(const FrameInput&, const Recipe&) = nullptr;
    Visibility (*add_visibility)(const FrameInput&, const Recipe&, const Visibility&) = nullptr;
    /// Lookups and maps: how far beyond a receiver their kernel reads under the light, in a scene of these bounds; placements
    /// widen their views by it.
    Guard (*guard)(const Recipe&, const Light&, const Box& bounds_ws) = nullptr;
    /// Lookups and maps: GLSL that must stand before the part's own (generated tables); "" when there is none.
    std::string (*prologue)(const Recipe&) = nullptr;
    /// A combination it cannot do: the sentence why, or "". Asked before anything is drawn.
    std::string (*refuses)(const Scene&, const Light&, const Recipe&) = nullptr;
    /// What the picture will show of a limit that does not refuse it: one sentence, or "".
    std::string (*remark)(const Scene&, const Recipe&) = nullptr;
    /// Tap counts and the like that become specialization constants of the resolve pass.
    SpecConstants (*constants)(const Recipe&) = nullptr;
};

/// Whether a lookup can tell this of a sample; the ids of those that can, "hard, pcf", or "none".
bool tells(const Part& lookup, std::string_view side);
std::string lookups_that_tell(std::string_view side);
/// What a lookup reads of a map, and what a map gives, as words: "filterable", and the names of textures.
std::vector<std::string_view> words_read(const Part& lookup);
/// What the recipe's lookup needs of its map with the recipe's parameters, as its GLSL takes it.
std::vector<std::string_view> needs_of(const Recipe& recipe);
std::vector<std::string_view> words_given(const Part& map);
/// Whether a map gives what a lookup names, itself or made of what it gives (shadow/map/derivations.cpp).
bool map_gives(const Part& map, std::string_view need);
/// Whether a list of names holds one.
bool holds(std::span<const std::string_view> names, std::string_view name);

/// Every part, generated from the folders; sorted by stage and id.
std::span<const Part* const> all_parts();
/// Throws Error listing the known ids of the stage.
const Part& find_part(Stage stage, std::string_view id);
/// "map_moments" for GLSL and C++ names: '-' becomes '_'.
std::string identifier(std::string_view id);

}  // namespace gn
