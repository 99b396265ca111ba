// SPDX-License-Identifier: MIT
// gnomon view: the viewer in a window, or without one into a series of pictures.
#include "apps/choose.h"
#include "apps/notes.h"
#include "apps/output.h"
#include "apps/terminal.h"
#include "apps/view/viewer.h"
#include "gpu/presenting.h"
#include "shadow/show/show.h"

#include <fstream>

namespace gn {
namespace {

/// The name of picture `i`: FILE with its number for %04d.
std::string numbered(const std::string& file, std::uint64_t i) {
    const std::size_t at = file.find("%04d");
    return file.substr(0, at) + fmt::format("{:04}", i) + file.substr(at + 4);
}

void check(const ViewOptions& options) {
    if (options.headless != (options.frames > 0)) {
        throw InputError(
            "--headless and --frames belong together: a viewer without a window ends after so many frames");
    }
    if (!options.record.empty() && (!options.headless || options.record.find("%04d") == std::string::npos)) {
        throw InputError(
            fmt::format("--record {}: it is a series of pictures of --headless; its name has %04d for their numbers, "
                        "as in view-%04d.png",
                        options.record));
    }
    if (!options.record.empty()) {
        check_writable_parent("--record", numbered(options.record, 0));
    }
}

/// Everything that the user may have got wrong is found before a window opens.
ViewSetup checked_setup(const ViewOptions& options) {
    check(options);
    return reading([&] {
        ViewSetup setup = setup_of(options);
        for (const ViewportSetup& viewport : setup.viewports) {
            load_recipe(viewport.recipe);
            viewport.show.empty() ? void() : void(find_hidden(viewport.show));
        }
        if (setup.against == Against::recipe) {
            load_recipe(setup.other);
        }
        return setup;
    });
}

void draw_headless(Viewer& viewer, const ViewOptions& options) {
    Progress progress;
    for (int i = 0; i < options.frames && !stop_requested(); ++i) {
        progress.step(i, options.frames, "drawing frames");
        if (!options.record.empty()) {
            viewer.take_window(numbered(options.record, viewer.frames_drawn()));
        }
        viewer.frame();
    }
    viewer.finish();
    progress.clear();
}

void draw_in_window(Viewer& viewer, Window& window) {
    while (window.poll() && !stop_requested()) {
        if (window.size().x == 0 || window.size().y == 0) {
            window.wait();  // minimized
            continue;
        }
        viewer.frame();
    }
    viewer.finish();
}

int end(const Device& device) {
    for (const std::string& message : device.messages()) {
        fmt::print(stderr, "gnomon: validation: {}\n", message);
    }
    return device.messages().empty() ? exit_done : exit_failed;
}

}  // namespace

int run(const ViewOptions& options) {
    const ViewSetup setup = checked_setup(options);
    watch_signals();
    if (options.headless) {
        const std::unique_ptr<Device> device = Device::create({.validation = options.validate});
        say_notes("device", device->info().notes);
        {
            Viewer viewer(*device, setup, nullptr);
            draw_headless(viewer, options);
            fmt::print("{}: {} frames of {} with {} viewports, {:.1f} ms each, on {}\n",
                       options.record.empty() ? "nothing recorded" : options.record, viewer.frames_drawn(), setup.scene,
                       viewer.viewports(), viewer.frame_ms(), device->info().name);
        }
        return end(*device);
    }
    Window window(setup.window);
    const std::unique_ptr<Device> device =
        create_presenting_device({.validation = options.validate}, window.instance_extensions());
    say_notes("device", device->info().notes);
    // The window's surface ends before the device does, whatever happens.
    struct Attached {
        Window& window;
        Attached(Window& of, Device& to) : window(of) { window.attach(to); }
        ~Attached() { window.detach(); }
    } attached(window, *device);
    {
        Viewer viewer(*device, setup, &window);
        draw_in_window(viewer, window);
    }
    return end(*device);
}

}  // namespace gn
