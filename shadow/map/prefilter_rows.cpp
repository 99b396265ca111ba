// SPDX-License-Identifier: MIT
// The rows that several prefiltered maps have, each written once.
#include "shadow/map/prefilter.h"

namespace gn {

std::vector<ParamRow> with_prefilter(std::vector<ParamRow> rows, std::size_t offset) {
    std::vector<ParamRow> shared{
        GN_CHOICE(GnPrefilterParams, blur, "The kernel that the map is blurred with.", "none", "box", "gaussian"),
        GN_PARAM(GnPrefilterParams, radius, integer, 0, 64, "texels",
                 "Reach of the blur: softer edges, more of what the map's page says of wide kernels; cost grows in "
                 "proportion."),
        GN_PARAM(GnPrefilterParams, mipmaps, boolean, 0, 1, "", "Smooths distant shadows; a third more memory."),
        GN_PARAM(GnPrefilterParams, anisotropy, integer, 1, 16, "",
                 "Fetches along stretched footprints: sharper at grazing views, slow in software."),
    };
    for (ParamRow& row : shared) {
        row.offset += offset;
    }
    rows.insert(rows.end(), shared.begin(), shared.end());
    return rows;
}

ParamRow samples_row(std::size_t offset) {
    return {"samples",
            ParamType::integer,
            offset,
            1,
            4,
            "",
            "Samples a texel, 1 or 4: smoother edges, four times the memory while drawing.",
            {}};
}

ParamRow slope_moment_row(std::size_t offset) {
    return {"slope_moment",
            ParamType::boolean,
            offset,
            0,
            1,
            "",
            "Adds the slope of the surface to the second moment: no acne on slanted surfaces.",
            {}};
}

ParamRow min_deviation_row(std::size_t offset) {
    return {"min_deviation",
            ParamType::real,
            offset,
            0,
            100,
            "texels",
            "Least standard deviation of depth assumed, a length on the receiver: less acne, softer contacts.",
            {}};
}

ParamRow max_deviation_row(std::size_t offset) {
    return {"max_deviation",
            ParamType::real,
            offset,
            0,
            0.5,
            "of the depth range",
            "Greatest standard deviation of depth believed: less bleeding between casters far apart, harder penumbrae "
            "there.",
            {}};
}

ParamRow reduction_row(std::size_t offset) {
    return {
        "reduction",
        ParamType::choice,
        offset,
        0,
        0,
        "",
        "How the bound is cut: by a line, or by a smooth step, which darkens what bleeds and brightens what is lit.",
        {"linear", "smoothstep"}};
}

ParamRow bleeding_row(std::size_t offset) {
    return {"bleeding",
            ParamType::real,
            offset,
            0,
            0.99,
            "",
            "Share of the bound cut off: less bleeding, darker and harder penumbrae.",
            {}};
}

}  // namespace gn
