// SPDX-License-Identifier: MIT
// The offline session: it takes a scene, draws the view itself, waits and reads back. A renderer that has its own frame
// records through shadow/embed/embed.h instead. No exception leaves it; every failure is one sentence.
// Only a broken invariant of the library's own (GN_CHECK) prints its values and aborts.
//
//     auto session = gn::host::Session::adopt({.instance = ..., .device = ..., .queue = ...});
//     session.value().set_scene(std::move(scene));
//     const auto frame = session.value().render(camera, "pcf,resolution=2048", {.width = 1280, .height = 720});
//     if (frame.ok()) { use(frame.value().visibility[0]); } else { log(frame.why()); }
#pragma once

#include "gpu/device.h"
#include "shadow/embed/result.h"
#include "shadow/frame/frame.h"

#include <memory>
#include <string>

namespace gn::host {

using gn::Done;
using gn::Result;

/// A device and a scene on it. Not thread-safe; the host keeps its queue to itself while a call runs.
class Session {
  public:
    /// On the host's own device. Fails when it lacks what Gnomon needs, naming it.
    static Result<Session> adopt(const AdoptedDevice& host) noexcept;
    /// On a device of its own; `pick` is part of its name, "" the best there is.
    static Result<Session> create(const std::string& pick = {}) noexcept;
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;
    ~Session();

    /// Takes the scene (world space, metres) and uploads it: bounds and missing normals are made, what is no triangle is
    /// dropped with a note. Nothing is moved, no light and no camera is made up: without lights there are no images.
    Result<Done> set_scene(Scene scene) noexcept;
    /// The same from a file or a built-in name, completed as a scene of a file is: moved where it lies far from zero
    /// (Scene::origin says from where), with a camera and a sun where it has none.
    Result<Done> load_scene(const std::string& name_or_path, const LoadOptions& options = {}) noexcept;
    /// The scene as it was completed; null before set_scene.
    [[nodiscard]] const Scene* scene() const noexcept;

    /// V of every light (and the picture, when asked for) by a recipe: a name, a file, with overrides. Its file is read where
    /// another recipe was asked for before, not in every frame.
    Result<FrameResult> render(const Camera& camera, const std::string& recipe, const FrameOptions& options) noexcept;

  private:
    struct State;
    explicit Session(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace gn::host
