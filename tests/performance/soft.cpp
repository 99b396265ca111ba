// SPDX-License-Identifier: MIT
// Soft lookups over bare fetches of as many texels, over filters of as many taps, and over themselves with an idea left out.
#include "shadow/lookup/pcss/pcss.h"
#include "tests/performance/bench.h"

namespace gn::performance {
namespace {

/// A search and a filter that only fetch, with the parameters of pcss, as a part that no registry knows.
Part fetching_pcss() {
    const Part& pcss = find_part(Stage::lookup, "pcss");
    Part part;
    part.id = "fetch-pcss";
    part.stage = Stage::lookup;
    part.needs = {"depth", "min-max"};
    part.glsl = "tests/performance/fetch_pcss.glsl";
    part.params_type = pcss.params_type;
    part.guard = pcss.guard;
    return part;
}

}  // namespace

void soft(Bench& bench) {
    const auto lookup = [&](const std::string& scene, const Recipe& recipe) {
        return passes(bench, scene, recipe, {"lookup"});
    };
    const Part fetches = fetching_pcss();
    const std::string taps = "pcss,pcss.search_taps=16,pcss.taps=25,pcss.density=64,pcss.early_out=";
    for (const char* scene : {"courtyard", "contact:radius=3"}) {
        print_title(fmt::format("{}: pcss of 16 + 25 taps", scene).c_str());
        for (const char* early_out : {"false,pcss.planes=false", "true,pcss.planes=false", "true,pcss.planes=true"}) {
            const Recipe recipe = load_recipe(taps + early_out);
            Recipe bare = recipe;
            bare.params.insert_or_assign(std::string(fetches.id), recipe.block(*recipe.lookup));
            bare.lookup = &fetches;
            if (recipe.of<GnPcssParams>("pcss").planes == 0) {  // the bare lookup fetches from two maps
                print_ratio(fmt::format("over its fetches, early_out={}", early_out), lookup(scene, recipe),
                            lookup(scene, bare));
            }
            print_ratio(fmt::format("over pcf of 41 taps, early_out={}", early_out), lookup(scene, recipe),
                        lookup(scene, load_recipe("pcf,pcf.kernel=vogel,pcf.taps=41,pcf.radius=8")));
        }
    }
    print_title("outlines of 2 x 2 receivers together over each receiver by itself");
    const std::string alone = "backprojection,backprojection.occluder=contour";
    for (const char* scene : {"slab", "contact:radius=3"}) {
        print_ratio(scene, lookup(scene, load_recipe(alone + ",backprojection.packet=2")),
                    lookup(scene, load_recipe(alone)));
    }
}

}  // namespace gn::performance
