// SPDX-License-Identifier: MIT
// gnomon study from outside: a server behind its socket, killed and started again, and what its answers become.
#include "apps/subprocess_test.h"

#include <gtest/gtest.h>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <memory>
#include <regex>
#include <thread>

namespace gn {
namespace {

using nlohmann::json;

/// A server on a port that was free, and where it said that it is.
class Server {
  public:
    explicit Server(const std::string& folder)
        : running_(
              std::make_unique<RunningCommand>(std::vector<std::string>{"study", "serve", folder, "--port", "0"})) {
        for (int i = 0; i < 1000 && port_ == 0 && !running_->finished(); ++i) {
            std::smatch found;
            const std::string said = running_->said();
            if (std::regex_search(said, found, std::regex("http://127\\.0\\.0\\.1:(\\d+)/admin\\?key=(\\w+)\n"))) {
                port_ = std::stoi(found[1]);
                key_ = found[2];
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        client_ = std::make_unique<httplib::Client>("127.0.0.1", port_);
    }
    json post(const std::string& path, const json& body, int expected = 200) {
        const auto reply = client_->Post(path, body.dump(), "application/json");
        EXPECT_TRUE(reply) << path;
        EXPECT_EQ(reply ? reply->status : 0, expected) << (reply ? reply->body : "");
        return reply ? json::parse(reply->body) : json();
    }
    std::string get(const std::string& path, int expected = 200) {
        const auto reply = client_->Get(path);
        EXPECT_EQ(reply ? reply->status : 0, expected) << path;
        return reply ? reply->body : "";
    }
    void end(int signal) {
        running_->signal(signal);
        result_ = running_->wait(20);
    }
    std::string key_;
    std::unique_ptr<RunningCommand> running_;
    std::unique_ptr<httplib::Client> client_;
    CommandResult result_;
    int port_ = 0;
};

const json screen{{"gamma", 2.2}, {"pixels_per_cm", 40}, {"distance_cm", 60}, {"device_pixel_ratio", 1}};

TEST(StudyCommand, ServesAThresholdStudyThroughAKillAndExportsIt) {
    const ScratchFolder scratch;
    const std::string folder = scratch / "study";
    ASSERT_EQ(run_gnomon({"study", "prepare", folder, "--kind", "threshold"}).status, 0);
    EXPECT_EQ(run_gnomon({"study", "prepare", folder, "--kind", "threshold"}).status, 2)
        << "answers belong to what was shown";
    std::string token;
    {
        Server server(folder);
        ASSERT_GT(server.port_, 0) << server.running_->said();
        expect_has(server.get("/"), {"A study of shadows", "Is the original image a line?"});
        token = server.post("/api/begin", {{"screen", screen}}).at("token");
        EXPECT_EQ(token.size(), 32U);
        for (int i = 0; i < 5; ++i) {
            server.post("/api/answer", {{"token", token}, {"position", i}, {"line", i % 2 == 0}});
        }
        EXPECT_TRUE(server.get("/api/picture?position=5&token=" + token).starts_with("\x89PNG"));
        server.end(SIGKILL);
    }
    Server server(folder);
    EXPECT_EQ(json::parse(server.get("/api/state?token=" + token)).at("position"), 5);
    // Refusals reach the visitor as JSON with a sentence; too much is not even read.
    server.post("/api/answer", {{"token", token}, {"position", 4}, {"line", true}}, 409);
    server.post("/api/answer", {{"token", "nobody"}, {"position", 5}, {"line", true}}, 403);
    const auto large = server.client_->Post("/api/answer", std::string(1 << 20, 'x'), "application/json");
    EXPECT_TRUE(!large || large->status == 413);
    server.get("/api/admin?key=wrong", 403);
    expect_has(server.get("/admin?key=" + server.key_), {"administrator"});
    EXPECT_EQ(json::parse(server.get("/api/admin?key=" + server.key_)).at("people").at(0).at("answers"), 5);
    // A second server does not share its port.
    const CommandResult second = run_gnomon({"study", "serve", folder, "--port", std::to_string(server.port_)});
    EXPECT_EQ(second.status, 2) << second.out;
    expect_has(second.err, {"--port", "cannot be listened on"});
    // It asks browsers to let nobody else in.
    const auto page = server.client_->Get("/");
    EXPECT_NE(page->get_header_value("Content-Security-Policy").find("default-src 'none'"), std::string::npos);
    EXPECT_EQ(page->get_header_value("Cache-Control"), "no-store");
    httplib::Headers foreign{{"Host", "evil.example"}};
    EXPECT_EQ(server.client_->Get("/", foreign)->status, 421);
    server.end(SIGTERM);
    EXPECT_EQ(server.result_.status, 0) << server.result_.err;
    // What was answered.
    const std::string csv = run_gnomon({"study", "export", folder}).out;
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6) << csv;
    const CommandResult results = run_gnomon({"study", "analyse", folder, "--json", "-"});
    EXPECT_EQ(json::parse(results.out).at("participants"), 1) << results.err;
}

TEST(StudyCommand, ASurveysPicturesAreDrawnByTheCommand) {
    const ScratchFolder scratch;
    scratch.write(
        "two.toml",
        "title = \"Two\"\nsamples = 1\nsize = \"48x32\"\n[[grid]]\nscene = \"contact\"\nrecipe = \"{technique}\"\n"
        "[[grid.axis]]\nname = \"technique\"\nvalues = [\"none\", \"hard\"]\n");
    const std::string folder = scratch / "survey";
    const CommandResult prepared = run_gnomon({"study", "prepare", folder, "--sweep", scratch / "two.toml"});
    ASSERT_EQ(prepared.status, 0) << prepared.err;
    const json plan = json::parse(file_text(folder + "/study.json"));
    ASSERT_EQ(plan.at("pages").size(), 1U);
    std::string names;
    for (const json& picture : plan.at("pages").at(0).at("pictures")) {
        names += picture.at("name").get<std::string>() + " ";
        EXPECT_TRUE(file_text(folder + "/" + picture.at("file").get<std::string>()).starts_with("\x89PNG"));
    }
    EXPECT_EQ(names, "none hard reference ");
}

TEST(StudyCommand, MisuseIsASentence) {
    const ScratchFolder scratch;
    const auto misuse = [](const std::vector<std::string>& words, const std::vector<std::string>& parts) {
        const CommandResult result = run_gnomon(words);
        EXPECT_EQ(result.status, 2) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        expect_has(result.err, parts);
    };
    misuse({"study", "begin", "x"}, {"begin", "prepare"});
    misuse({"study", "serve", scratch / "nowhere"}, {"study.json", "prepare"});
    misuse({"study", "prepare", scratch / "x", "--kind", "poll"}, {"survey", "threshold"});
    misuse({"study", "prepare", scratch / "x", "--sweep", "sambeek-performance"}, {"12 recipes"});
}

}  // namespace
}  // namespace gn
