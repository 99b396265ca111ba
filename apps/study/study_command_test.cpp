// SPDX-License-Identifier: MIT
// gnomon study from outside: a server behind its socket, killed and started again, and what its answers become.
#include "apps/subprocess_test.h"
#include "tests/thorough.h"

#include <gtest/gtest.h>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <chrono>
#include <csignal>
#include <memory>
#include <random>
#include <regex>
#include <sstream>
#include <thread>

namespace gn::study_command_test {
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

/// One participant, and what the server has acknowledged of their answers.
struct Taken {
    std::string token;
    int acknowledged = 0;
    bool done = false;
};

/// What is answered at a position, so that each kept answer can be told from its neighbours.
bool said_at(int position) {
    return (static_cast<unsigned>(position) * 2654435761U >> 16U) % 2 == 0;
}

/// Answers as fast as the server takes it, until it is gone or asks nothing more; `begun` is set with the first answer that it took.
void answer_until_gone(const Server& server, Taken& taken, std::atomic<bool>& begun) {
    httplib::Client client("127.0.0.1", server.port_);
    while (!taken.done) {
        const json body{
            {"token", taken.token}, {"position", taken.acknowledged}, {"line", said_at(taken.acknowledged)}};
        const auto reply = client.Post("/api/answer", body.dump(), "application/json");
        if (!reply) {
            begun = true;
            return;
        }
        ASSERT_EQ(reply->status, 200) << reply->body;
        ++taken.acknowledged;
        begun = true;
        taken.done = json::parse(reply->body).at("done");
    }
}

TEST(StudyCommand, LosesAndDoublesNoAnswerWhenItIsKilledAtRandomMoments) {
    const ScratchFolder scratch;
    const std::string folder = scratch / "study";
    ASSERT_EQ(run_gnomon({"study", "prepare", folder, "--kind", "threshold"}).status, 0);
    constexpr unsigned seed = 7;
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> moment(1, 120);
    const int kills = test::thorough() ? 20 : 2;
    std::vector<Taken> people;
    for (int kill = 0; kill < kills; ++kill) {
        Server server(folder);
        ASSERT_GT(server.port_, 0) << server.running_->said();
        if (people.empty() || people.back().done) {
            people.push_back({server.post("/api/begin", {{"screen", screen}}).at("token"), 0, false});
        }
        std::atomic<bool> begun = false;
        std::thread answering([&] { answer_until_gone(server, people.back(), begun); });
        // The first is killed once it has taken an answer, however slow the machine; the others whenever it comes.
        for (const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
             kill == 0 && !begun && std::chrono::steady_clock::now() < end;) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        const int milliseconds = moment(random);
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        server.end(SIGKILL);
        answering.join();
        // Every acknowledged answer is there; one more may be, which the kill kept from being acknowledged.
        Server after(folder);
        for (Taken& taken : people) {
            const int kept = json::parse(after.get("/api/state?token=" + taken.token)).at("position");
            EXPECT_GE(kept, taken.acknowledged)
                << "lost, kill " << kill << " after " << milliseconds << " ms, seed " << seed;
            EXPECT_LE(kept, taken.acknowledged + (taken.done ? 0 : 1)) << "doubled, kill " << kill;
            taken.acknowledged = kept;
        }
        after.end(SIGTERM);
    }
    // What is kept is what was said, each position once, in order.
    std::stringstream csv(run_gnomon({"study", "export", folder}).out);
    std::string line;
    std::getline(csv, line);
    for (std::size_t person = 0; person < people.size(); ++person) {
        for (int position = 0; position < people[person].acknowledged; ++position) {
            ASSERT_TRUE(std::getline(csv, line));
            EXPECT_TRUE(line.starts_with(std::to_string(person + 1) + "," + std::to_string(position) + ",")) << line;
            std::vector<std::string> fields;
            std::stringstream words(line);
            for (std::string field; std::getline(words, field, ',');) {
                fields.push_back(field);
            }
            EXPECT_EQ(fields.at(7), said_at(position) ? "true" : "false") << line;
        }
    }
    EXPECT_FALSE(std::getline(csv, line)) << line;
    EXPECT_GT(people.front().acknowledged, 0) << "the server was killed before anything was answered";
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
}  // namespace gn::study_command_test
