// SPDX-License-Identifier: MIT
// The viewer in hands: without a window, and once in one.
#include "apps/view/viewer.h"

#include "apps/subprocess_test.h"
#include "apps/view/panel.h"
#include "gpu/presenting.h"
#include "shadow/scene/bent_column.h"
#include "shadow/shading/tonemap.h"
#include "tests/thorough.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <thread>

namespace gn::viewer_test {
namespace {

Device& device() {
    static const std::unique_ptr<Device> made = Device::create({.validation = true});
    return *made;
}

ViewSetup setup_of(const std::string& scene, const std::vector<std::string>& recipes) {
    ViewSetup setup;
    setup.scene = scene;
    for (const std::string& recipe : recipes) {
        setup.viewports.push_back({.recipe = recipe, .view = "", .camera = "", .show = ""});
    }
    setup.picture = Size{160, 90};
    setup.window = Size{720, 400};
    return setup;
}

class ViewerTest : public testing::Test {
  protected:
    void SetUp() override { before_ = device().messages().size(); }
    void TearDown() override {
        for (std::size_t i = before_; i < device().messages().size(); ++i) {
            ADD_FAILURE() << "validation: " << device().messages()[i];
        }
    }
    static void draw(Viewer& viewer, int frames) {
        for (int i = 0; i < frames; ++i) {
            viewer.frame();
        }
    }
    /// Frames until something holds, for at most some seconds.
    static bool draw_until(Viewer& viewer, const std::function<bool()>& holds) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (!holds() && std::chrono::steady_clock::now() < end) {
            viewer.frame();
        }
        return holds();
    }
    /// Presses the left button at a share of a widget's width, and lets go at another.
    static void drag(Viewer& viewer, const char* key, float from, float to) {
        const Place* place = place_of(key);
        ASSERT_NE(place, nullptr) << key;
        const Place at = *place;
        ImGuiIO& io = ImGui::GetIO();
        const auto move = [&](float share, bool down) {
            io.MousePos = {glm::mix(at.low.x, at.high.x, share), 0.5F * (at.low.y + at.high.y)};
            io.MouseDown[0] = down;
            viewer.frame();
        };
        move(from, false);
        move(from, true);
        move(to, true);
        move(to, false);
    }
    static void click(Viewer& viewer, const char* key) { drag(viewer, key, 0.5F, 0.5F); }

    std::size_t before_ = 0;
};

long resident_kilobytes() {
    std::ifstream status("/proc/self/status");
    std::string word;
    long kilobytes = 0;
    while (status >> word) {
        if (word == "VmRSS:") {
            status >> kilobytes;
        }
    }
    return kilobytes;
}

TEST_F(ViewerTest, DrawsTheCourtyardInFourViewportsAndThenCreatesNothing) {
    ViewSetup setup =
        setup_of("courtyard", {"hard,resolution=256", "pcf,resolution=256", "vsm,resolution=256", "none"});
    Viewer viewer(device(), setup, nullptr);
    // The camera flies, as it does under a hand; maps of a view that stands still are kept, and have a plan of their own.
    Camera camera = viewer.viewport(0).camera;
    const auto fly = [&] {
        camera.position_ws.x += 0.01F;
        viewer.set_camera(0, camera, false);
        viewer.frame();
    };
    for (int i = 0; i < 6; ++i) {
        fly();
    }
    const Counters steady = device().counters();
    const int frames = test::thorough() ? 200 : 12;
    for (int i = 0; i < frames; ++i) {
        fly();
        ASSERT_EQ(device().counters(), steady) << "frame " << viewer.frames_drawn();
    }
    for (std::size_t i = 0; i < viewer.viewports(); ++i) {
        EXPECT_EQ(viewer.viewport(i).camera.position_ws, camera.position_ws);
        EXPECT_EQ(viewer.viewport(i).trouble, "");
        EXPECT_FALSE(viewer.viewport(i).costs().resources.empty());
    }
}

TEST_F(ViewerTest, TwoThousandFramesTakeNoMemory) {
    if (!test::thorough()) {
        GTEST_SKIP() << "make measure draws 2,000 frames";
    }
    Viewer viewer(device(), setup_of("slab", {"pcf,resolution=256", "evsm2,resolution=256"}), nullptr);
    draw(viewer, 100);
    const long before = resident_kilobytes();
    draw(viewer, 2000);
    // Pages that the allocators keep for themselves come and go; a frame that left a hundred bytes behind would show.
    EXPECT_LT(resident_kilobytes() - before, 1024) << "kilobytes after 2,000 frames";
}

TEST_F(ViewerTest, TakesThePicturesThatRenderWrites) {
    const ScratchFolder folder;
    Viewer viewer(device(), setup_of("slab", {"pcf,resolution=256", "hard,resolution=128"}), nullptr);
    draw(viewer, 3);
    viewer.take_pictures(folder / "shots", "slab");
    viewer.frame();
    viewer.finish();
    for (const auto& [recipe, file] : {std::pair{"pcf,resolution=256", "slab-pcf-resolution-256.png"},
                                       {"hard,resolution=128", "slab-hard-resolution-128.png"}}) {
        const CommandResult rendered = run_gnomon(
            {"render", "slab", "-r", recipe, "--antialias", "1", "--size", "160x90", "-o", folder / "rendered.png"});
        ASSERT_EQ(rendered.status, 0) << rendered.err;
        EXPECT_EQ(file_text(folder / ("shots/" + std::string(file))), file_text(folder / "rendered.png")) << file;
    }
}

TEST_F(ViewerTest, PlaysAnAnimationAndPauses) {
    const ScratchFolder folder;
    std::ofstream(folder / "column.gltf") << testing_scene::bent_column(true);
    ViewSetup setup = setup_of(folder / "column.gltf", {"hard,resolution=256"});
    setup.window = Size{1000, 1500};
    setup.plays = true;
    Viewer viewer(device(), setup, nullptr);
    draw(viewer, 4);
    // Without a window a frame takes a sixtieth of a second; the first shows where it begins.
    EXPECT_EQ(viewer.world().file.animation, "bend");
    EXPECT_NEAR(viewer.world().file.time, 3.0 / 60, 1e-6);
    viewer.speed = 30;
    draw(viewer, 3);
    EXPECT_NEAR(viewer.world().file.time, std::fmod(3.0 / 60 + 1.5, 1.0), 1e-5) << "it begins anew";
    // Poses go along with their frames: once both frames in flight have room for one, nothing is made.
    const Counters steady = device().counters();
    draw(viewer, 6);
    EXPECT_EQ(device().counters(), steady);
    click(viewer, "animation.plays");
    EXPECT_FALSE(viewer.animates);
    const double paused = viewer.world().file.time;
    draw(viewer, 2);
    EXPECT_EQ(viewer.world().file.time, paused);

    // The slider goes to a time, and a frame of it is what render writes, bit for bit.
    drag(viewer, "animation.time", 0.3F, 0.6F);
    const double chosen = viewer.world().file.time;
    EXPECT_NE(chosen, paused);
    viewer.take_pictures(folder / "shots", "column");
    viewer.frame();
    viewer.finish();
    const CommandResult rendered = run_gnomon({"render", folder / "column.gltf", "-r", "hard,resolution=256",
                                               "--antialias", "1", "--size", "160x90", "--animation", "bend", "--time",
                                               fmt::format("{}", chosen), "-o", folder / "rendered.png"});
    ASSERT_EQ(rendered.status, 0) << rendered.err;
    EXPECT_EQ(file_text(folder / "shots/column-hard-resolution-256.png"), file_text(folder / "rendered.png"));

    // Of shapes that weights pull likewise.
    viewer.set_pose("lean", 0.25);
    draw(viewer, 2);
    viewer.set_pose("lean", 0.75);
    viewer.take_pictures(folder / "shots", "leaning");
    viewer.frame();
    viewer.finish();
    const CommandResult leaning =
        run_gnomon({"render", folder / "column.gltf", "-r", "hard,resolution=256", "--antialias", "1", "--size",
                    "160x90", "--animation", "lean", "--time", "0.75", "-o", folder / "leaning.png"});
    ASSERT_EQ(leaning.status, 0) << leaning.err;
    EXPECT_EQ(file_text(folder / "shots/leaning-hard-resolution-256.png"), file_text(folder / "leaning.png"));
    EXPECT_NE(file_text(folder / "leaning.png"), file_text(folder / "rendered.png"));
    viewer.set_pose("bend", chosen);

    // A session comes back to it, and so does a command line.
    viewer.save_session(folder / "session.toml");
    const std::string saved = toml_of(viewer.setup());
    EXPECT_NE(command_of(viewer.setup()).find(fmt::format("--animation bend --time {}", chosen)), std::string::npos);
    viewer.set_pose("", 0);
    viewer.load_session(folder / "session.toml");
    draw(viewer, 1);
    EXPECT_EQ(viewer.world().file.time, chosen) << viewer.message;
    EXPECT_EQ(toml_of(viewer.setup()), saved);
}

TEST_F(ViewerTest, TracesTheTruthOfAPoseAnew) {
    const ScratchFolder folder;
    std::ofstream(folder / "column.gltf") << testing_scene::bent_column();
    ViewSetup setup = setup_of(folder / "column.gltf", {"hard,resolution=256"});
    setup.picture = Size{32, 24};
    setup.against = Against::truth;
    const auto traced = [](Viewer& viewer) {
        EXPECT_TRUE(draw_until(
            viewer, [&] { return viewer.truth() != nullptr && viewer.truth()->samples == TruthWorker::most_samples; }));
        return download(device(), viewer.truth()->visibility.front());
    };
    std::vector<std::byte> bent;
    {
        Viewer viewer(device(), setup, nullptr);
        EXPECT_TRUE(draw_until(viewer, [&] { return viewer.truth() != nullptr; }));
        viewer.set_pose("bend", 1);
        viewer.frame();
        EXPECT_EQ(viewer.truth(), nullptr);
        bent = traced(viewer);
    }
    // What is traced is the scene as it stands: the truth of one that never stood otherwise.
    setup.file.animation = "bend";
    setup.file.time = 1;
    Viewer anew(device(), setup, nullptr);
    EXPECT_EQ(bent, traced(anew));
}

TEST_F(ViewerTest, SlidersChangeTheRecipe) {
    ViewSetup setup = setup_of("slab", {"pcf,resolution=256"});
    setup.window = Size{1000, 1500};  // all of the panel is in sight
    Viewer viewer(device(), setup, nullptr);
    draw(viewer, 3);
    const std::string before = viewer.viewport(0).recipe.text().text();
    const std::string size = value_of(viewer.viewport(0).recipe.asked(), "pcf.size");
    drag(viewer, "pcf.size", 0.1F, 0.6F);
    const std::string after = viewer.viewport(0).recipe.text().text();
    EXPECT_NE(after, before);
    EXPECT_NE(after.find("pcf.size="), std::string::npos) << after;
    EXPECT_NE(value_of(viewer.viewport(0).recipe.asked(), "pcf.size"), size);
    EXPECT_TRUE(draw_until(viewer, [&] { return !viewer.viewport(0).recipe.awaits(); }));
    EXPECT_EQ(value_of(viewer.viewport(0).recipe.now()->recipe(), "pcf.size"),
              value_of(viewer.viewport(0).recipe.asked(), "pcf.size"));
}

TEST_F(ViewerTest, RecipesChangeWhileFramesGoOn) {
    Viewer viewer(device(), setup_of("slab", {"hard,resolution=256"}), nullptr);
    draw(viewer, 3);
    viewer.set_recipe(0, "evsm2,resolution=128");
    EXPECT_TRUE(draw_until(viewer, [&] { return !viewer.viewport(0).recipe.awaits(); }));
    EXPECT_EQ(viewer.viewport(0).recipe.now()->recipe().name, "evsm2");
    viewer.set_recipe(0, "pfc");
    EXPECT_NE(viewer.message.find("pcf"), std::string::npos) << viewer.message;
    EXPECT_EQ(viewer.viewport(0).recipe.text().text(), "evsm2,resolution=128");
    draw(viewer, 2);
}

TEST_F(ViewerTest, LoadsAnotherSceneSavesAndComesBack) {
    const ScratchFolder folder;
    Viewer viewer(device(), setup_of("slab", {"pcf,resolution=256", "hard,resolution=256"}), nullptr);
    draw(viewer, 2);
    Camera camera = viewer.viewport(0).camera;
    camera.position_ws.y += 0.5F;
    viewer.set_camera(0, camera, false);
    viewer.world().move_light(viewer.world().scene.lights.front().name + ",intensity=7");
    viewer.stops = 1;
    const std::string saved = toml_of(viewer.setup());
    viewer.save_session(folder / "session.toml");

    viewer.load("contact", {});
    EXPECT_EQ(viewer.world().scene.name, "contact") << viewer.message;
    draw(viewer, 2);
    viewer.load("no-such-scene", {});
    EXPECT_EQ(viewer.world().scene.name, "contact");
    EXPECT_NE(viewer.message.find("no-such-scene"), std::string::npos) << viewer.message;

    viewer.load_session(folder / "session.toml");
    draw(viewer, 2);
    EXPECT_EQ(toml_of(viewer.setup()), saved) << viewer.message;
}

TEST_F(ViewerTest, RefinesTheTruthWhileNothingMoves) {
    ViewSetup setup = setup_of("slab", {"hard,resolution=256"});
    setup.picture = Size{64, 48};
    setup.against = Against::truth;
    setup.error = true;
    Viewer viewer(device(), setup, nullptr);
    EXPECT_TRUE(draw_until(viewer, [&] { return viewer.truth() != nullptr && viewer.truth()->samples >= 64; }));
    draw(viewer, 2);
    // A camera that moves leaves it behind.
    Camera camera = viewer.viewport(0).camera;
    camera.position_ws.x += 0.1F;
    viewer.set_camera(0, camera, false);
    viewer.frame();
    EXPECT_EQ(viewer.truth(), nullptr);
    EXPECT_TRUE(draw_until(viewer, [&] { return viewer.truth() != nullptr; }));
}

TEST_F(ViewerTest, ShowsWhatARecipeHides) {
    ViewSetup setup = setup_of("slab", {"pcf,resolution=128", "volumes"});
    setup.viewports[0].show = "map";
    setup.viewports[1].show = "map";
    Viewer viewer(device(), setup, nullptr);
    draw(viewer, 2);
    EXPECT_NE(viewer.viewport(0).legend, "");
    EXPECT_NE(viewer.viewport(1).legend.find("no shadow map"), std::string::npos) << viewer.viewport(1).legend;
    viewer.viewport(0).show.clear();
    draw(viewer, 3);
    EXPECT_EQ(viewer.viewport(0).shown().desc().width, 160U);
}

TEST_F(ViewerTest, TimesPassesWhereItIsAsked) {
    ViewSetup setup = setup_of("slab", {"pcf,resolution=256"});
    setup.window = Size{1000, 2600};
    Viewer viewer(device(), setup, nullptr);
    draw(viewer, 3);
    for (const char* folded : {"Light", "Camera", "Costs", "Scene", "Keep"}) {
        click(viewer, folded);
    }
    draw(viewer, 3);
    EXPECT_GT(viewer.viewport(0).costs().transient_bytes, 0U);
    if (!device().has(Feature::timestamps)) {
        click(viewer, "measures");
        EXPECT_TRUE(viewer.measures);
    }
    draw(viewer, 12);
    double sum = 0;
    for (const PassTime& pass : viewer.viewport(0).costs().passes) {
        sum += pass.ms;
    }
    EXPECT_GT(sum, 0.0);
    EXPECT_EQ(viewer.viewport(0).trouble, "");
}

TEST_F(ViewerTest, HoldsARecipeAgainstAnother) {
    ViewSetup setup = setup_of("slab", {"pcf,resolution=256"});
    setup.against = Against::recipe;
    setup.other = "hard,resolution=128";
    setup.error = true;
    Viewer viewer(device(), setup, nullptr);
    EXPECT_TRUE(draw_until(viewer, [&] { return viewer.viewport(0).other.now() != nullptr; }));
    draw(viewer, 6);
    const Counters steady = device().counters();
    draw(viewer, 6);
    EXPECT_EQ(device().counters(), steady);
}

/// What the display server of this number answers to a client that greets it: nothing where it takes it, or its reason.
std::string refusal_of_display(int number) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = "/tmp/.X11-unix/X" + std::to_string(number);
    std::copy(path.begin(), path.end(), std::begin(address.sun_path));
    const int end = socket(AF_UNIX, SOCK_STREAM, 0);
    std::string reason = path + " takes no connection";
    if (connect(end, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
        // Byte order, version 11.0, no authorization: 12 bytes; the answer starts with 1 where the client is taken.
        constexpr std::array<unsigned char, 12> greeting{'l', 0, 11};
        std::array<unsigned char, 8> answer{};
        const bool spoken = write(end, greeting.data(), greeting.size()) == ssize_t(greeting.size());
        reason = !spoken || read(end, answer.data(), answer.size()) != ssize_t(answer.size())
                     ? path + " closes a connection"
                     : (answer[0] == 1 ? "" : path + " refuses a client");
    }
    close(end);
    return reason;
}

/// A display server of its own, as long as a test.
class DisplayServer {
  public:
    DisplayServer() {
        std::array<int, 2> ends{};
        if (pipe(ends.data()) != 0) {
            return;
        }
        pid_ = fork();
        if (pid_ == 0) {
            close(ends[0]);
            const std::string number = std::to_string(ends[1]);
            // It ends with this process, and not with its last client: one that only looks for a display must not end it.
            prctl(PR_SET_PDEATHSIG, SIGTERM);
            execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "800x600x24", "-nolisten", "tcp",
                   "-noreset", "-ac", nullptr);
            _exit(127);
        }
        close(ends[1]);
        // To the end of what it writes: a server whose number is read and whose line's end is not dies of the closed pipe.
        std::string text;
        for (char c = 0; read(ends[0], &c, 1) == 1;) {
            text += c;
        }
        close(ends[0]);
        if (!text.empty()) {
            await(std::atoi(text.c_str()));
        }
    }
    ~DisplayServer() {
        unsetenv("DISPLAY");
        if (pid_ > 0) {
            kill(pid_, SIGTERM);
            waitpid(pid_, nullptr, 0);
        }
    }
    DisplayServer(const DisplayServer&) = delete;
    DisplayServer& operator=(const DisplayServer&) = delete;
    /// Why no window can be opened on it; nothing where one can.
    [[nodiscard]] const std::string& missing() const { return missing_; }

  private:
    /// A machine may let the server start and keep its clients from it: ten seconds of refusals say so.
    void await(int number) {
        for (int tries = 0; tries < 100 && !missing_.empty(); ++tries) {
            missing_ = refusal_of_display(number);
            if (!missing_.empty()) {
                std::this_thread::sleep_for(std::chrono::milliseconds(100));
            }
        }
        setenv("DISPLAY", (":" + std::to_string(number)).c_str(), 1);
    }

    pid_t pid_ = -1;
    std::string missing_ = "no Xvfb runs on this machine";
};

TEST(ViewerWindow, OpensDrawsResizesAndCloses) {
    const DisplayServer display;
    if (!display.missing().empty()) {
        GTEST_SKIP() << "no window was opened: " << display.missing();
    }
    ViewSetup setup = setup_of("slab", {"hard,resolution=256"});
    setup.window = Size{480, 270};
    Window window(setup.window);
    const std::unique_ptr<Device> presenting =
        create_presenting_device({.validation = true}, window.instance_extensions());
    window.attach(*presenting);
    {
        Viewer viewer(*presenting, setup, &window);
        for (int i = 0; i < 6 && window.poll(); ++i) {
            viewer.frame();
        }
        glfwSetWindowSize(window.glfw(), 400, 300);
        for (int i = 0; i < 6 && window.poll(); ++i) {
            viewer.frame();
        }
        EXPECT_EQ(window.size(), uvec2(400, 300));
        EXPECT_GE(viewer.frames_drawn(), 10U);
        window.close();
        EXPECT_FALSE(window.poll());
        viewer.finish();
    }
    window.detach();
    for (const std::string& message : presenting->messages()) {
        ADD_FAILURE() << "validation: " << message;
    }
}

TEST(ViewCommand, SaysInASentenceWhatIsWrong) {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    const auto expect = [](const std::vector<std::string>& words, int status, const char* part) {
        const CommandResult result = run_gnomon(words);
        EXPECT_EQ(result.status, status) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    };
    expect({"view", "slab"}, 1, "--headless");
    expect({"view"}, 2, "--session");
    expect({"view", "slab", "--headless"}, 2, "--frames");
    expect({"view", "slab", "--headless", "--frames", "1", "--record", "out.png"}, 2, "%04d");
    expect({"view", "slab", "-r", "pfc"}, 2, "pcf");
    expect({"view", "slab", "--show", "nothing-such"}, 2, "texels");
    expect({"view", "slab", "--animation", "walk", "--headless", "--frames", "1"}, 2, "nothing of this scene moves");
    expect({"render", "slab", "--time", "2"}, 2, "--animation");
    expect({"view", "no-such-scene", "--headless", "--frames", "1"}, 2, "no-such-scene");
}

TEST(ViewCommand, RecordsFramesWithoutAWindow) {
    const ScratchFolder folder;
    const CommandResult result =
        run_gnomon({"view", "slab", "-r", "pcf,resolution=128", "-r", "hard,resolution=128", "--headless", "--frames",
                    "3", "--window", "640x360", "--validate", "--record", folder / "view-%04d.png"});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(file_text(folder / "view-0002.png"), "");
    EXPECT_FALSE(std::filesystem::exists(folder / "view-0003.png"));
}

}  // namespace
}  // namespace gn::viewer_test
