// SPDX-License-Identifier: MIT
// Based on: van Sambeek. Real-time Shadow Generation for 3D Simulations Using Modern Hardware. Twente 2007. [Sam07]
// The scene "island" of section 4.1.2: an island in the sea under one light so far away that no penumbra shows: a sun, or a
// spot as all his lights are.
#include "scenes/analytic.h"
#include "scenes/mesh_builder.h"
#include "scenes/noise.h"
#include "scenes/registry.h"
#include "scenes/textures.h"

namespace gn::scenes {
namespace {

struct GnIslandParams {
    int light = 0;
    float radius = 0.15F;
};

constexpr int cells = 96;
constexpr float half_extent = 30, bottom = -4;

// Height of the terrain, metres above the sea: a round hill with ridges that dives below the sea towards the border.
float terrain(float x, float z) {
    const float r = std::sqrt(x * x + z * z) / half_extent;
    const float ridges = fractal_noise((x + half_extent) / 7, (z + half_extent) / 7, 64, 5, 71) - 0.42F;
    const float hill = 7.5F * std::exp(-7 * r * r) + 1.6F * std::exp(-3 * r * r);
    return hill * (0.75F + 1.1F * ridges) + 2.4F * ridges * (1 - r) - 1.6F * r * r - 0.5F;
}

// The terrain as a closed block: height field above, skirts, and a flat bottom of the same raster.
void add_terrain(MeshBuilder& builder) {
    const auto at = [](int i, int k) {
        const float x = half_extent * (2.0F * static_cast<float>(i) / cells - 1);
        const float z = half_extent * (2.0F * static_cast<float>(k) / cells - 1);
        return vec2(x, z);
    };
    std::vector<std::uint32_t> upper, lower;
    for (int k = 0; k <= cells; ++k) {
        for (int i = 0; i <= cells; ++i) {
            const vec2 p = at(i, k);
            const float e = 0.05F;
            const vec3 n(terrain(p.x - e, p.y) - terrain(p.x + e, p.y), 2 * e,
                         terrain(p.x, p.y - e) - terrain(p.x, p.y + e));
            upper.push_back(builder.vertex({p.x, std::max(terrain(p.x, p.y), bottom + 0.5F), p.y}, n, p * 0.2F));
            lower.push_back(builder.vertex({p.x, bottom, p.y}, {0, -1, 0}, p * 0.2F));
        }
    }
    const auto index = [](int i, int k) { return static_cast<std::size_t>(k * (cells + 1) + i); };
    for (int k = 0; k < cells; ++k) {
        for (int i = 0; i < cells; ++i) {
            const std::array c{index(i, k), index(i, k + 1), index(i + 1, k + 1), index(i + 1, k)};
            builder.triangle(upper[c[0]], upper[c[1]], upper[c[2]]);
            builder.triangle(upper[c[0]], upper[c[2]], upper[c[3]]);
            builder.triangle(lower[c[0]], lower[c[2]], lower[c[1]]);
            builder.triangle(lower[c[0]], lower[c[3]], lower[c[2]]);
        }
    }
    // Walk the border counter-clockwise seen from above and hang a skirt on it.
    std::vector<std::array<int, 2>> border;
    for (int i = 0; i < cells; ++i) {
        border.push_back({0, i});
    }
    for (int i = 0; i < cells; ++i) {
        border.push_back({i, cells});
    }
    for (int i = cells; i > 0; --i) {
        border.push_back({cells, i});
    }
    for (int i = cells; i > 0; --i) {
        border.push_back({i, 0});
    }
    for (std::size_t s = 0; s < border.size(); ++s) {
        const auto a = border[s], b = border[(s + 1) % border.size()];
        const vec2 pa = at(a[0], a[1]), pb = at(b[0], b[1]);
        const vec3 n(pa.y - pb.y, 0, pb.x - pa.x);
        const float ya = std::max(terrain(pa.x, pa.y), bottom + 0.5F),
                    yb = std::max(terrain(pb.x, pb.y), bottom + 0.5F);
        const auto q0 = builder.vertex({pa.x, bottom, pa.y}, n, vec2(0)),
                   q1 = builder.vertex({pb.x, bottom, pb.y}, n, vec2(0));
        const auto q2 = builder.vertex({pb.x, yb, pb.y}, n, vec2(0)), q3 = builder.vertex({pa.x, ya, pa.y}, n, vec2(0));
        builder.triangle(q0, q1, q2);
        builder.triangle(q0, q2, q3);
    }
}

// A bent trunk with fronds; each frond is a thin closed ridge that droops.
void add_palm(MeshBuilder& builder, int bark, int green, vec3 foot, Dice& dice) {
    builder.begin("palm trunk", bark);
    const float height = dice.between(3.2F, 5.0F), lean = dice.between(0.2F, 1.1F), turn = dice.between(0, 2 * pi);
    std::vector<vec3> path;
    std::vector<float> radii;
    for (int i = 0; i <= 6; ++i) {
        const float t = static_cast<float>(i) / 6;
        path.push_back(foot + vec3(lean * t * t * std::cos(turn), height * t - 0.3F, lean * t * t * std::sin(turn)));
        radii.push_back(glm::mix(0.17F, 0.09F, t));
    }
    builder.tube(path, radii, 8);
    builder.begin("palm fronds", green);
    for (int f = 0; f < 11; ++f) {
        const float a = 2 * pi * (static_cast<float>(f) + dice.between(-0.3F, 0.3F)) / 11,
                    rise = dice.between(0.0F, 0.7F);
        builder.place(path.back() - vec3(0, 0.05F, 0), -a);
        const float length = dice.between(1.5F, 2.1F);
        const std::array ridge{vec3(0), vec3(0.35F * length, 0.25F * rise + 0.12F, 0),
                               vec3(0.75F * length, 0.15F * rise, 0), vec3(length, -0.35F + 0.1F * rise, 0)};
        builder.blade(ridge, std::array{0.05F, 0.21F, 0.16F, 0.01F}, 0.03F);
    }
}

Scene make_island(const ParamBlock& block) {
    Scene scene;
    MeshBuilder builder(scene);
    const int sea =
        builder.material("sea", vec3(1), 0.15F, 0, builder.texture(water_texture("sea", {0.05F, 0.20F, 0.26F}, 67)));
    builder.begin("sea (sheet)", sea, 1.0F / 16);
    builder.sheet({-400, 0, 400}, {800, 0, 0}, {0, 0, -800});
    builder.begin("island", builder.material("sand and scrub", {0.50F, 0.44F, 0.27F}, 0.9F));
    add_terrain(builder);
    const int bark = builder.material("palm bark", {0.30F, 0.22F, 0.15F}, 0.9F),
              green = builder.material("fronds", {0.13F, 0.28F, 0.07F});
    Dice dice(73);
    for (int placed = 0, tries = 0; placed < 24 && tries < 2000; ++tries) {
        const float x = dice.between(-20, 20), z = dice.between(-20, 20);
        const float y = terrain(x, z);
        if (y > 0.5F && y < 4.0F) {
            add_palm(builder, bark, green, {x, y, z}, dice);
            ++placed;
        }
    }
    builder.finish();

    const auto params = block.as<GnIslandParams>();
    const vec3 to_light = glm::normalize(vec3(-0.62F, 0.60F, 0.35F));
    const vec3 color(1, 0.94F, 0.84F);
    const float lux = 60000, distance = 600;
    scene.lights.push_back(params.light == 0 ? directional_light("sun", to_light, lux, params.radius, color)
                                             : spot_light("far spot", distance * to_light, vec3(0),
                                                          distance * std::tan(glm::radians(params.radius)),
                                                          lux * distance * distance, 40, color));
    scene.cameras.push_back(look_at("main", {9, 9, 27}, {0, 1.6F, 1}, 42, 0.1F, 900));
    return scene;
}

}  // namespace

const Generator& island() {
    static const Generator row{
        "island", "An island with palms in the sea under a far light: hard shadows on rough ground.",
        param_table<GnIslandParams>(
            {GN_CHOICE(GnIslandParams, light, "A sun, or a spot 600 m away that is as bright and as wide.", "sun",
                       "spot"),
             GN_PARAM(GnIslandParams, radius, real, 0, 5, "degrees",
                      "Angular radius of the light as seen from the island: 0 is a hard shadow.")}),
        make_island};
    return row;
}

}  // namespace gn::scenes
