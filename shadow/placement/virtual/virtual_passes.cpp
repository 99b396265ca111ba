// SPDX-License-Identifier: MIT
// From view samples to pages: every sample marks the page that it asks for; all levels are coarsened alike until the pool holds
// what is marked; pages that are held stay where they are; the others take the places of those unused for longest. What a place
// holds afterwards follows from the picture and from the frames before alone, never from the order in which invocations run.
#include "shadow/placement/virtual/virtual_passes.h"

#include "gpu/zeros_pass.h"
#include "shadow/placement/light_views.h"
#include "shadow/receiver/pixel_pass.h"
#include "shadow/receiver/sample_pass.h"
#include "shadow/recipe/prepared.h"

#include <algorithm>

namespace gn::virtual_pages {
namespace {

// The list of what samples ask for: of each page slot and tag, once. counts[c]: how many pages there are if all are c quarters of a
// level coarser. A slot is listed once at most, so that PageJob::most_listed entries hold all.
constexpr const char* demand_text = "uint listed; uint counts[4 * GN_VIRTUAL_MOST_LEVELS]; uvec2 entries[];";

constexpr const char* head_text = R"(
// Work: flags, victims, drawn, slots + 1 and tags of each page of the pool, the rows of slots, totals.
#define GN_FLAG(i) work[i]
#define GN_VICTIM(i) work[u.pages + i]
#define GN_DRAWN(i) work[2 * u.pages + i]
#define GN_SLOT(i) work[3 * u.pages + i]
#define GN_TAG(i) work[4 * u.pages + i]
#define GN_ROW(i) work[5 * u.pages + i]
#define GN_MOVED work[5 * u.pages + u.rows]
#define GN_NEW work[5 * u.pages + u.rows + 1]
const uint held = 1u, stale = 2u;

// An entry, so many levels coarser; whether it is asked for where all are so many quarters coarser.
bool coarsened(uvec2 entry, int coarser, out int slot, out uint tag) {
    int level = gn_virtual_level(u.data.faces, int(entry.x));
    int steps = min(level, coarser >> 2);
    ivec2 page = gn_virtual_page(entry.y) >> steps;
    slot = gn_virtual_slot(u.data.faces, level - steps, gn_virtual_face(u.data.faces, int(entry.x)), page);
    tag = gn_virtual_tag(page);
    return (masks[entry.x] & (1u << (coarser & 3))) != 0u;
}
// By how many quarters of a level all must be coarser than they are asked for.
int coarser_by() {
    int by = 0;
    while (by < 4 * u.data.levels - 1 && counts[by] > uint(u.pages)) {
        ++by;
    }
    return by;
}
// Whether casters moved within the page of a slot, or a texel beside it.
bool touched_page(int slot, uint tag) {
    float across = float(1 << gn_virtual_level(u.data.faces, slot));
    vec2 low = (vec2(gn_virtual_page(tag)) - u.beyond) / across;
    vec2 high = (vec2(gn_virtual_page(tag)) + 1.0 + u.beyond) / across;
    for (int i = 0; i < u.parts; ++i) {
        vec4 part = touched[2 * i];
        if (int(touched[2 * i + 1].x) == gn_virtual_face(u.data.faces, slot) && all(lessThanEqual(part.xy, high)) && all(greaterThanEqual(part.zw, low))) {
            return true;
        }
    }
    return false;
}
)";

// A pixel marks the pages around its sample; the first one those of level 0.
constexpr const char* mark_text = R"(
layout(local_size_x = 8, local_size_y = 8) in;
void mark(int level, int face, ivec2 page, uint mask) {
    // Where another page of the level has the place, a coarser one serves.
    for (; level >= 0; --level) {
        int slot = gn_virtual_slot(u.data.faces, level, face, page);
        uint tag = gn_virtual_tag(page);
        uint known = marks[slot];
        known = known == 0u ? atomicCompSwap(marks[slot], 0u, tag) : known;
        if (known == 0u) {
            entries[atomicAdd(listed, 1u)] = uvec2(uint(slot), tag);
        }
        if (known == 0u || known == tag) {
            if ((masks[slot] & mask) != mask) {
                atomicOr(masks[slot], mask);
            }
            return;
        }
        page = page >> 1;
    }
}
)";
constexpr const char* mark_main_text = R"(
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel == ivec2(0)) {
        for (int face = 0; face < u.data.faces; ++face) {
            mark(0, face, ivec2(0), 15u);
        }
    }
    if (any(greaterThanEqual(pixel, ivec2(u.view.size.xy)))) {
        return;
    }
    vec4 position = gbuffer_position_texel(pixel);
    vec4 normal = gbuffer_normal_texel(pixel);
    if (position.w < 0.5 || !gn_counted(u.whole, position.xyz, normal.xyz)) {
        return;
    }
    GnVirtualPlace place = gn_virtual_place_of(gn_receiver(u.view, pixel, position, normal), u.data);
    // Of a level that is some quarters coarser the same page is asked for, or the next coarser one.
    int finest = gn_virtual_level_of(place.wanted, 0, u.data.levels);
    uint mask = 0u;
    for (int quarter = 0; quarter < 4; ++quarter) {
        mask |= gn_virtual_level_of(place.wanted, quarter, u.data.levels) == finest ? 1u << quarter : 0u;
    }
    for (int level = finest; level >= max(finest - 1, 0); --level) {
        uint asked = level == finest ? mask : 15u ^ mask;
        ivec2 first = gn_virtual_page_at(place.face_ts - u.around / float(1 << level), level);
        ivec2 last = gn_virtual_page_at(place.face_ts + u.around / float(1 << level), level);
        for (int y = first.y; y <= last.y && asked != 0u; ++y) {
            for (int x = first.x; x <= last.x; ++x) {
                mark(level, place.face, ivec2(x, y), asked);
            }
        }
    }
}
)";

// Counts the pages there are at one coarseness.
constexpr const char* count_text = R"(
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { int by; };
void count_entry(uint i) {
    int slot;
    uint tag;
    if (!coarsened(entries[i], by, slot, tag)) {
        return;
    }
    // Tags of this coarseness differ from those of all others.
    uint own = (tag & 0xffffffu) | (uint(by + 1) << 24);
    uint known = seen[slot];
    while (known >> 24 != uint(by + 1)) {
        uint before = atomicCompSwap(seen[slot], known, own);
        if (before == known) {
            atomicAdd(counts[by], 1u);
            return;
        }
        known = before;
    }
}
void main() {
    for (uint i = gl_GlobalInvocationID.x; i < listed; i += uint(GN_VIRTUAL_WALKERS)) {
        count_entry(i);
    }
}
)";

// Enters the pages that are wanted into the table.
constexpr const char* want_text = R"(
layout(local_size_x = 64) in;
void main() {
    int by = coarser_by();
    if (gl_GlobalInvocationID.x == 0u) {
        table[2 * gn_virtual_slot(u.data.faces, u.data.levels, 0, ivec2(0))] = uint(by);
    }
    for (uint i = gl_GlobalInvocationID.x; i < listed; i += uint(GN_VIRTUAL_WALKERS)) {
        int slot;
        uint tag;
        if (coarsened(entries[i], by, slot, tag)) {
            atomicCompSwap(table[2 * slot], 0u, tag);
        }
    }
}
)";

// What the pool holds of them, and whether it still may be shown.
constexpr const char* hold_text = R"(
layout(local_size_x = 64) in;
void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u.pages) {
        return;
    }
    uint slot = u.fresh != 0 ? 0u : GN_BEFORE(i, 0);
    uint tag = u.fresh != 0 ? 0u : GN_BEFORE(i, 1);
    bool moved = slot != 0u && touched_page(int(slot) - 1, tag);
    if (slot != 0u && table[2 * (int(slot) - 1)] == tag) {
        GN_FLAG(i) = held | (moved ? stale : 0u);
        table[2 * (int(slot) - 1) + 1] = uint(i) + 1u;
    } else if (moved) {
        slot = 0u;
    }
    GN_SLOT(i) = slot;
    GN_TAG(i) = tag;
}
)";

// Which places are given away, those unused for longest first, and in which order stale pages are drawn, coarse ones first: those of
// level 0 whatever the budget, for nothing else shows their face. The budget keeps room for those of them that have no place yet.
constexpr const char* rank_text = R"(
layout(local_size_x = 64) in;
void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u.pages) {
        return;
    }
    if ((GN_FLAG(i) & held) == 0u) {
        uint used = GN_SLOT(i) == 0u ? 0u : GN_BEFORE(i, 2);
        int rank = 0;
        for (int k = 0; k < u.pages; ++k) {
            uint other = GN_SLOT(k) == 0u ? 0u : GN_BEFORE(k, 2);
            rank += (GN_FLAG(k) & held) == 0u && (other < used || (other == used && k < i)) ? 1 : 0;
        }
        GN_VICTIM(rank) = uint(i);
    } else if ((GN_FLAG(i) & stale) != 0u) {
        int rank = 0;
        for (int k = 0; k < u.pages; ++k) {
            rank += (GN_FLAG(k) & stale) != 0u && GN_SLOT(k) < GN_SLOT(i) ? 1 : 0;
        }
        int first = 0;
        for (int face = 0; face < u.data.faces; ++face) {
            first += table[2 * gn_virtual_slot(u.data.faces, 0, face, ivec2(0)) + 1] == 0u ? 1 : 0;
        }
        if (rank < u.budget - first || gn_virtual_level(u.data.faces, int(GN_SLOT(i)) - 1) == 0) {
            GN_DRAWN(rank) = uint(i);
            atomicAdd(GN_MOVED, 1u);
        } else {
            // What cannot be drawn anew is not shown.
            table[2 * (int(GN_SLOT(i)) - 1) + 1] = 0u;
        }
    }
}
)";

// How many pages of a row of slots are wanted and not held; then how many there are before each row.
constexpr const char* rows_text = R"(
layout(local_size_x = 64) in;
void main() {
    int row = int(gl_GlobalInvocationID.x);
    if (row >= u.rows) {
        return;
    }
    uint missing = 0u;
    for (int i = 0; i < GN_VIRTUAL_SIDE; ++i) {
        int slot = row * GN_VIRTUAL_SIDE + i;
        missing += table[2 * slot] != 0u && table[2 * slot + 1] == 0u ? 1u : 0u;
    }
    GN_ROW(row) = missing;
}
)";
constexpr const char* sum_text = R"(
layout(local_size_x = 1) in;
void main() {
    uint sum = 0u;
    uint whole = 0u;  // of level 0
    for (int row = 0; row < u.rows; ++row) {
        uint missing = GN_ROW(row);
        GN_ROW(row) = sum;
        sum += missing;
        whole = row < u.data.faces * GN_VIRTUAL_SIDE ? sum : whole;
    }
    uint places = 0u;
    for (int i = 0; i < u.pages; ++i) {
        places += GN_FLAG(i) == 0u ? 1u : 0u;
    }
    GN_NEW = min(min(sum, places), max(uint(max(u.budget - int(GN_MOVED), 0)), whole));
    count = GN_MOVED + GN_NEW;
}
)";

// Gives them places, coarse levels first.
constexpr const char* assign_text = R"(
layout(local_size_x = 64) in;
void main() {
    int row = int(gl_GlobalInvocationID.x);
    if (row >= u.rows) {
        return;
    }
    uint k = GN_ROW(row);
    for (int i = 0; i < GN_VIRTUAL_SIDE; ++i) {
        int slot = row * GN_VIRTUAL_SIDE + i;
        if (table[2 * slot] != 0u && table[2 * slot + 1] == 0u && k < GN_NEW) {
            uint page = GN_VICTIM(k);
            table[2 * slot + 1] = page + 1u;
            GN_SLOT(page) = uint(slot) + 1u;
            GN_TAG(page) = table[2 * slot];
            GN_FLAG(page) = held;
            GN_DRAWN(GN_MOVED + k) = page;
            ++k;
        }
    }
}
)";

// Describes every page, and what the next frame finds; then those to be drawn.
constexpr const char* describe_text = R"(
layout(local_size_x = 64) in;
void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u.pages) {
        return;
    }
    uint slot = GN_SLOT(i);
    bool shown = (GN_FLAG(i) & held) != 0u && table[2 * (int(slot) - 1) + 1] == uint(i) + 1u;
    slot = (GN_FLAG(i) & held) != 0u && !shown ? 0u : slot;
    uint used = shown ? u.frame : slot == 0u ? 0u : GN_BEFORE(i, 2);
    imageStore(now, ivec2(i, 0), uvec4(slot));
    imageStore(now, ivec2(i, 1), uvec4(GN_TAG(i)));
    imageStore(now, ivec2(i, 2), uvec4(used));
    int at = max(int(slot) - 1, 0);
    ivec2 page = gn_virtual_page(GN_TAG(i));
    GnLightView view = gn_virtual_view(faces[gn_virtual_face(u.data.faces, at)], gn_virtual_level(u.data.faces, at), page, u.side, u.border, u.jitter);
    view.rect_ts = slot == 0u ? vec4(0.0) : vec4(float(i % u.along), float(i / u.along), 1.0, 1.0) * (u.side / view.resolution);
    views[i] = view;
}
)";
constexpr const char* drawn_text = R"(
layout(local_size_x = 64) in;
void main() {
    int k = int(gl_GlobalInvocationID.x);
    if (k < int(min(count, uint(u.pages)))) {
        drawn[k] = views[GN_DRAWN(k)];
    }
}
)";

constexpr const char* includes =
    "#include \"shadow/placement/virtual/virtual.glsl\"\n#include \"shadow/view/view.glsl\"\n";
// What the placement's functions ask for; the table is not read before it is whole.
constexpr const char* lends_rows =
    "uint gn_virtual_pages(int i) { return 0u; }\nvec4 gn_virtual_rows(int i) { return rows[i]; }\n";
constexpr const char* lends_nothing =
    "uint gn_virtual_pages(int i) { return 0u; }\nvec4 gn_virtual_rows(int i) { return vec4(0.0); }\n";

/// All that the passes share.
struct Buffers {
    Pages pages;
    BufferHandle marks;   ///< the tag of the page of each slot that a sample asks for
    BufferHandle masks;   ///< of it the quarters of a level by which all may be coarser where it is asked for
    BufferHandle seen;    ///< likewise, of each coarseness in turn
    BufferHandle demand;  ///< demand_text
    BufferHandle work;    ///< as head_text divides it
    std::uint32_t rows = 0;
};

Buffers create_buffers(FrameGraph& graph, const PageJob& job) {
    const auto pages = static_cast<VkDeviceSize>(job.pages());
    const auto slots = static_cast<VkDeviceSize>(job.slots());
    const auto words = [&](const char* name, VkDeviceSize count) {
        return graph.create({.name = name, .bytes = count * sizeof(std::uint32_t)});
    };
    Buffers b;
    b.rows = static_cast<std::uint32_t>(slots / GN_VIRTUAL_SIDE);
    b.pages = {
        graph.create({.name = "page views", .bytes = pages * sizeof(GnLightView)}), words("page table", 2 * slots + 1),
        graph.create({.name = "drawn pages", .bytes = pages * sizeof(GnLightView)}), words("drawn page count", 1)};
    b.marks = words("page marks", slots);
    b.masks = words("page masks", slots);
    b.seen = words("page counts", slots);
    b.demand = words("page demand", 2 + 4 * GN_VIRTUAL_MOST_LEVELS + 2 * job.most_listed());
    b.work = words("page work", 5 * pages + b.rows + 2);
    add_zeros(graph, "pages clear", {b.pages.table, b.pages.count, b.marks, b.masks, b.seen, b.demand, b.work});
    return b;
}

/// What samples ask for.
void add_marks(const FrameInput& input, const PageJob& job, const Buffers& b) {
    const std::vector<vec4> rows = clip_rows(job.grid.faces);
    ShaderInputs inputs;
    add_gbuffer(inputs, input.device, input.samples);
    inputs.block("readonly buffer", "Rows", "vec4 rows[];", std::as_bytes(std::span(rows)))
        .buffer("buffer", "Marks", "uint marks[];", b.marks)
        .buffer("buffer", "Masks", "uint masks[];", b.masks)
        .buffer("buffer", "Demand", demand_text, b.demand)
        .constant("GnViewConstants", "view", input.samples.constants)
        .constant("GnLight", "whole", input.whole_light().shape)
        .constant("GnVirtualData", "data", job.data)
        .constant("float", "around", job.reach / job.data.page);
    const auto shader = compute_once(input.prepared, "mark pages", hashed(inputs), [&] {
        return std::string(includes) + inputs.text() + lends_rows + mark_text + mark_main_text;
    });
    add_pixel_pass(input.graph, "mark pages", inputs, shader, input.samples.width, input.samples.height);
}

ShaderInputs search_inputs(const PageJob& job, const Buffers& b) {
    std::vector<vec4> touched = job.touched;
    touched.resize(std::max<std::size_t>(touched.size(), 2));
    ShaderInputs inputs;
    inputs.block("readonly buffer", "Faces", "GnLightView faces[];", std::as_bytes(std::span(job.grid.faces)))
        .block("readonly buffer", "Touched", "vec4 touched[];", std::as_bytes(std::span(touched)))
        .buffer("buffer", "Demand", demand_text, b.demand)
        .buffer("readonly buffer", "Masks", "uint masks[];", b.masks)
        .buffer("buffer", "Seen", "uint seen[];", b.seen)
        .buffer("buffer", "Table", "uint table[];", b.pages.table)
        .buffer("buffer", "Work", "uint work[];", b.work)
        .buffer("buffer", "Count", "uint count;", b.pages.count)
        .buffer("buffer", "Views", "GnLightView views[];", b.pages.views)
        .buffer("writeonly buffer", "Drawn", "GnLightView drawn[];", b.pages.drawn)
        .image("r32ui", "writeonly", "uimage2D", "now", job.now);
    if (job.before.valid()) {
        inputs.texture("usampler2D", "before", job.before);
    }
    inputs.constant("GnVirtualData", "data", job.data)
        .constant("int", "pages", job.pages())
        .constant("int", "rows", static_cast<int>(b.rows))
        .constant("int", "parts", static_cast<int>(job.touched.size() / 2))
        .constant("int", "fresh", job.fresh ? 1 : 0)
        .constant("int", "budget", job.params.drawn > 0 ? job.params.drawn : job.pages())
        .constant("int", "along", job.along)
        .constant("uint", "frame", job.frame)
        .constant("float", "side", static_cast<float>(job.page))
        .constant("vec2", "jitter", job.jitter)
        .constant("float", "border", static_cast<float>(job.border))
        .constant("float", "beyond", static_cast<float>(job.border + 1) / job.data.page);
    return inputs;
}

/// A dispatch of 64 invocations a group, in order.
struct Step {
    const char* text;
    std::uint32_t invocations;
    int by = -1;  ///< pushed where it is not negative
};

std::vector<Step> steps_of(const PageJob& job, std::uint32_t rows) {
    const auto pages = static_cast<std::uint32_t>(job.pages());
    std::vector<Step> steps;
    for (int by = 0; by < 4 * job.data.levels; ++by) {
        steps.push_back({count_text, GN_VIRTUAL_WALKERS, by});
    }
    steps.insert(steps.end(), {{want_text, GN_VIRTUAL_WALKERS},
                               {hold_text, pages},
                               {rank_text, pages},
                               {rows_text, rows},
                               {sum_text, 1},
                               {assign_text, rows},
                               {describe_text, pages},
                               {drawn_text, pages}});
    return steps;
}

}  // namespace

Pages add_page_search(const FrameInput& input, const PageJob& job) {
    const Buffers b = create_buffers(input.graph, job);
    add_marks(input, job, b);

    // Where they are, and what must be drawn.
    const ShaderInputs inputs = search_inputs(job, b);
    const std::vector<Step> steps = steps_of(job, b.rows);
    std::vector<std::shared_ptr<const ComputeDesc>> shaders;
    for (const Step& step : steps) {
        shaders.push_back(compute_once(input.prepared, "find pages", hashed(inputs).text(step.text), [&] {
            return std::string(includes) + inputs.text() + lends_nothing +
                   (job.before.valid() ? "#define GN_BEFORE(page, row) texelFetch(before, ivec2(page, row), 0).r\n"
                                       : "#define GN_BEFORE(page, row) 0u\n") +
                   head_text + step.text;
        }));
    }
    input.graph.add_pass(
        "find pages", [&](PassBuilder& pass) { inputs.declare(pass); },
        [inputs, steps, shaders](Recorder& r) {
            for (std::size_t i = 0; i < steps.size(); ++i) {
                r.bind(*shaders[i]);
                inputs.set(r);
                if (steps[i].by >= 0) {
                    r.push_value(static_cast<std::int32_t>(steps[i].by));
                }
                r.dispatch((steps[i].invocations + 63) / 64, 1);
            }
        });
    return b.pages;
}

}  // namespace gn::virtual_pages
