// SPDX-License-Identifier: MIT
// The command line, parsed: one struct a command, and what each command is run with.
#pragma once

#include "base/error.h"
#include "shadow/scene/scene.h"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace gn {

/// Wrong usage or unreadable input: ends the command with exit status 2.
struct InputError : Error {
    using Error::Error;
};

/// Runs `body`; a user's mistake in it (scene, recipe, name) becomes an InputError with the same sentence.
template <class Body>
auto reading(const Body& body) {
    try {
        return body();
    } catch (const InputError&) {
        throw;
    } catch (const Error& error) {
        throw InputError(error.what());
    }
}

/// Exit statuses of the command.
inline constexpr int exit_done = 0, exit_failed = 1, exit_input = 2;

struct Size {
    int width = 640, height = 360;  ///< pixels
};

struct ListOptions {
    std::string what;  ///< parts, recipes, scenes, metrics, or "" for all
    bool json = false;
};

struct ShowOptions {
    std::string id;
};

/// --ground: under a model that has no floor, nowhere, or at a height of the file's coordinates.
struct GroundOption {
    bool automatic = true;
    std::optional<double> height;  ///< metres
};

/// How a file is read.
struct FileOptions {
    GroundOption ground;
    std::vector<std::string> assets;  ///< folders that it may read from besides its own
    UpAxis up = UpAxis::y;
    std::string animation;  ///< that moves it; "": all stands as at rest
    double time = 0;        ///< of the animation, seconds
};

struct RenderOptions {
    std::string scene, recipe = "soft", output = "out.png", view, visibility;
    FileOptions file;
    int antialias = 4;        ///< frames, each moved by a part of a pixel
    std::string show, light;  ///< a picture of the hidden and the light that it is of; "" where not asked for
    Size size;
    bool strict = false, validate = false;
};

struct CompareOptions {
    std::vector<std::string> scenes, recipes;
    std::string folder, json, view, light;  ///< "" where not asked for
    FileOptions file;
    std::string against;  ///< the recipe that all others are held against besides, or ""
    bool follow_path = false;
    std::string path;  ///< name of the camera path to follow; "" is the scene's first
    Size size;
    int samples = 256, repeat = 5, threads = 0;
    bool strict = false, validate = false, fresh = false;
    bool shaded = false;  ///< also hold the pictures against light shaded by all of the area, [EASW09] eq. 1.3
    std::string command;  ///< the command line that asks for the same again
};

struct BenchOptions {
    std::string scene = "courtyard", view, json;  ///< "" where not asked for
    std::vector<std::string> recipes;
    FileOptions file;
    Size size;
    int repeat = 5, threads = 0;
    bool strict = false;
};

struct BakeOptions {
    std::vector<std::string> recipes;
    std::string folder;
};

struct SweepOptions {
    std::string file;                   ///< a shipped sweep's name, or a path
    std::string output, report, shard;  ///< "" where not asked for
    int limit = 0, threads = 0;         ///< runs now; 0: all
    bool quick = false, plan = false, again = false, show_only = false, validate = false;
};

struct MergeOptions {
    std::vector<std::string> inputs;
    std::string output, report;
};

struct StudyOptions {
    std::string action;  ///< prepare, serve, analyse, export
    std::string folder, kind = "survey", sweep = "sambeek-quality";
    std::string host = "127.0.0.1", output, json;
    std::vector<std::string> names;  ///< by which a server that is open to others may be called
    int port = 8080;                 ///< 0: any that is free
    bool quick = false;
};

struct ViewOptions {
    std::string scene, session;  ///< one of them
    std::vector<std::string> recipes, views, cameras, shows;
    FileOptions file;
    std::vector<std::string> lights;  ///< NAME,key=value,...
    std::string against, light;       ///< "" where not asked for
    float split = 0.5F, stops = 0;
    bool own_cameras = false, error = false, no_panel = false, plays = false;
    Size window{1280, 720};
    std::optional<Size> picture;  ///< of every viewport
    bool headless = false, validate = false;
    int frames = 0;
    std::string record;
};

struct DoctorOptions {};

using Command = std::variant<ListOptions, ShowOptions, RenderOptions, CompareOptions, BenchOptions, BakeOptions,
                             SweepOptions, MergeOptions, StudyOptions, ViewOptions, DoctorOptions>;

/// Words of options that a session's file has too. Throw InputError.
Size parse_size(const std::string& text);
GroundOption parse_ground(const std::string& text);
UpAxis parse_up(const std::string& text);

/// What the command line asks for; nothing when it was answered already (--help, --version).
/// Throws InputError with one sentence.
std::optional<Command> parse_command_line(int argc, char** argv);

// One function a command, each in its own file; they return the exit status.
int run(const ListOptions& options);
int run(const ShowOptions& options);
int run(const RenderOptions& options);
int run(const CompareOptions& options);
int run(const BenchOptions& options);
int run(const BakeOptions& options);
int run(const SweepOptions& options);
int run(const MergeOptions& options);
int run(const StudyOptions& options);
int run(const ViewOptions& options);
int run(const DoctorOptions& options);

}  // namespace gn
