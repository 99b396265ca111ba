// SPDX-License-Identifier: MIT
#include "shadow/map/sat_vsm/sat_vsm.glsl"

#include "shadow/map/sums.h"
#include "tests/rig.h"

#include <cstring>
#include <random>

namespace gn::sat_vsm_test {
namespace {

using namespace gn::glsl;

TEST(SatVsm, PackedIntegersComeBackFromSixteenBits) {
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        const uvec2 sums(random(), random());
        const vec4 stored = round(gn_sat_pack(sums) * 65535.0F) / 65535.0F;
        EXPECT_EQ(gn_sat_unpack(stored), sums);
    }
}

TEST(SatVsm, TheLargestBoxOfTheGreatestMomentsDoesNotWrap) {
    for (int max_box = 8; max_box <= 512; ++max_box) {
        const uvec2 one = gn_sat_quantize(vec2(1), gn_sat_levels(max_box));
        const std::uint64_t texels = static_cast<std::uint64_t>(max_box) * static_cast<std::uint64_t>(max_box);
        ASSERT_LE(texels * one.x, 0xffffffffULL) << max_box;
    }
}

TEST(SatVsm, SpansAreCentredAndNeverEmpty) {
    for (float t = -1; t < 17; t += 0.13F) {
        for (const float side : {0.2F, 1.0F, 2.6F, 9.0F, 40.0F}) {
            const GnSatSpan span = gn_sat_span(t, side, 16);
            EXPECT_LE(span.size, 16);
            EXPECT_NEAR(static_cast<float>(span.first) + span.weight + 0.5F * static_cast<float>(span.size), t, 1e-5);
            for (const int offset : {0, 1}) {
                const ivec2 cut = gn_sat_cut(span, offset, 0, 16);
                EXPECT_TRUE(cut.x >= 0 && cut.x < cut.y && cut.y <= 16) << cut.x << " " << cut.y;
            }
        }
    }
}

/// Two layers of random moments, and their table as add_sat makes it.
struct Summed {
    static constexpr std::uint32_t side = 301,
                                   layers = 2;  // more than one tile of the shared scan, and no power of two
    std::vector<vec2> moments;
    std::array<std::vector<std::byte>, layers> table;

    explicit Summed(const SatTable& options) : moments(std::size_t{side} * side * layers) {
        std::mt19937 random(9);
        std::uniform_real_distribution<float> uniform(0, 1);
        for (vec2& m : moments) {
            m.x = uniform(random);
            m.y = m.x * m.x;
        }
        Texture2D source = upload_texture(test::device(),
                                          {.name = "moments",
                                           .format = VK_FORMAT_R32G32_SFLOAT,
                                           .width = side,
                                           .height = side,
                                           .layers = layers,
                                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT},
                                          std::as_bytes(std::span(moments)));
        FrameGraph graph(test::device());
        const TextureHandle sums = add_sat(graph, graph.import(source), options);
        graph.keep(sums);
        graph.execute(false);
        for (std::uint32_t layer = 0; layer < layers; ++layer) {
            table.at(layer) = graph.download(sums, 0, layer);
        }
    }
    [[nodiscard]] const vec2& at(std::uint32_t x, std::uint32_t y, std::uint32_t layer) const {
        return moments[(std::size_t{layer} * side + y) * side + x];
    }
    template <class Texel>
    [[nodiscard]] Texel texel(std::uint32_t x, std::uint32_t y, std::uint32_t layer) const {
        Texel value{};
        std::memcpy(&value, table.at(layer).data() + (std::size_t{y} * side + x) * sizeof(Texel), sizeof(Texel));
        return value;
    }
    /// The table before corner (x, y), as exact integers.
    [[nodiscard]] uvec2 integers(std::uint32_t x, std::uint32_t y, std::uint32_t layer) const {
        if (x == 0 || y == 0) {
            return uvec2(0);
        }
        const auto halves = texel<std::array<std::uint16_t, 4>>(x - 1, y - 1, layer);
        return {halves[0] * 65536U + halves[1], halves[2] * 65536U + halves[3]};
    }
    [[nodiscard]] vec2 floats(std::uint32_t x, std::uint32_t y, std::uint32_t layer) const {
        return x == 0 || y == 0 ? vec2(0) : texel<vec2>(x - 1, y - 1, layer);
    }
};

struct TestBox {
    std::uint32_t x0, y0, x1, y1, layer;
};

/// Boxes up to `largest` texels wide, the corners of the map among them.
std::vector<TestBox> boxes(std::uint32_t largest) {
    std::mt19937 random(17);
    std::vector<TestBox> list{{0, 0, largest, largest, 0},
                              {Summed::side - 1, Summed::side - 1, Summed::side, Summed::side, 1}};
    for (int i = 0; i < 200; ++i) {
        const auto x = static_cast<std::uint32_t>(random() % (Summed::side - largest));
        const auto y = static_cast<std::uint32_t>(random() % (Summed::side - largest));
        list.push_back({x, y, x + 1 + static_cast<std::uint32_t>(random() % largest),
                        y + 1 + static_cast<std::uint32_t>(random() % largest), static_cast<std::uint32_t>(i % 2)});
    }
    return list;
}

TEST(SatVsmRendered, EveryBoxOfAnIntegerTableIsTheSumOfItsTexels) {
    const test::ValidationGuard guard;
    constexpr int max_box = 32;
    const float levels = gn_sat_levels(max_box);
    for (const int scan : {GN_SAT_SCAN_SERIAL, GN_SAT_SCAN_SHARED}) {
        const Summed summed({.table = GN_SAT_UINT32, .scan = scan, .max_box = max_box});
        for (const TestBox& b : boxes(max_box)) {
            uvec2 direct(0);
            for (std::uint32_t y = b.y0; y < b.y1; ++y) {
                for (std::uint32_t x = b.x0; x < b.x1; ++x) {
                    direct += gn_sat_quantize(summed.at(x, y, b.layer), levels);
                }
            }
            const uvec2 box = summed.integers(b.x1, b.y1, b.layer) - summed.integers(b.x0, b.y1, b.layer) -
                              summed.integers(b.x1, b.y0, b.layer) + summed.integers(b.x0, b.y0, b.layer);
            ASSERT_EQ(box, direct) << "scan " << scan << " box " << b.x0 << "," << b.y0 << " to " << b.x1 << ","
                                   << b.y1;
        }
    }
}

TEST(SatVsmRendered, EveryBoxOfAFloatTableIsRightToTheRoundingOfItsCorners) {
    // The format's unit at the table's largest sum, for each of the four corners.
    const test::ValidationGuard guard;
    for (const int scan : {GN_SAT_SCAN_SERIAL, GN_SAT_SCAN_SHARED}) {
        const Summed summed({.table = GN_SAT_FLOAT32, .scan = scan});
        double largest = 0;
        for (std::uint32_t y = 1; y <= Summed::side; ++y) {
            for (std::uint32_t x = 1; x <= Summed::side; ++x) {
                largest = std::max({largest, static_cast<double>(std::abs(summed.floats(x, y, 0).x)),
                                    static_cast<double>(std::abs(summed.floats(x, y, 0).y))});
            }
        }
        const double unit = std::ldexp(1.0, static_cast<int>(std::ceil(std::log2(largest))) - 24);
        for (const TestBox& b : boxes(64)) {
            glm::dvec2 direct(0);
            for (std::uint32_t y = b.y0; y < b.y1; ++y) {
                for (std::uint32_t x = b.x0; x < b.x1; ++x) {
                    direct += glm::dvec2(summed.at(x, y, b.layer) - vec2(gn_sat_centre()));
                }
            }
            const glm::dvec2 box =
                glm::dvec2(summed.floats(b.x1, b.y1, b.layer)) - glm::dvec2(summed.floats(b.x0, b.y1, b.layer)) -
                glm::dvec2(summed.floats(b.x1, b.y0, b.layer)) + glm::dvec2(summed.floats(b.x0, b.y0, b.layer));
            // Each corner has rounded once per row that it sums, with random signs.
            const double steps = scan == GN_SAT_SCAN_SERIAL ? 4 * std::sqrt(2.0 * Summed::side) : 4 * 2 * 10;
            ASSERT_LE(std::abs(box.x - direct.x), steps * unit) << "scan " << scan;
            ASSERT_LE(std::abs(box.y - direct.y), steps * unit) << "scan " << scan;
        }
    }
}

TEST(SatVsmRendered, IsAVarianceMapWithABoxBlur) {
    // Boxes of whole texels blended at four offsets are a bilinear fetch of the blurred map.
    for (const std::string placement : {"fit", "cascades"}) {
        const std::string rest = ",resolution=512,filtered.footprint=radius,filtered.radius=0,placement=" + placement;
        const auto vsm =
            test::compare("stack", "vsm,vsm.mipmaps=false,vsm.radius=4,vsm.min_deviation=0.02" + rest, {.samples = 1});
        for (const std::string table : {"float32", "uint32"}) {
            const auto sat = test::compare(
                "stack", "sat-vsm,sat-vsm.radius=4,sat-vsm.max_box=16,sat-vsm.table=" + table + rest, {.samples = 1});
            const Errors errors =
                visibility_errors(sat.visibility().values, vsm.visibility().values, sat.truth.counted, 192, 192);
            EXPECT_LE(*errors.rmse, 2e-3) << table << " in " << placement;
        }
    }
}

TEST(SatVsmRendered, MostVarianceAndSmoothReductionAreThoseOfAVarianceMap) {
    for (const std::string more : {".max_deviation=0.01", ".reduction=smoothstep"}) {
        const std::string rest = ",placement=single,resolution=512,filtered.footprint=radius,filtered.radius=0";
        const auto vsm = test::compare("stack", "vsm,vsm.mipmaps=false,vsm.radius=4,vsm" + more + rest, {.samples = 1});
        const auto sat = test::compare(
            "stack", "sat-vsm,sat-vsm.radius=4,sat-vsm.max_box=16,sat-vsm.min_deviation=1,sat-vsm" + more + rest,
            {.samples = 1});
        const Errors errors =
            visibility_errors(sat.visibility().values, vsm.visibility().values, sat.truth.counted, 192, 192);
        EXPECT_LE(*errors.rmse, 2e-3) << more;
    }
}

TEST(SatVsmRendered, StaysInRangeAndFreeOfAcne) {
    for (const char* options : {"", ",sat-vsm.table=float32", ",sat-vsm.samples=4,sat-vsm.radius=8"}) {
        const auto c = test::compare("tilted:angle=75", std::string("sat-vsm,resolution=512") + options,
                                     {.width = 96, .height = 96, .samples = 1});
        // As of a variance map: rounding against the deviation of two texels.
        EXPECT_LE(*c.errors.acne, 1e-4) << options;
        for (const float v : c.visibility().values) {
            ASSERT_TRUE(v >= 0 && v <= 1) << v << options;
        }
    }
}

}  // namespace
}  // namespace gn::sat_vsm_test
