// SPDX-License-Identifier: MIT
// Digits and units as dots, for scales inside pictures.
#include "shadow/show/show_passes.h"

#include <array>

namespace gn {
namespace {

/// Rows from top to bottom; '#' is ink.
struct Glyph {
    char letter;
    std::array<std::string_view, text_height> rows;
};

constexpr std::array<Glyph, 16> glyphs{{{'0', {"###", "# #", "# #", "# #", "###"}},
                                        {'1', {" # ", "## ", " # ", " # ", "###"}},
                                        {'2', {"###", "  #", "###", "#  ", "###"}},
                                        {'3', {"###", "  #", " ##", "  #", "###"}},
                                        {'4', {"# #", "# #", "###", "  #", "  #"}},
                                        {'5', {"###", "#  ", "###", "  #", "###"}},
                                        {'6', {"###", "#  ", "###", "# #", "###"}},
                                        {'7', {"###", "  #", " # ", " # ", " # "}},
                                        {'8', {"###", "# #", "###", "# #", "###"}},
                                        {'9', {"###", "# #", "###", "  #", "###"}},
                                        {'.', {" ", " ", " ", " ", "#"}},
                                        {'/', {"  #", "  #", " # ", "#  ", "#  "}},
                                        {'-', {"   ", "   ", "###", "   ", "   "}},
                                        {'m', {"     ", "## # ", "# # #", "# # #", "# # #"}},
                                        {'c', {"   ", "###", "#  ", "#  ", "###"}},
                                        {' ', {"  ", "  ", "  ", "  ", "  "}}}};

const Glyph& glyph_of(char letter) {
    for (const Glyph& glyph : glyphs) {
        if (glyph.letter == letter) {
            return glyph;
        }
    }
    return glyphs.back();
}

}  // namespace

int text_width(std::string_view text, int scale) {
    int width = 0;
    for (const char letter : text) {
        width += (static_cast<int>(glyph_of(letter).rows[0].size()) + 1) * scale;
    }
    return text.empty() ? 0 : width - scale;
}

int burn_text(Image& picture, int x, int y, std::string_view text, int scale) {
    constexpr float ink = 0.93F;
    int left = x;
    for (const char letter : text) {
        const Glyph& glyph = glyph_of(letter);
        const auto columns = static_cast<int>(glyph.rows[0].size());
        for (int j = 0; j < text_height * scale; ++j) {
            for (int i = 0; i < columns * scale; ++i) {
                const bool dot =
                    glyph.rows.at(static_cast<std::size_t>(j / scale))[static_cast<std::size_t>(i / scale)] == '#';
                if (dot && left + i >= 0 && left + i < picture.width && y + j >= 0 && y + j < picture.height) {
                    for (int c = 0; c < picture.channels; ++c) {
                        picture.at(left + i, y + j, c) = ink;
                    }
                }
            }
        }
        left += (columns + 1) * scale;
    }
    return text_width(text, scale);
}

}  // namespace gn
