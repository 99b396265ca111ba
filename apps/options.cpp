// SPDX-License-Identifier: MIT
#include "apps/options.h"

#include "apps/output.h"
#include "base/param.h"
#include "shadow/show/show.h"

#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace gn {

namespace {
constexpr int max_side = 8192;
}

Size parse_size(const std::string& text) {
    Size size{0, 0};
    const char* end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.width);
    const bool separated = width.ec == std::errc{} && width.ptr != end && *width.ptr == 'x';
    const auto height = separated ? std::from_chars(width.ptr + 1, end, size.height) : width;
    if (!separated || height.ec != std::errc{} || height.ptr != end || std::min(size.width, size.height) < 1 ||
        std::max(size.width, size.height) > max_side) {
        throw InputError(fmt::format("--size: '{}' is no size; it is written WIDTHxHEIGHT in pixels, 1x1 to {}x{}",
                                     text, max_side, max_side));
    }
    return size;
}

GroundOption parse_ground(const std::string& text) {
    if (text.empty() || text == "auto") {
        return {};
    }
    double height = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), height);
    const bool number = code == std::errc{} && end == text.data() + text.size() && std::abs(height) <= 1e9;
    if (!number && text != "none") {
        throw InputError(fmt::format("--ground: '{}' is no ground; valid are auto, none, or a height in metres", text));
    }
    return {false, number ? std::optional<double>(height) : std::nullopt};
}

UpAxis parse_up(const std::string& text) {
    if (text != "y" && text != "z") {
        throw InputError(fmt::format("--up: '{}' is no axis that points up; valid are y, z", text));
    }
    return text == "z" ? UpAxis::z : UpAxis::y;
}

namespace {

constexpr const char* description =
    "Gnomon: every real-time shadow technique behind one interface, each measured against ray-traced truth.";

constexpr const char* examples = R"(Examples:
  gnomon list recipes                              what can be compared
  gnomon show pcf                                  a technique's manual page and parameters
  gnomon render model.glb -r pcf -o model.png      one picture with shadows
  gnomon render corridor -r pcf,placement=cascades --show texels -o texels.png
  gnomon compare courtyard -r hard -r pcf,resolution=2048,pcf.taps=25 -o report
  gnomon compare slab contact -r hard -r volumes --json - | jq '.runs[].error.rmse'
  gnomon bench courtyard -r pcf -r volumes         what each pass of a frame waits for on this machine
  gnomon bake pcf,placement=cascades -o baked      its shaders, for renderers that link no compiler
  gnomon sweep sambeek-quality --quick             a grid of runs, into a file that grows and resumes
  gnomon study prepare DIR --kind threshold        then: gnomon study serve DIR; studies with people, in a browser
  gnomon view courtyard -r soft -r hard            see it live: a window, or --headless pictures
  gnomon doctor                                    what this machine's driver can do

SCENE is a built-in scene ('gnomon list scenes'), with parameters as in tilted:angle=85, or a .glb, .gltf, .obj or
.toml file. RECIPE is a recipe's name or .toml file, followed by overrides: pcf,resolution=2048,bias.normal=1.
Exit status: 0 all that was asked for was done; 1 something failed; 2 wrong usage or unreadable input. A refused
recipe, and a run that measured nothing, are no failure unless --strict is given.)";

constexpr const char* ground_help =
    "auto sets a file without a floor on a ground plane; none; or a height in metres of the file (default: auto)";

constexpr const char* up_help =
    "y or z: the axis of a file that points up; z turns it, with lights and cameras (default: y)";
constexpr const char* assets_help =
    "A folder that a file may read from besides its own, with all below it; may be repeated";

constexpr const char* animation_help =
    "The file's animation that moves it, by name or number (default: all is at rest)";
constexpr const char* time_help = "Seconds since the animation's begin (default: 0)";

constexpr const char* compare_examples = R"(Examples:
  gnomon compare courtyard -r hard -r pcf -r volumes -o report         then open report/index.html
  gnomon compare fence corridor -r hard -r hard,resolution=4096 --json figures.json
  gnomon compare car.glb -r pcf --light sun --samples 1024 --size 1280x720 -o report
  gnomon compare courtyard -r vsm -r msm --against pcf,pcf.kernel=9 -o report
  gnomon compare corridor -r pcf,placement=cascades -r pcf,placement=fit --path walk -o report

Results are kept in DIR/results as soon as they are measured: the same command again only measures what is missing.
A run is ok when it served at least one light that reaches what the view sees; a light that it refused, or that reaches
nothing, has status and reason of its own. Ctrl-C keeps what is measured.)";

constexpr const char* bench_examples = R"(Examples:
  gnomon bench                                         soft, pcf, hard and volumes on the courtyard
  gnomon bench grid:objects=100 -r hard,resolution=512 -r volumes --size 1200x1200
  gnomon bench car.glb -r pcf --json - | jq '.runs[].passes[] | {name, ms, bottleneck}'

Small probes measure what this machine can do at best: passes, multiply-adds, bytes, vertices, triangles, fragments. Then every
pass is timed and counted, and what it counted is held against the probes: the largest share is what the pass waits for.
docs/bench.md has the rules. Times are the least of --repeat frames; other work on the machine makes all of them longer.)";

constexpr const char* bake_examples = R"(Examples:
  gnomon bake pcf -o baked                             then Info::baked = "baked" (shadow/embed/embed.h)
  gnomon bake hard pcf,placement=cascades -o baked     for a renderer that changes between both
  gnomon bake my.toml -o baked                         the renderer then asks for "my"

A renderer that links gnomon::embed has no compiler, and needs this folder: compiled shaders, the recipes' files, and
manifest.txt, which says what is in it. It serves every device, every light that the recipe serves, and every form of
depth and normals; values that shaders are given (resolution, bias, ...) may differ from what was baked. It belongs to
the library that wrote it: another version refuses it. Nothing is drawn, but Vulkan must be there, on any device.
A folder that was baked before is replaced, once the new one is whole.)";

constexpr const char* sweep_examples = R"(Examples:
  gnomon sweep sambeek-quality --quick --report report       a shipped sweep's quick version, in minutes, and its page
  gnomon sweep sambeek-performance --limit 30                thirty runs spread over the grid
  gnomon sweep sambeek-performance --plan                    then: runs, hours and bytes that are left
  gnomon sweep mine.toml --shard 2/4 -o part2.sqlite         the second of four parts, on another machine
  gnomon merge part*.sqlite -o all.sqlite --report report    all parts in one file

Each finished run is on the disk before the next begins: the same command again goes on where it ended, however that was.
Shipped: kreuzer-resolution, lauritzen, sambeek-limits, sambeek-memory, sambeek-performance, sambeek-quality. docs/sweep.md
has the format.)";

constexpr const char* study_examples = R"(Examples:
  gnomon study prepare survey                                  draws the pictures of sambeek-quality, the reference with them
  gnomon study prepare limits --kind threshold
  gnomon study serve survey --port 8080                        prints the participants' address and the administrator's
  gnomon study serve survey --host 0.0.0.0 --name lab.example  open to others, called by that name
  gnomon study analyse survey --json results.json              mean ranks, tests and subsets; or thresholds and their fit
  gnomon study export survey -o answers.csv

survey: how realistic are shadows, in ranks of 1 to 9 where 9 is the best? threshold: how wide a filter hides the texels of a
shadow map, by QUEST? Every answer is on the disk before it is acknowledged; sessions go on after a crash. docs/study.md.)";

constexpr const char* view_examples = R"(Examples:
  gnomon view courtyard                                          a window; every parameter is a slider
  gnomon view courtyard -r hard -r pcf -r soft -r volumes        four viewports that look through one camera
  gnomon view model.glb -r soft --against truth --error          beside the truth, which is traced while nothing moves
  gnomon view courtyard --show map -r pcf,placement=cascades     what the recipe hides
  gnomon view --session session.toml                             what was saved
  gnomon view corridor --headless --frames 60 --record walk-%04d.png --play

Left drag looks around, right drag orbits, the wheel goes forward; W A S D Q E fly; Ctrl and drag moves the light; Tab hides the
panel; F12 keeps the window. docs/view.md has the rest.)";

/// How a file is read, as typed.
struct FileWords {
    std::string ground, up = "y";
};

void parse_file(const FileWords& words, FileOptions& file) {
    file.up = parse_up(words.up);
    file.ground = parse_ground(words.ground);
}

/// The words of the command line; one that ends in a comma goes on in the next: -r pcf, pcf.size=5.
std::vector<std::string> joined_words(int argc, char** argv) {
    std::vector<std::string> words;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool goes_on = !words.empty() && words.back().ends_with(',') && word.find('=') != std::string::npos;
        goes_on ? void(words.back() += word) : words.push_back(word);
    }
    return words;
}

/// The command line as it would be typed again.
std::string quoted_command(const std::vector<std::string>& words) {
    std::string line = "gnomon";
    for (const std::string& word : words) {
        line += " " + shell_word(word);
    }
    return line;
}

/// "view, texels, bias" of all pictures of the hidden.
std::string known_pictures() {
    std::string names;
    const auto pictures = hidden_pictures();
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        names += std::string(i == 0 ? "" : ", ") + std::string(pictures[i].name);
    }
    // What lookups tell beside V comes last.
    for (const HiddenPicture& side : side_pictures()) {
        names += ", " + std::string(side.name);
    }
    return names;
}

/// Everything that CLI11 writes into, for the length of one parse.
struct Parser {
    CLI::App app{description, "gnomon"};
    ListOptions list;
    ShowOptions show;
    RenderOptions render;
    CompareOptions compare;
    BenchOptions bench;
    BakeOptions bake;
    SweepOptions sweep;
    MergeOptions merge;
    StudyOptions study;
    ViewOptions view;
    std::string reference;
    std::string render_size, compare_size, bench_size, view_size, view_window;
    FileWords render_file, compare_file, bench_file, view_file;
    CLI::Option* path = nullptr;
    bool verbose = false, quiet = false;

    Parser() {
        app.set_version_flag("--version", "gnomon " GNOMON_VERSION);
        app.add_flag("-v,--verbose", verbose, "Say on standard error what is being done, and every note by itself");
        app.add_flag("-q,--quiet", quiet, "Say no notes; they stay in the report and in the JSON");
        app.require_subcommand(1);
        app.footer(examples);
        add_list();
        add_render();
        add_compare();
        add_bench();
        add_bake();
        add_sweep();
        add_study();
        add_view();
        app.add_subcommand("doctor", "What this machine's driver can do, and what that rules out");
        for (CLI::App* command : app.get_subcommands({})) {
            command->fallthrough();
        }
    }

    void add_list() {
        CLI::App* command = app.add_subcommand("list", "Names of parts, recipes, scenes and metrics");
        command->add_option("WHAT", list.what, "parts, recipes, scenes or metrics; all of them when left out");
        command->add_flag("--json", list.json, "Print JSON");
        CLI::App* page = app.add_subcommand("show", "The manual page of a part, a recipe, a scene or a metric");
        page->add_option("ID", show.id, "A name that 'gnomon list' prints; 'stage/part' where it means several")
            ->required();
    }

    static void add_file_options(CLI::App* command, FileOptions& file, FileWords& words) {
        command->add_option("--ground", words.ground, ground_help);
        command->add_option("--up", words.up, up_help);
        command->add_option("--assets", file.assets, assets_help)->type_name("DIR")->allow_extra_args(false);
        command->add_option("--animation", file.animation, animation_help);
        command->add_option("--time", file.time, time_help)->check(CLI::Range(0.0, 1e9));
    }

    void add_bench() {
        CLI::App* command = app.add_subcommand("bench", "What each pass of a frame waits for on this machine");
        command->add_option("SCENE", bench.scene, "Built-in name or file (default: courtyard)");
        command->add_option("-r,--recipe", bench.recipes,
                            "Recipes with overrides; may be repeated (default: soft, pcf, hard, volumes)");
        command->add_option("--json", bench.json, "Write the figures as JSON; - is standard output");
        command->add_option("--size", bench_size, "WIDTHxHEIGHT in pixels (default: 640x360)");
        command->add_option("--view", bench.view, "Name of the camera (default: the first)");
        add_file_options(command, bench.file, bench_file);
        command->add_option("--repeat", bench.repeat, "Timed frames after one that warms up (default: 5)")
            ->check(CLI::Range(1, 1000));
        command->add_option("--threads", bench.threads, "0 means all (default: 0)")->check(CLI::Range(0, 1024));
        command->add_flag("--strict", bench.strict, "A refusal ends with exit status 1");
        command->footer(bench_examples);
    }

    void add_bake() {
        CLI::App* command = app.add_subcommand("bake", "Shaders compiled ahead, for renderers without a compiler");
        command->add_option("RECIPE", bake.recipes, "Recipes with overrides")->required();
        command->add_option("-o,--output", bake.folder, "Folder to write")->required();
        command->footer(bake_examples);
    }

    void add_sweep() {
        CLI::App* command = app.add_subcommand("sweep", "A grid of scenes, recipes, parameters and sizes, resumable");
        command->add_option("FILE", sweep.file, "A shipped sweep's name, or a .toml file")->required();
        command->add_option("-o,--output", sweep.output, "The file of results, which grows (default: NAME.sqlite)");
        command->add_option("--report", sweep.report, "Write a page of curves, DIR/index.html, and DIR/runs.csv")
            ->type_name("DIR");
        command->add_option("--shard", sweep.shard, "I/N: only the I-th of N parts")->type_name("I/N");
        command->add_option("--limit", sweep.limit, "Measure at most so many runs now")->check(CLI::Range(1, 1 << 30));
        command->add_option("--threads", sweep.threads, "0 means all; changes no error, only times (default: 0)")
            ->check(CLI::Range(0, 1024));
        command->add_flag("--quick", sweep.quick, "The file's shorter axes and smaller pictures");
        command->add_flag("--plan", sweep.plan, "Only say what there is to do, in runs, hours and bytes");
        command->add_flag("--show-only", sweep.show_only, "Measure nothing; write --report from what is there");
        command->add_flag("--again", sweep.again, "Measure failed runs again");
        command->add_flag("--validate", sweep.validate, "Validation layers on; a message fails the run");
        command->footer(sweep_examples);
        command = app.add_subcommand("merge", "Results of parts of a sweep in one file");
        command->add_option("FILE", merge.inputs, "Files that 'gnomon sweep' wrote")->required();
        command->add_option("-o,--output", merge.output, "The new file")->required();
        command->add_option("--report", merge.report, "Write a page of curves, DIR/index.html, and DIR/runs.csv")
            ->type_name("DIR");
    }

    void add_study() {
        CLI::App* command =
            app.add_subcommand("study", "Studies with people: realism of shadows, and thresholds of filters");
        command->add_option("ACTION", study.action, "prepare, serve, analyse or export")
            ->required()
            ->check(CLI::IsMember({"prepare", "serve", "analyse", "export"}));
        command->add_option("DIR", study.folder, "The study's folder")->required();
        command->add_option("--kind", study.kind, "prepare: survey or threshold (default: survey)")
            ->check(CLI::IsMember({"survey", "threshold"}));
        command->add_option("--sweep", study.sweep,
                            "prepare: the sweep whose views are pages and whose recipes are pictures "
                            "(default: sambeek-quality)");
        command->add_flag("--quick", study.quick, "prepare: the sweep's quick version");
        command->add_option("--host", study.host,
                            "serve: the address to listen on (default: 127.0.0.1, this machine only)");
        command->add_option("--port", study.port, "serve: 0 is any that is free (default: 8080)")
            ->check(CLI::Range(0, 65535));
        command
            ->add_option("--name", study.names, "serve: a name by which other machines call this one; may be repeated")
            ->allow_extra_args(false);
        command->add_option("--json", study.json, "analyse: write the results as JSON; - is standard output");
        command->add_option("-o,--output", study.output, "export: the file to write (default: standard output)");
        command->footer(study_examples);
    }

    void add_view() {
        CLI::App* command = app.add_subcommand("view", "A window in which recipes, lights and cameras are moved live");
        command->add_option("SCENE", view.scene, "Built-in name or file");
        command->add_option("--session", view.session, "A file that the viewer saved, instead of all that follows");
        const auto several = [&](const char* names, std::vector<std::string>& values, const char* help) {
            command->add_option(names, values, help)->allow_extra_args(false);
        };
        several("-r,--recipe", view.recipes, "A viewport's recipe with overrides; once for each (default: soft)");
        several("--view", view.views, "Name of the camera; once for all, or for each viewport (default: the first)");
        several("--camera", view.cameras, "Where it stands instead: position=x/y/z,direction=x/y/z,...; likewise");
        several("--show", view.shows, "A picture of what the recipe hides, or none; likewise");
        several("--move-light", view.lights, "NAME,direction=x/y/z,intensity=...: a light that stands otherwise");
        add_file_options(command, view.file, view_file);
        command->add_flag("--own-cameras", view.own_cameras, "Every viewport has a camera of its own");
        command->add_option("--against", view.against, "What stands right of the split: a recipe, or truth");
        command->add_option("--split", view.split, "Share of the picture left of it (default: 0.5)")
            ->check(CLI::Range(0.0, 1.0));
        command->add_flag("--error", view.error, "The signed error left of the split");
        command->add_option("--light", view.light, "The light that --error and --show are of (default: the first)");
        command->add_option("--stops", view.stops, "Exposure beside the automatic one")->check(CLI::Range(-16.0, 16.0));
        command->add_option("--window", view_window, "WIDTHxHEIGHT in pixels (default: 1280x720)");
        command->add_option("--size", view_size, "Of each viewport's picture (default: as large as it is shown)");
        command->add_flag("--no-panel", view.no_panel, "Viewports alone");
        command->add_flag("--play", view.plays, "Plays the animation, and the scene's camera path");
        command->add_flag("--headless", view.headless, "No window; with --frames");
        command->add_option("--frames", view.frames, "Frames to draw")->check(CLI::Range(1, 1 << 20));
        command->add_option("--record", view.record, "Keep what the window would show: a name with %04d, as .png");
        command->add_flag("--validate", view.validate, "Validation layers on; a message ends with exit status 1");
        command->footer(view_examples);
    }

    void add_render() {
        CLI::App* command = app.add_subcommand("render", "One picture of a scene with one recipe's shadows");
        command->add_option("SCENE", render.scene, "Built-in name or file")->required();
        command->add_option("-r,--recipe", render.recipe, "Recipe with overrides (default: soft)");
        command->add_option("-o,--output", render.output, "Picture to write, .png or .exr (default: out.png)");
        command->add_option("--size", render_size, "WIDTHxHEIGHT in pixels (default: 640x360)");
        command->add_option("--view", render.view, "Name of the camera (default: the first)");
        add_file_options(command, render.file, render_file);
        command
            ->add_option("--antialias", render.antialias,
                         "Frames with sub-pixel shifts that are averaged; each costs a whole frame, 1 smooths "
                         "nothing; V and --show are of the unshifted frame (default: 4)")
            ->check(CLI::Range(1, 64));
        command->add_option("--visibility", render.visibility,
                            "Also write V as .exr, a channel a light, or three in colour");
        command->add_option("--show", render.show,
                            "Instead of the picture, what the recipe hides: " + known_pictures());
        command->add_option("--light", render.light, "The light that --show is of (default: the first)");
        command->add_flag("--strict", render.strict, "A light that is refused ends with exit status 1");
        command->add_flag("--validate", render.validate, "Validation layers on; a message ends with exit status 1");
    }

    void add_compare() {
        CLI::App* command = app.add_subcommand("compare", "Recipes measured against ray-traced truth, with a report");
        command->add_option("SCENE", compare.scenes, "Built-in names or files")->required();
        command->add_option("-r,--recipe", compare.recipes,
                            "Recipes with overrides; may be repeated (default: soft, soft-quality, pcf, hard)");
        command->add_option("-o,--output", compare.folder,
                            "Folder for the report: DIR/index.html (default: report, "
                            "unless --json is given)");
        command->add_option("--json", compare.json, "Write the figures as JSON; - is standard output");
        command->add_option("--size", compare_size, "WIDTHxHEIGHT in pixels (default: 640x360)");
        command->add_option("--view", compare.view, "Name of the camera (default: the first)");
        add_file_options(command, compare.file, compare_file);
        command->add_option("--light", compare.light, "Measure this light only (default: all)");
        command->add_option("--against", compare.against,
                            "Also hold every run against this recipe's visibility: the figures 'against'");
        command
            ->add_option("--reference", reference,
                         "shaded: also hold pictures against light shaded by all of the area; luma_rms and flip of it")
            ->check(CLI::IsMember({"visibility", "shaded"}));
        path =
            command
                ->add_option("--path", compare.path,
                             "Also follow this camera path for flicker: a frame and a truth for each of its cameras; "
                             "without NAME the scene's first")
                ->type_name("[NAME]")
                ->expected(0, 1);
        command->add_option("--samples", compare.samples, "Of the light, for the truth (default: 256)")
            ->check(CLI::Range(1, 1 << 20));
        command->add_option("--repeat", compare.repeat, "Timed frames after one that warms up (default: 5)")
            ->check(CLI::Range(1, 1000));
        command->add_option("--threads", compare.threads, "0 means all; changes no error, only times (default: 0)")
            ->check(CLI::Range(0, 1024));
        command->add_flag("--fresh", compare.fresh, "Measure again what DIR/results already has");
        command->add_flag("--strict", compare.strict, "A refusal ends with exit status 1");
        command->add_flag("--validate", compare.validate, "Validation layers on; a message fails the run");
        command->footer(compare_examples);
    }
};

[[noreturn]] void fail_unexpected(const CLI::App& app, const std::string& word) {
    // Name the options of the command that was being read.
    const std::vector<const CLI::App*> chosen =
        app.get_subcommands({}).empty() ? std::vector<const CLI::App*>{}
                                        : app.get_subcommands([](const CLI::App* a) { return a->parsed(); });
    const CLI::App& command = chosen.empty() ? app : *chosen.front();
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    const std::vector<std::string_view> known(names.begin(), names.end());
    throw InputError(fmt::format("{}: '{}' is not expected here; {}", command.get_name(), word, suggest(word, known)));
}

void check_command_name(const CLI::App& app, const std::vector<std::string>& words) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) {
        names.push_back(command->get_name());
    }
    const std::vector<std::string_view> known(names.begin(), names.end());
    for (const std::string& word : words) {
        if (word.starts_with('-')) {
            continue;
        }
        if (std::find(known.begin(), known.end(), word) == known.end()) {
            throw InputError(fmt::format("unknown command '{}'; {}", word, suggest(word, known)));
        }
        return;
    }
}

void parse(Parser& parser, std::vector<std::string> words) {
    // CLI11 takes them last word first. The bare command asks for help.
    std::reverse(words.begin(), words.end());
    try {
        parser.app.parse(words.empty() ? std::vector<std::string>{"--help"} : std::move(words));
    } catch (const CLI::CallForHelp&) {
        throw;
    } catch (const CLI::CallForVersion&) {
        throw;
    } catch (const CLI::ExtrasError&) {
        const std::vector<std::string> rest = parser.app.remaining(true);
        fail_unexpected(parser.app, rest.empty() ? "?" : rest.front());
    } catch (const CLI::ParseError& error) {
        std::string sentence = error.what();
        std::replace(sentence.begin(), sentence.end(), '\n', ' ');
        throw InputError(fmt::format(
            "{} ('gnomon {}--help' explains)", sentence,
            parser.app.get_subcommands().empty() ? "" : parser.app.get_subcommands().front()->get_name() + " "));
    }
}

}  // namespace

std::optional<Command> parse_command_line(int argc, char** argv) {
    // Let CLI11 answer --help and --version, and put its complaints into one sentence.
    Parser parser;
    const std::vector<std::string> words = joined_words(argc, argv);
    check_command_name(parser.app, words);
    try {
        parse(parser, words);
    } catch (const CLI::ParseError& answered) {
        parser.app.exit(answered);
        return std::nullopt;
    }
    spdlog::set_level(parser.quiet ? spdlog::level::err : parser.verbose ? spdlog::level::info : spdlog::level::warn);
    // Hand over the one command that was named.
    const std::string name = parser.app.get_subcommands().front()->get_name();
    if (name == "list") {
        return parser.list;
    }
    if (name == "show") {
        return parser.show;
    }
    if (name == "bench") {
        parse_file(parser.bench_file, parser.bench.file);
        parser.bench.size = parser.bench_size.empty() ? Size{} : parse_size(parser.bench_size);
        if (parser.bench.recipes.empty()) {
            parser.bench.recipes = {"soft", "pcf", "hard", "volumes"};
        }
        return parser.bench;
    }
    if (name == "bake") {
        return parser.bake;
    }
    if (name == "sweep") {
        return parser.sweep;
    }
    if (name == "study") {
        return parser.study;
    }
    if (name == "merge") {
        return parser.merge;
    }
    if (name == "render") {
        parse_file(parser.render_file, parser.render.file);
        parser.render.size = parser.render_size.empty() ? Size{} : parse_size(parser.render_size);
        return parser.render;
    }
    if (name == "view") {
        parse_file(parser.view_file, parser.view.file);
        parser.view.window = parser.view_window.empty() ? parser.view.window : parse_size(parser.view_window);
        parser.view.picture = parser.view_size.empty() ? std::nullopt : std::optional(parse_size(parser.view_size));
        return parser.view;
    }
    if (name == "compare") {
        parse_file(parser.compare_file, parser.compare.file);
        parser.compare.size = parser.compare_size.empty() ? Size{} : parse_size(parser.compare_size);
        parser.compare.command = quoted_command(words);
        parser.compare.shaded = parser.reference == "shaded";
        parser.compare.follow_path = parser.path->count() > 0;
        if (parser.compare.recipes.empty()) {
            parser.compare.recipes = {"soft", "soft-quality", "pcf", "hard"};
        }
        if (parser.compare.folder.empty() && parser.compare.json.empty()) {
            parser.compare.folder = "report";
        }
        return parser.compare;
    }
    return DoctorOptions{};
}

}  // namespace gn
