// SPDX-License-Identifier: MIT
// What the viewer looks at, and how: what a command line asks for, and what a session's file keeps. Both write cameras and
// lights the same way: words key=value, vectors as x/y/z.
#pragma once

#include "apps/options.h"

#include <array>

namespace gn {

/// What a view is held against: nothing, another recipe, or the traced truth.
enum class Against { nothing, recipe, truth };
inline constexpr std::array<std::string_view, 3> against_names{"nothing", "recipe", "truth"};

struct ViewportSetup {
    std::string recipe = "soft";  ///< with overrides
    std::string view;             ///< name of the scene's camera; "" is the first
    std::string camera;           ///< where it stands instead, parse_camera; "" as the scene says
    std::string show;             ///< a picture of the hidden, "" for none
};

struct ViewSetup {
    std::string scene;
    FileOptions file;
    std::vector<ViewportSetup> viewports;
    std::vector<std::string> lights;  ///< those that stand otherwise than in the scene: NAME,key=value,...
    bool linked = true;               ///< all viewports look through one camera
    Against against = Against::nothing;
    std::string other = "hard";  ///< recipe of Against::recipe
    float split = 0.5F;          ///< share of the width that is left to the recipe
    bool error = false;          ///< signed error laid over the picture
    std::string light;           ///< that error and pictures of the hidden are of; "" is the first
    float stops = 0;             ///< exposure, beside the automatic one
    bool panel = true, plays = false;
    Size window{1280, 720};
    std::optional<Size> picture;  ///< of every viewport, pixels; unset: as large as it is shown
};

/// Of a command line, or of the session that it names. Throws Error.
ViewSetup setup_of(const ViewOptions& options);

/// The camera with what the words say: position, direction, up, yfov_deg, half_height, near, far. Throws Error.
Camera parse_camera(std::string_view words, const Camera& otherwise);
std::string text_of(const Camera& camera);
/// The light with what the words say: direction, position, color, intensity, radius, angular_radius_deg, range. Throws Error.
GnLight parse_light(std::string_view words, const GnLight& otherwise);
/// What of `light` differs from `otherwise`; "" where nothing does.
std::string text_of(const GnLight& light, const GnLight& otherwise);

/// A session's file. Reading throws Error: what, where, and what would be valid.
std::string toml_of(const ViewSetup& setup);
ViewSetup read_session(const std::string& path);
/// The command line that shows the same again.
std::string command_of(const ViewSetup& setup);

}  // namespace gn
