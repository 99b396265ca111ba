// SPDX-License-Identifier: MIT
// What the groups of ratios share: a device, scenes kept on it, what is timed, and the rows they print.
#pragma once

#include "shadow/frame/frame.h"

#include <map>
#include <memory>

namespace gn::performance {

/// Both sides of a ratio are run this often in turns, so that what else the machine does meets both.
inline constexpr int rounds = 4;

class Bench {
  public:
    Bench();
    Device& device() { return *device_; }
    SceneGpu& scene(const std::string& name);
    void print_head() const;

    /// Pixels of a picture: a GPU draws small ones within the noise of its clock.
    [[nodiscard]] uvec2 size() const { return device_->info().cpu ? uvec2(960, 540) : uvec2(3840, 2160); }
    /// Runs of one side in a turn; a GPU's clock rises while it works.
    [[nodiscard]] int repeats() const { return device_->info().cpu ? 4 : 40; }

  private:
    struct Kept {
        Scene scene;
        SceneGpu gpu;
    };
    std::unique_ptr<Device> device_;
    std::map<std::string, std::unique_ptr<Kept>> scenes_;
};

/// What is timed: runs it Bench::repeats() times and returns the least time, ms.
using Timed = std::function<double()>;

/// Passes of these names of one light's shadow from the scene's first camera; without names all of the shadow's passes.
Timed passes(Bench& bench, std::string scene, Recipe recipe, std::vector<std::string> names = {}, int light = 0);
/// The same of a frame after one that was alike: what a sequence of still frames costs.
Timed still_passes(Bench& bench, std::string scene, Recipe recipe, int light);
/// Passes of a graph of one's own; `build` keeps what it needs alive.
Timed graph_passes(Bench& bench, std::function<void(FrameGraph&)> build, std::vector<std::string> names);

void print_title(const char* title);
/// The least time of `a` over the least of `b`, taken in turns; `copies` counts b more than once.
void print_ratio(const std::string& what, const Timed& a, const Timed& b, double copies = 1);

/// The least time of `ours` over what `with` adds to `without`, all three taken in turns.
void print_over_added(const std::string& what, const Timed& ours, const Timed& with, const Timed& without);

/// The groups, each in a file of its own name.
void lookups(Bench& bench);
void placements(Bench& bench);
void filters(Bench& bench);
void inlined(Bench& bench);
void recording(Bench& bench);
void recording_geometry(Bench& bench);
void soft(Bench& bench);
void geometry(Bench& bench);

}  // namespace gn::performance
