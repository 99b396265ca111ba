// SPDX-License-Identifier: MIT
// The showcase: a cloister court on a late afternoon. Sun, lantern and a spot behind a grille each cast shadows that
// tell at a glance whether a technique works: bars, leaves, arches, thin legs, and penumbrae from 1 mm to 1 m.
#include "scenes/courtyard/courtyard.h"

#include "scenes/analytic.h"
#include "scenes/registry.h"
#include "scenes/textures.h"

namespace gn::scenes {
namespace yard {

Materials add_materials(MeshBuilder& builder, Scene& scene) {
    const auto textured = [&](const char* name, Texture texture, float roughness) {
        return builder.material(name, vec3(1), roughness, 0, builder.texture(std::move(texture)));
    };
    Materials m{};
    m.paving = textured("paving", mottled_texture("paving", {0.46F, 0.40F, 0.33F}, 0.5F, 0, 3), 0.75F);
    m.stone = textured("limestone", mottled_texture("limestone", {0.62F, 0.54F, 0.42F}, 0.4F, 0.2F, 7), 0.8F);
    m.plaster = textured("plaster", mottled_texture("plaster", {0.70F, 0.56F, 0.40F}, 0.35F, 0.6F, 11), 0.9F);
    m.tile = textured("roof tile", mottled_texture("roof tile", {0.48F, 0.22F, 0.12F}, 0.6F, 0, 13), 0.8F);
    m.wood = textured("oak", wood_texture("oak", {0.33F, 0.20F, 0.11F}, 17), 0.6F);
    m.bark = textured("bark", wood_texture("bark", {0.20F, 0.15F, 0.11F}, 19), 0.9F);
    m.grass = textured("dry grass", mottled_texture("dry grass", {0.26F, 0.27F, 0.12F}, 0.6F, 0, 23), 0.95F);
    m.terracotta = builder.material("terracotta", {0.52F, 0.23F, 0.13F}, 0.8F);
    m.iron = builder.material("wrought iron", {0.035F, 0.04F, 0.045F}, 0.5F, 0.0F);
    m.water = builder.material("water", {0.05F, 0.11F, 0.12F}, 0.08F);
    m.brass = builder.material("brass", {0.55F, 0.38F, 0.14F}, 0.35F, 0.9F);
    m.dark = builder.material("soot", {0.10F, 0.09F, 0.085F}, 0.9F);
    m.leaves = textured("leaves", twig_texture("leaves", {0.17F, 0.26F, 0.06F}, 29), 0.7F);
    scene.materials[static_cast<std::size_t>(m.leaves)].alpha_mode = AlphaMode::mask;
    return m;
}

namespace {

// Sun at 27 degrees, hazy and warm; flame and lamp strong enough to compete with it in the shade of the gallery.
void add_lights(Scene& scene) {
    scene.lights.push_back(
        directional_light("sun", {0.86F, 0.47F, 0.30F}, 4200, glm::degrees(0.00465F), {1.0F, 0.80F, 0.56F}));

    Light lantern;
    lantern.name = "lantern";
    lantern.shape.kind = GN_LIGHT_POINT;
    lantern.shape.position_ws = vec4(lantern_at, 0);
    lantern.shape.radius = 0.05F;
    lantern.shape.color = vec4(1.0F, 0.62F, 0.28F, 1);
    lantern.shape.intensity = 800;
    lantern.shape.range = 30;
    scene.lights.push_back(lantern);

    Light spot;
    spot.name = "spot";
    spot.shape.kind = GN_LIGHT_SPOT;
    const vec3 at(-11.0F, 2.1F, -6.95F), target(-5.4F, 1.7F, -9.0F);
    spot.shape.position_ws = vec4(at, 0);
    spot.shape.direction_ws = vec4(glm::normalize(target - at), 0);
    spot.shape.radius = 0.02F;
    spot.shape.color = vec4(0.72F, 0.86F, 1.0F, 1);
    spot.shape.intensity = 36000;
    spot.shape.cos_inner = std::cos(glm::radians(20.0F));
    spot.shape.cos_outer = std::cos(glm::radians(28.0F));
    spot.shape.range = 40;
    scene.lights.push_back(spot);
}

void add_cameras(Scene& scene) {
    scene.cameras.push_back(look_at("main", {-3.0F, 1.75F, 9.0F}, {0.95F, 1.12F, -3.0F}, 46, 0.1F, 120));
    scene.cameras.push_back(look_at("arcade", {-5.3F, 2.0F, -6.75F}, {0.6F, 1.35F, -8.2F}, 60, 0.1F, 120));
    scene.cameras.push_back(look_at("tree", {0.2F, 1.5F, 6.0F}, {2.9F, 1.55F, 0.8F}, 58, 0.1F, 120));
    scene.cameras.push_back(look_at("gate", {1.2F, 1.6F, 2.6F}, {6.6F, 0.75F, -1.6F}, 56, 0.1F, 120));

    // A slow walk of about a metre past the table, turning towards the arcade.
    CameraPath walk{"walk", {}};
    for (int frame = 0; frame < 24; ++frame) {
        const float t = static_cast<float>(frame) / 23;
        const vec3 eye = glm::mix(vec3(-3.0F, 1.75F, 9.0F), vec3(-2.4F, 1.70F, 8.1F), t);
        const vec3 target = glm::mix(vec3(0.95F, 1.12F, -3.0F), vec3(-0.4F, 1.4F, -4.5F), t);
        walk.frames.push_back(look_at(fmt::format("walk {}", frame), eye, target, 46, 0.1F, 120));
    }
    scene.paths.push_back(std::move(walk));
}

}  // namespace
}  // namespace yard

namespace {

struct GnNoParams {
    int unused = 0;
};

Scene make_courtyard(const ParamBlock&) {
    Scene scene;
    MeshBuilder builder(scene);
    const yard::Materials m = yard::add_materials(builder, scene);
    yard::add_surroundings(builder, m);
    yard::add_paving(builder, m);
    yard::add_arcades(builder, m);
    yard::add_walls(builder, m);
    yard::add_fence(builder, m);
    yard::add_tree(builder, m);
    yard::add_furniture(builder, m);
    yard::add_fountain(builder, m);
    yard::add_lantern(builder, m);
    builder.finish();
    yard::add_lights(scene);
    yard::add_cameras(scene);
    return scene;
}

}  // namespace

const Generator& courtyard() {
    static const Generator row{
        "courtyard",
        "A cloister court with tree, iron fence and fountain under a low sun, a lantern and a spot behind a grille.",
        param_table<GnNoParams>({}), make_courtyard};
    return row;
}

}  // namespace gn::scenes
