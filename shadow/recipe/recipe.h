// SPDX-License-Identifier: MIT
// A recipe names parts and their parameters: recipes/<name>.toml, with overrides from the command line.
#pragma once

#include "base/param.h"
#include "shadow/receiver/bias.h"
#include "shadow/recipe/part.h"

#include <filesystem>
#include <map>

namespace gn {

/// What maps keep of the casters: the nearest of all, of solids found by the faces that turn to the light alone (automatic);
/// front or back faces; the surface between the two nearest (midpoint, dual); object ids beside depth (ids). See
/// shadow/casters/solids.h and caster_depth.h.
enum class Casters { all, automatic, front, back, midpoint, dual, ids };
inline constexpr std::array<std::string_view, 7> caster_names{"all",      "auto", "front", "back",
                                                              "midpoint", "dual", "ids"};
constexpr std::string_view name_of(Casters casters) {
    return caster_names[static_cast<std::size_t>(casters)];
}

/// How V of a direct part and V of a map become one, sample by sample.
enum class Combine { product, minimum };
inline constexpr std::array<std::string_view, 2> combine_names{"product", "minimum"};

struct Recipe {
    std::string name;       ///< "pcf"
    std::string overrides;  ///< "resolution=2048,pcf.taps=25", as given; "" when none
    std::string title, paragraph, citation;
    const Part* light = nullptr;  ///< optional: splits a light into several
    const Part* placement =
        nullptr;                     ///< null: chosen by light kind (fit or cube); so are lights that it does not serve
    bool placement_or_auto = false;  ///< a scene without lights that it serves is no mistake: "cascades+auto"
    const Part* map = nullptr;
    const Part* lookup = nullptr;
    /// Where both are set translucent casters have a map of their own, and V is the product of both lookups' V.
    const Part* translucent_map = nullptr;
    const Part* translucent_lookup = nullptr;
    const Part* direct = nullptr;         ///< instead of a map, or beside it; without both V = 1
    std::optional<Combine> combine;       ///< set where a direct part stands beside a map, and only there
    std::vector<const Part*> visibility;  ///< in the order in which they run; may be empty
    int resolution = 1024;                ///< texels along a side of the map; per view of multi-view placements
    GnBias bias;
    Casters casters = Casters::all;
    std::map<std::string, ParamBlock, std::less<>> params;  ///< by part id, for every part there is

    /// The parameters of a part in this recipe (defaults where nothing was set).
    template <class Params>
    [[nodiscard]] Params of(std::string_view part_id) const {
        const auto found = params.find(part_id);
        GN_CHECK(found != params.end());
        return found->second.template as<Params>();
    }
    [[nodiscard]] const ParamBlock& block(const Part& part) const;
    /// The recipe of its translucent casters' map.
    [[nodiscard]] Recipe of_translucent() const;
    /// The parts that it names, in the flow's order. A placement left to the lights is none of them.
    [[nodiscard]] std::vector<const Part*> parts() const;
    /// The placement for a light: as named where that serves such lights, else the one that stands in for their kind.
    [[nodiscard]] const Part& placement_for(const GnLight& shape) const;
    /// As it is written in recipes: "auto", "cascades", "cascades+auto".
    [[nodiscard]] std::string placement_name() const;
};

/// Valid values of `resolution`.
inline constexpr int min_resolution = 16, max_resolution = 16384;

extern const ParamTable bias_params;  ///< rows of GnBias

/// Reads "pcf,resolution=2048,pcf.taps=25": a name in recipes/ or a path to a .toml, then overrides.
/// Names are looked up in recipes/ of the folder `data`, or where that is empty of the program's own (base/paths.h).
/// Throws Error naming the file or "-r", the key, and what would be valid.
Recipe load_recipe(const std::string& name_and_overrides, const std::filesystem::path& data = {});
/// The file that a name or path means, found the same way.
std::filesystem::path recipe_file(const std::string& name, const std::filesystem::path& data = {});
/// Names of the recipes in such a folder, sorted.
std::vector<std::string> recipe_names(const std::filesystem::path& data = {});
/// Throws Refusal when the recipe cannot serve the light, lacks a device feature, names a placement for none of the scene's
/// lights, or its stages do not fit.
void check_recipe(const Recipe& recipe, const Scene& scene, const Light& light, const Device& device);

}  // namespace gn
