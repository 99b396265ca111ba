// SPDX-License-Identifier: MIT
// The offline session, in one page: the host owns the device and the geometry, and asks Gnomon for a visibility image.
#include "host_device.h"

#include "shadow/embed/host.h"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace {

/// The host's own geometry: a floor of 8 x 8 metres and a wall of 2 x 2 metres standing on it.
gn::Scene make_scene() {
    gn::Scene scene;
    scene.name = "host";
    scene.positions_ws = {{-4, 0, -4}, {4, 0, -4}, {4, 0, 4}, {-4, 0, 4}, {-1, 0, 0}, {1, 0, 0}, {1, 2, 0}, {-1, 2, 0}};
    scene.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
    scene.objects = {{.name = "floor", .first_triangle = 0, .triangle_count = 2},
                     {.name = "wall", .first_triangle = 2, .triangle_count = 2}};
    scene.materials.emplace_back();

    // A sun from behind the wall, 45 degrees high: its shadow reaches two metres forward.
    gn::Light sun;
    sun.name = "sun";
    sun.shape.kind = GN_LIGHT_DIRECTIONAL;
    sun.shape.direction_ws = vec4(glm::normalize(vec3(0, -1, 1)), 0);
    sun.shape.intensity = 20000;
    scene.lights = {sun};

    gn::Camera camera;
    camera.position_ws = {0, 5, 7};
    camera.forward_ws = glm::normalize(vec3(0, -5, -7));
    scene.cameras = {camera};
    return scene;
}

void demand(bool holds, const std::string& why) {
    if (!holds) {
        throw std::runtime_error(why);
    }
}

void render(const char* output) {
    HostDevice host;

    // Lend the device and say what was enabled in it, hand over the scene, name a recipe; each call gives a value or a
    // sentence.
    auto session = gn::host::Session::adopt({.instance = host.instance,
                                             .physical = host.physical,
                                             .device = host.device,
                                             .queue = host.queue,
                                             .queue_family = host.queue_family,
                                             .features = &host.features,
                                             .extensions = {host.extensions.begin(), host.extensions.end()}});
    demand(session.ok(), session.why());
    const auto taken = session.value().set_scene(make_scene());
    demand(taken.ok(), taken.why());
    const gn::Camera& camera = session.value().scene()->cameras.front();  // stays where it is, as everything does
    const auto rendered =
        session.value().render(camera, "pcf,resolution=2048", {.width = 320, .height = 240, .picture = false});
    demand(rendered.ok(), rendered.why());
    const gn::FrameResult& frame = rendered.value();

    // V of each pixel, one image a light: what the host multiplies its own light with.
    const gn::Image& visibility = frame.visibility.at(0);
    std::size_t lit = 0;
    std::size_t dark = 0;
    for (std::size_t i = 0; i < visibility.pixels(); ++i) {
        const bool surface = frame.samples.position_ws[i].w > 0.5F;
        lit += surface && visibility.values[i] > 0.5F ? 1 : 0;
        dark += surface && visibility.values[i] <= 0.5F ? 1 : 0;
    }
    gn::write_png(output, visibility);
    std::printf("%s: %zu lit, %zu dark pixels\n", output, lit, dark);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        setenv("GNOMON_DATA", EMBED_DATA, 0);
        render(argc > 1 ? argv[1] : "shadow.png");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "embed: %s\n", error.what());
        return 1;
    }
    return 0;
}
