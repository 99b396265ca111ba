// SPDX-License-Identifier: MIT
#include "shadow/placement/adaptive/tree_passes.h"

#include "gpu/zeros_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

namespace gn::adaptive {
namespace {

/// The tree's buffers, and what of them all passes share.
struct Tree {
    const FrameInput& input;
    const GnTreeConstants& constants;
    BufferHandle own, weights, in_block;
    BufferHandle deepest;  ///< with a grid: the finest level that is asked for in a node
    BufferHandle places;   ///< of kept tiles: as tree_places.glsl divides it
    TreeTiles made;
    const KeptTiles* kept = nullptr;
};

struct Pass {
    const char* name;
    const char* file;  ///< its shader, tree_<file>.glsl
    uvec2 groups{1};
    ShaderInputs inputs;
    bool reads_samples = false;
    std::string defines = "";
};

void add_pass(const Tree& tree, Pass pass) {
    ShaderInputs& inputs = pass.inputs;
    inputs.block("uniform", "Tree", "GnTreeConstants t;", std::as_bytes(std::span(&tree.constants, 1)));
    inputs.buffer("buffer", "Counts", "GnTreeCounts c;", tree.made.counts);
    const auto shader = compute_once(tree.input.prepared, pass.name, hashed(inputs).text(pass.defines), [&] {
        return pass.defines + include_line("shadow/placement/adaptive/adaptive.glsl") +
               include_line("shadow/casters/tiles.glsl") + include_line("shadow/placement/adaptive/tree.h") +
               include_line(pass.reads_samples ? "shadow/view/view.glsl" : "") + inputs.text() +
               include_line(fmt::format("shadow/placement/adaptive/tree_{}.glsl", pass.file));
    });
    tree.input.graph.add_pass(
        pass.name, [&](PassBuilder& builder) { pass.inputs.declare(builder); },
        [inputs, groups = pass.groups, shader](Recorder& r) {
            r.bind(*shader);
            inputs.set(r);
            r.dispatch(groups.x, groups.y);
        });
}

std::uint32_t groups_of(int count, int local) {
    return static_cast<std::uint32_t>((count + local - 1) / local);
}

/// What samples ask for.
void add_requests(const Tree& tree, BufferHandle changed) {
    ShaderInputs inputs;
    add_gbuffer(inputs, tree.input.device, tree.input.samples);
    inputs.buffer("buffer", "Own", "uint own[];", tree.own);
    if (changed.valid()) {
        inputs.buffer("readonly buffer", "Changed", "uint changed[];", changed);
    }
    inputs.constant("GnViewConstants", "view", tree.input.samples.constants);
    const uvec2 size = tree.constants.size;
    add_pass(tree,
             {"adaptive requests", "requests", uvec2((size.x + 63) / 64, (size.y + GN_TREE_ROWS - 1) / GN_TREE_ROWS),
              inputs, true, changed.valid() ? "#define GN_TREE_REFINED\n" : ""});
}

/// What all demands in a node weigh, from the finest level up.
void add_weights(const Tree& tree) {
    for (int level = tree.constants.data.levels; level >= 0; --level) {
        ShaderInputs inputs;
        inputs.buffer("readonly buffer", "Own", "uint own[];", tree.own)
            .buffer("buffer", "Weights", "float weight[];", tree.weights)
            .constant("int", "level", level);
        if (tree.deepest.valid()) {
            inputs.buffer("buffer", "Deepest", "int deepest[];", tree.deepest);
        }
        const int nodes = tree.constants.count << (2 * level);
        add_pass(tree, {"adaptive weights", "weights", uvec2(groups_of(nodes, 256), 1), inputs, false,
                        tree.deepest.valid() ? "#define GN_TREE_GRID\n" : ""});
    }
}

/// One resolution for each tile of a grid.
void add_grid(const Tree& tree) {
    ShaderInputs inputs;
    inputs.buffer("buffer", "Weights", "float weight[];", tree.weights)
        .buffer("readonly buffer", "Deepest", "int deepest[];", tree.deepest);
    add_pass(tree, {"adaptive grid", "grid", uvec2(groups_of(tree.constants.nodes, 256), 1), inputs});
}

ShaderInputs node_inputs(const Tree& tree) {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Own", "uint own[];", tree.own)
        .buffer("readonly buffer", "Weights", "float weight[];", tree.weights);
    return inputs;
}

/// Which nodes get tiles, so that they fit the budget.
void add_cut(const Tree& tree) {
    add_pass(tree, {"adaptive cut", "cut", uvec2(groups_of(tree.constants.nodes, 256), 1), node_inputs(tree)});
    add_pass(tree, {"adaptive rank", "rank", uvec2(1), {}});
}

constexpr const char* places_text = "uint places[];";
constexpr const char* pages_text = "uint pages[];";

/// Which squares of the atlas hold what is asked for, and which are given away.
void add_hold(const Tree& tree) {
    const KeptTiles& kept = *tree.kept;
    std::vector<vec4> boxes = kept.boxes_ws;
    boxes.resize(std::max<std::size_t>(boxes.size(), 2));
    ShaderInputs hold = node_inputs(tree);
    hold.block("readonly buffer", "Boxes", "vec4 boxes[];", std::as_bytes(std::span(boxes)))
        .buffer("buffer", "Places", places_text, tree.places)
        .buffer("buffer", "Pages", pages_text, tree.made.pages);
    if (kept.before.valid()) {
        hold.texture("usampler2D", "before", kept.before);
    }
    hold.constant("int", "boxes", static_cast<int>(kept.boxes_ws.size() / 2))
        .constant("int", "fresh", kept.fresh ? 1 : 0)
        .constant("int", "redrawn", kept.redrawn ? 1 : 0);
    const char* const defines =
        kept.before.valid()
            ? "#define GN_BEFORE(i) texelFetch(before, ivec2((i) % GN_TREE_ROW, (i) / GN_TREE_ROW), 0).r\n"
            : "#define GN_BEFORE(i) 0u\n";
    add_pass(tree, {"adaptive hold", "hold", uvec2(groups_of(tree.constants.tiles, 64), 1), hold, false, defines});
    ShaderInputs order;
    order.buffer("buffer", "Places", places_text, tree.places);
    if (kept.before.valid()) {
        order.texture("usampler2D", "before", kept.before);
    }
    order.constant("int", "fresh", kept.fresh ? 1 : 0);
    add_pass(tree, {"adaptive order", "order", uvec2(1), order, false, defines});
}

/// The views of all squares, and what the next frame finds.
void add_description(const Tree& tree) {
    ShaderInputs inputs;
    inputs.buffer("readonly buffer", "Places", places_text, tree.places)
        .buffer("writeonly buffer", "Views", "GnLightView views[];", tree.made.views)
        .buffer("writeonly buffer", "Drawn", "GnLightView drawn[];", tree.made.drawn)
        .image("r32ui", "writeonly", "uimage2D", "now", tree.kept->now);
    add_pass(tree, {"adaptive views", "describe", uvec2(groups_of(tree.constants.tiles, 64), 1), inputs});
}

/// Tiles one after the other, in the order of their nodes.
void add_tiles(const Tree& tree) {
    const bool keeps = tree.kept != nullptr;
    const char* const defines = keeps ? "#define GN_TREE_KEPT\n" : "";
    const uvec2 blocks(groups_of(tree.constants.blocks, 64), 1);
    ShaderInputs counts = node_inputs(tree);
    counts.buffer("writeonly buffer", "InBlock", "uint in_block[];", tree.in_block);
    if (keeps) {
        counts.buffer("readonly buffer", "Pages", pages_text, tree.made.pages);
    }
    add_pass(tree, {"adaptive counts", "counts", blocks, counts, false, defines});
    ShaderInputs sums;
    sums.buffer("buffer", "InBlock", "uint in_block[];", tree.in_block)
        .buffer("writeonly buffer", "Count", "uint count;", tree.made.count);
    add_pass(tree, {"adaptive sums", "sums", uvec2(1), sums});
    ShaderInputs tiles = node_inputs(tree);
    tiles.buffer("readonly buffer", "InBlock", "uint in_block[];", tree.in_block)
        .buffer(keeps ? "buffer" : "writeonly buffer", "Pages", pages_text, tree.made.pages);
    if (keeps) {
        tiles.buffer("buffer", "Places", places_text, tree.places);
    } else {
        tiles.buffer("writeonly buffer", "Views", "GnLightView views[];", tree.made.views);
    }
    add_pass(tree, {"adaptive tiles", "tiles", blocks, tiles, false, defines});
}

}  // namespace

TreeTiles add_tree(const FrameInput& input, const GnTreeConstants& constants, BufferHandle changed,
                   const KeptTiles* kept) {
    FrameGraph& graph = input.graph;
    const auto words = [&](const char* name, int count) {
        return graph.create({.name = name, .bytes = static_cast<VkDeviceSize>(count) * 4});
    };
    const auto views = [&](const char* name) {
        return graph.create({.name = name, .bytes = static_cast<VkDeviceSize>(constants.tiles) * sizeof(GnLightView)});
    };
    const Tree tree{.input = input,
                    .constants = constants,
                    .own = words("adaptive requests", constants.nodes),
                    .weights = words("adaptive weights", constants.nodes),
                    .in_block = words("adaptive blocks", constants.blocks),
                    .deepest = constants.grid >= 0 ? words("adaptive levels", constants.nodes) : BufferHandle{},
                    .places = kept != nullptr ? words("adaptive places", 4 * constants.tiles) : BufferHandle{},
                    .made = {.views = views("adaptive views"),
                             .count = words("adaptive count", 1),
                             .drawn = kept != nullptr ? views("adaptive drawn") : BufferHandle{},
                             .pages = words("adaptive pages", constants.nodes),
                             .counts = graph.create({.name = "adaptive counts", .bytes = sizeof(GnTreeCounts)})},
                    .kept = kept};
    std::vector<BufferHandle> cleared{tree.own, tree.made.counts};
    if (kept != nullptr) {
        cleared.push_back(tree.made.pages);
    }
    add_zeros(graph, "adaptive clear", cleared);
    add_requests(tree, changed);
    add_weights(tree);
    if (tree.deepest.valid()) {
        add_grid(tree);
    }
    add_cut(tree);
    if (kept != nullptr) {
        add_hold(tree);
    }
    add_tiles(tree);
    if (kept != nullptr) {
        add_description(tree);
    }
    return tree.made;
}

}  // namespace gn::adaptive
