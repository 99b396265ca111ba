// SPDX-License-Identifier: MIT
// A small renderer of somebody else's: two frames in flight, a G-buffer, a thousand moving objects, a sun and a lamp. Its
// shadows come from Gnomon, recorded between its own passes (shadow_pass.cpp is all that knows of it).
//
// Status 0: all is well. 1: it failed, validation had something to say, or a steady frame created objects. 2: Gnomon refused
// the device or the recipe.
#include "options.h"
#include "picture.h"
#include "scene_pass.h"
#include "shade_pass.h"
#include "shadow_pass.h"
#include "steady.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace {

class Renderer {
  public:
    Renderer(const HostDevice& host, const Options& options)
        : host_(host),
          world_(options.objects),
          shadows_(host, world_, options.recipe, options.baked, options.size, options.draw_casters),
          scene_(host, world_),
          shade_(host) {
        for (auto& slot : slots_) {
            slot = std::make_unique<FrameSlot>(host, world_.colors.size() * sizeof(glm::mat4));
        }
    }
    ~Renderer() {
        wait();
        shadows_.forget_images();
    }
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Images of another size, once the device has finished with those of before. Gnomon notices by itself.
    void resize(VkExtent2D size) {
        wait();
        targets_ = std::make_unique<Targets>(host_, size);
        steady_.begin();
    }

    /// Records and submits the frame. `along` goes from 0 to 1 over the camera's path.
    void draw(float along) {
        const auto index = static_cast<std::uint32_t>(number_ % frames_in_flight);
        FrameSlot& slot = *slots_[index];
        const VkCommandBuffer commands = slot.begin();
        const HostCamera camera = HostCamera::on_path(along);
        const glm::mat4 cs_from_ws =
            camera.cs_from_ws(static_cast<float>(targets_->size.width) / static_cast<float>(targets_->size.height));
        world_.pose(4 * along, slot.transforms.as<glm::mat4>());

        scene_.record(commands, *targets_, slot.transforms, cs_from_ws);
        shadows_.record(commands, index, number_, *targets_, scene_, slot.transforms, cs_from_ws);
        shade_.record(commands, *targets_, camera);
        slot.submit();
        steady_.after_frame(shadows_.gnomon().counters());
        ++number_;
    }

    void wait() const {
        for (const auto& slot : slots_) {
            slot->wait();
        }
    }

    /// The last frame's picture, and where `visibility` is set what it was made of.
    void write(const std::string& path, bool visibility) {
        write_picture(host_, *slots_[0], targets_->picture, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, path);
        const std::string stem = path.substr(0, path.rfind(".png"));
        for (const auto& [light, name] : {std::pair(sun, "-sun.png"), std::pair(lamp, "-lamp.png")}) {
            if (visibility) {
                write_picture(host_, *slots_[0], targets_->visibility[light], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                              stem + name);
            }
        }
    }

    [[nodiscard]] const gn::embed::Shadows& gnomon() const { return shadows_.gnomon(); }
    [[nodiscard]] const Steady& steady() const { return steady_; }

  private:
    const HostDevice& host_;
    World world_;
    ShadowPass shadows_;  // first: it says what the device lacks
    ScenePass scene_;
    ShadePass shade_;
    std::array<std::unique_ptr<FrameSlot>, frames_in_flight> slots_;
    std::unique_ptr<Targets> targets_;
    Steady steady_;
    std::uint64_t number_ = 0;
};

/// Draws all frames; half of them in a smaller picture. Gives the milliseconds of each.
std::vector<double> run(Renderer& renderer, const Options& options) {
    using Clock = std::chrono::steady_clock;
    std::vector<double> milliseconds;
    renderer.resize({options.size.width * 3 / 4, options.size.height * 3 / 4});
    for (std::uint32_t i = 0; i < options.frames; ++i) {
        const Clock::time_point begin = Clock::now();
        if (i == options.frames / 2) {
            renderer.resize(options.size);
        }
        renderer.draw(static_cast<float>(i) / static_cast<float>(options.frames - 1));
        milliseconds.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    }
    renderer.wait();
    return milliseconds;
}

void report(const Renderer& renderer, const Options& options, std::vector<double> milliseconds) {
    const auto middle = milliseconds.begin() + static_cast<std::ptrdiff_t>(milliseconds.size() / 2);
    std::nth_element(milliseconds.begin(), middle, milliseconds.end());
    std::printf("frames: %zu, %u moving objects, median %.1f ms\n", milliseconds.size(), options.objects, *middle);
    std::printf("created in %u steady frames: %s\n", renderer.steady().frames(), renderer.steady().created().c_str());
    std::printf("passes:");
    for (const gn::PassTime& pass : renderer.gnomon().completed(0).passes) {
        std::printf(" '%s'", pass.name.c_str());
    }
    const HostCamera camera = HostCamera::on_path(1);
    std::printf("\ncamera: %g %g %g to %g %g %g, yfov %g\n", camera.eye_ws.x, camera.eye_ws.y, camera.eye_ws.z,
                camera.target_ws.x, camera.target_ws.y, camera.target_ws.z, camera.yfov);
}

/// The exit status.
int render(const Options& options) {
    HostDevice host(options.device);
    bool well = false;
    {
        Renderer renderer(host, options);
        report(renderer, options, run(renderer, options));
        renderer.write(options.output, options.visibility);
        well = renderer.steady().created() == "nothing";
    }
    for (const std::string& message : host.messages) {
        std::fprintf(stderr, "validation: %s\n", message.c_str());
    }
    if (options.device.validate) {
        std::printf("validation: %zu messages\n", host.messages.size());
    }
    return well && host.messages.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        setenv("GNOMON_DATA", EMBED_DATA, 0);
        return render(read_options(argc, argv));
    } catch (const Refused& refused) {
        std::fprintf(stderr, "embed: %s\n", refused.what());
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "embed: %s\n", error.what());
        return 1;
    }
}
