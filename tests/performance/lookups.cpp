// SPDX-License-Identifier: MIT
// Lookups over bare fetches of the texels that they compare with.
#include "tests/performance/bench.h"

namespace gn::performance {
namespace {

/// A lookup that only fetches, as a part that no registry knows. It takes pcf's parameters where it stands for pcf.
Part fetching(std::string_view id, const Part* pcf = nullptr) {
    Part part;
    part.id = id;
    part.stage = Stage::lookup;
    part.needs = {"depth"};
    part.glsl = "tests/performance/fetch.glsl";
    if (pcf != nullptr) {
        part.params_type = pcf->params_type;
        part.guard = pcf->guard;
        part.prologue = pcf->prologue;
    }
    return part;
}

Recipe with_lookup(Recipe recipe, const Part& lookup) {
    if (!lookup.params_type.empty()) {
        recipe.params.insert_or_assign(std::string(lookup.id), recipe.block(*recipe.lookup));
    }
    recipe.lookup = &lookup;
    return recipe;
}

}  // namespace

void lookups(Bench& bench) {
    const auto lookup = [&](const Recipe& recipe) { return passes(bench, "courtyard", recipe, {"lookup"}); };
    print_title("lookup pass over bare fetches of the same texels");
    const Part one = fetching("fetch-one");
    const Recipe hard = load_recipe("hard");
    print_ratio("hard over one fetch", lookup(hard), lookup(with_lookup(hard, one)));

    const Part& pcf = find_part(Stage::lookup, "pcf");
    const Part gathers = fetching("fetch-gathers", &pcf);
    const Part taps = fetching("fetch-taps", &pcf);
    const auto row = [&](const std::string& kernel, const Part& fetches, const char* over) {
        const Recipe recipe = load_recipe("pcf," + kernel);
        print_ratio(fmt::format("{} over {}", kernel, over), lookup(recipe), lookup(with_lookup(recipe, fetches)));
    };
    row("pcf.kernel=2x2", gathers, "1 gather");
    row("pcf.kernel=3x3", gathers, "4 gathers");
    row("pcf.kernel=bilinear-nxn,pcf.size=5", gathers, "9 gathers");
    row("pcf.kernel=nxn,pcf.size=9", gathers, "25 gathers");
    row("pcf.kernel=gaussian,pcf.size=5", gathers, "9 gathers");
    row("pcf.kernel=poisson,pcf.taps=16", taps, "16 fetches");
    row("pcf.kernel=rotated-poisson,pcf.taps=32", taps, "32 fetches");
    row("pcf.kernel=vogel,pcf.taps=32", taps, "32 fetches");

    print_title("lookup pass over lookup pass");
    print_ratio("pcf 3x3 over hard", lookup(load_recipe("pcf,pcf.kernel=3x3")), lookup(hard));
    print_ratio("vsm over hard", lookup(load_recipe("vsm")), lookup(hard));
}

}  // namespace gn::performance
