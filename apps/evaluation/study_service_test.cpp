// SPDX-License-Identifier: MIT
// Whole sessions of both studies without a socket, requests that are refused, and a server that is killed.
#include "apps/evaluation/study_service.h"

#include "apps/evaluation/study_analysis.h"
#include "base/error.h"
#include "tests/thorough.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <random>

namespace gn::study_service_test {
namespace {

using nlohmann::json;

constexpr const char* key = "0123456789abcdef0123456789abcdef";

std::filesystem::path study_folder(const std::string& name, const StudyPlan& plan) {
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("gnomon-study-{}-{}", getpid(), name);
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "study.json") << plan_text(plan);
    for (const SurveyPage& page : plan.pages) {
        for (const SurveyPicture& picture : page.pictures) {
            std::ofstream(folder / picture.file) << "picture of " << page.name << " " << picture.name;
        }
    }
    return folder;
}

StudyPlan small_survey() {
    StudyPlan plan;
    for (const char* scene : {"car", "island", "boxes"}) {
        SurveyPage page{scene, {}};
        for (const char* name : {"SSM", "VSM", "reference"}) {
            page.pictures.push_back({name, fmt::format("{}-{}.png", scene, name)});
        }
        plan.pages.push_back(page);
    }
    return plan;
}

StudyPlan small_threshold() {
    StudyPlan plan;
    plan.kind = StudyKind::threshold;
    plan.artifacts = {10};
    plan.contrasts = {1};
    plan.picture_size = 64;
    return plan;
}

const json good_screen{{"gamma", 2.2}, {"pixels_per_cm", 40}, {"distance_cm", 60}, {"device_pixel_ratio", 1}};

/// A study and its visitors.
class Visitor {
  public:
    explicit Visitor(const std::filesystem::path& folder) : service(folder, key, {"<p>", "<a>"}, {"127.0.0.1:8080"}) {}
    StudyReply get(const std::string& path, std::map<std::string, std::string> query = {}) {
        return service.handle({"GET", path, "", "", "127.0.0.1:8080", std::move(query)});
    }
    StudyReply post(const std::string& path, const json& body) {
        return service.handle({"POST", path, body.dump(), "application/json", "127.0.0.1:8080", {}});
    }
    std::string begin(const json& body = json::object()) {
        const StudyReply reply = post("/api/begin", body);
        EXPECT_EQ(reply.status, 200) << reply.body;
        return json::parse(reply.body).value("token", "");
    }
    json state(const std::string& token) { return json::parse(get("/api/state", {{"token", token}}).body); }
    std::string picture(const std::string& token, int position, int slot = 0) {
        return get("/api/picture",
                   {{"token", token}, {"position", std::to_string(position)}, {"slot", std::to_string(slot)}})
            .body;
    }
    StudyService service;
};

/// Ranks by what the pictures show, which a person would do with their eyes.
json honest_answer(Visitor& visitor, const std::string& token, int position) {
    json answer{{"token", token}, {"position", position}, {"difficulty", 4}, {"ranks", json::array()}, {"best", 0}};
    for (int slot = 0; slot < 3; ++slot) {
        const std::string seen = visitor.picture(token, position, slot);
        const int rank = seen.ends_with("VSM") ? 9 : seen.ends_with("reference") ? 6 : 2;
        answer["ranks"].push_back(rank);
        if (rank == 9) {
            answer["best"] = slot;
        }
    }
    return answer;
}

TEST(Survey, IsAnsweredPageByPageAndAnalysed) {
    const StudyPlan plan = small_survey();
    const auto folder = study_folder("survey", plan);
    Visitor visitor(folder);
    std::set<std::string> first_pictures;
    for (int person = 0; person < 12; ++person) {
        const std::string token = visitor.begin();
        for (int page = 0; page < 3; ++page) {
            EXPECT_EQ(visitor.state(token).at("position"), page);
            first_pictures.insert(visitor.picture(token, page, 0));
            json answer = honest_answer(visitor, token, page);
            answer["comment"] = "=cmd, \"quoted\"";
            const StudyReply reply = visitor.post("/api/answer", answer);
            ASSERT_EQ(reply.status, 200) << reply.body;
        }
        EXPECT_EQ(visitor.state(token).at("done"), true);
    }
    EXPECT_GT(first_pictures.size(), 4U) << "pages and pictures come in random order";
    StudyStore store(folder / "answers.sqlite");
    const auto all = study_results(plan, store).at("rankings").at(0);
    EXPECT_EQ(all.at("order").at(0).at("name"), "VSM");
    EXPECT_DOUBLE_EQ(all.at("order").at(0).at("mean_rank"), 1.0);
    EXPECT_DOUBLE_EQ(all.at("order").at(2).at("mean_rank"), 8.0) << "2 on the screen is 8 on paper";
    EXPECT_EQ(all.at("subsets").size(), 3U) << "all twelve agree";
    // A line a rank, with both directions.
    const std::string csv = study_csv(plan, store);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 12 * 3 * 3);
    EXPECT_NE(csv.find(",VSM,9,1,4,"), std::string::npos) << csv.substr(0, 300);
    EXPECT_NE(csv.find("\"'=cmd, \"\"quoted\"\"\""), std::string::npos) << "no formula for spreadsheets";
    EXPECT_NE(study_text(study_results(plan, store)).find("VSM"), std::string::npos);
}

TEST(Survey, RefusesWhatMakesNoSenseAndLosesNothing) {
    const auto folder = study_folder("refusals", small_survey());
    Visitor visitor(folder);
    const std::string token = visitor.begin(), other = visitor.begin();
    const json good = honest_answer(visitor, token, 0);
    const auto refused = [&](const char* name, const json& value, int status) {
        json wrong = good;
        wrong[name] = value;
        const StudyReply reply = visitor.post("/api/answer", wrong);
        EXPECT_EQ(reply.status, status) << name << " " << value << ": " << reply.body;
        EXPECT_TRUE(json::parse(reply.body).at("error").is_string());
    };
    refused("token", "", 403);
    refused("token", "' OR 1=1 --", 403);
    refused("token", 7, 403);
    refused("position", 1, 409);
    refused("position", -1, 400);
    refused("position", "0", 400);
    refused("ranks", json::array({9, 6}), 422);
    refused("ranks", json::array({0, 6, 9}), 422);
    refused("ranks", json::array({10, 6, 9}), 422);
    refused("ranks", json::array({9.5, 6, 9}), 422);
    refused("ranks", json::array({"9", 6, 9}), 422);
    refused("ranks", nullptr, 422);
    refused("difficulty", 0, 422);
    refused("difficulty", nullptr, 422);
    refused("best", 3, 422);
    refused("comment", std::string(3000, 'x'), 422);
    // Ranks the wrong way round do not agree with the picture that is best.
    json turned = good;
    for (json& rank : turned["ranks"]) {
        rank = 10 - rank.get<int>();
    }
    EXPECT_EQ(visitor.post("/api/answer", turned).status, 422);
    // Malformed, oversized, of a wrong type, under a wrong name, elsewhere.
    const auto raw = [&](const std::string& method, const std::string& path, const std::string& body,
                         const std::string& type, const std::string& host) {
        return visitor.service.handle({method, path, body, type, host, {}}).status;
    };
    const std::string here = "127.0.0.1:8080", type = "application/json";
    EXPECT_EQ(raw("POST", "/api/answer", "{", type, here), 400);
    EXPECT_EQ(raw("POST", "/api/answer", "[1]", type, here), 400);
    EXPECT_EQ(raw("POST", "/api/answer", std::string(100'000, '['), type, here), 413);
    EXPECT_EQ(raw("POST", "/api/answer", std::string(10'000, '['), type, here), 400);
    EXPECT_EQ(raw("POST", "/api/answer", "\xFF\xFE{}", type, here), 400);
    EXPECT_EQ(raw("POST", "/api/answer", good.dump(), "text/plain", here), 415);
    EXPECT_EQ(raw("POST", "/api/answer", good.dump(), type, "evil.example:8080"), 421);
    EXPECT_EQ(raw("GET", "/../answers.sqlite", "", "", here), 404);
    EXPECT_EQ(raw("DELETE", "/api/answer", "", "", here), 404);
    EXPECT_EQ(visitor.get("/api/picture", {{"token", token}, {"position", "0"}, {"slot", "3"}}).status, 404);
    EXPECT_EQ(visitor.get("/api/picture", {{"token", token}, {"position", "1"}, {"slot", "0"}}).status, 409);
    EXPECT_EQ(visitor.get("/api/picture", {{"token", token}, {"position", "x"}, {"slot", "0"}}).status, 400);
    for (const char* path : {"/admin", "/api/admin", "/api/admin/export"}) {
        EXPECT_EQ(visitor.get(path).status, 403);
        EXPECT_EQ(visitor.get(path, {{"key", token}}).status, 403);
        EXPECT_EQ(visitor.get(path, {{"key", key}}).status, 200);
    }
    // After all that the good answer is taken, once.
    EXPECT_EQ(visitor.state(token).at("position"), 0);
    EXPECT_EQ(visitor.post("/api/answer", good).status, 200);
    EXPECT_EQ(visitor.post("/api/answer", good).status, 409) << "repeated";
    EXPECT_EQ(visitor.state(other).at("position"), 0) << "another's session is as it was";
    // No answer can be read by a participant, another's least of all.
    const std::string seen = visitor.get("/api/state", {{"token", token}}).body;
    EXPECT_EQ(seen.find("VSM"), std::string::npos);
    EXPECT_EQ(seen.find("ranks"), std::string::npos);
}

/// Says what an observer would whose threshold is c artifacts: the trial itself is read from the study's folder, as their eyes
/// read it from the screen.
json observed(const StudyPlan& plan, StudyStore& store, const std::string& token, double c, std::mt19937_64& random) {
    const Participant person = store.find(token).value();
    const ThresholdState state = threshold_state(
        plan, person.seed, read_screen(json::parse(person.details).at("screen")), store.answers(person.id));
    const Stimulus& shown = state.next->stimulus;
    const double x = -std::log10(shown.radius / shown.artifact);
    const bool right = static_cast<double>(random() >> 11U) * 0x1p-53 < psychometric({}, x, -std::log10(c));
    return {{"token", token}, {"position", state.answered}, {"line", right == shown.line}};
}

TEST(Threshold, SessionsConvergeAndTheFitFindsThePlantedConstant) {
    const StudyPlan plan = small_threshold();
    const auto folder = study_folder("threshold", plan);
    Visitor visitor(folder);
    StudyStore store(folder / "answers.sqlite");
    std::mt19937_64 random(5);
    // Every request goes through all answers anew, which sanitizers make slow.
    const int people = test::sanitized && !test::thorough() ? 1 : 4;
    int lines = 0, trials = 0;
    for (int person = 0; person < people; ++person) {
        const std::string token = visitor.begin({{"screen", good_screen}});
        while (!visitor.state(token).at("done").get<bool>()) {
            const json answer = observed(plan, store, token, 3.2, random);
            ASSERT_EQ(visitor.post("/api/answer", answer).status, 200);
            ++trials;
        }
        EXPECT_EQ(visitor.post("/api/answer", {{"token", token}, {"position", 0}, {"line", true}}).status, 409);
        EXPECT_EQ(visitor.state(token).at("round"), 2) << "step and stair";
    }
    for (const Participant& person : store.participants()) {
        for (const std::string& answer : store.answers(person.id)) {
            lines += json::parse(answer).at("line").get<bool>() ? 1 : 0;
        }
    }
    // Half of the trials are lines: within four deviations of a fair coin.
    EXPECT_NEAR(lines, 0.5 * trials, 4 * 0.5 * std::sqrt(trials));
    const auto results = study_results(plan, store);
    EXPECT_EQ(results.at("finished"), people);
    for (const auto& condition : results.at("conditions")) {
        // Thresholds are sure to a tenth each; participants differ from run to run: five deviations of their mean.
        EXPECT_NEAR(condition.at("c").get<double>(), 3.2, 5 * 0.1 / std::sqrt(people) * 3.2) << condition.dump();
    }
    EXPECT_GE(results.at("conditions").at(0).at("c"), results.at("conditions").at(1).at("c")) << "the worst case first";
    const std::string csv = study_csv(plan, store);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + trials);
    EXPECT_NE(study_text(results).find("stair, contrast 100 %"), std::string::npos);
}

TEST(Threshold, ShowsThePixelsOfTheOpenTrialAndTellsNothingOfIt) {
    const auto folder = study_folder("trial", small_threshold());
    Visitor visitor(folder);
    for (const auto& [name, value] : std::map<std::string, json>{
             {"gamma", 9}, {"pixels_per_cm", 0}, {"distance_cm", "60"}, {"device_pixel_ratio", nullptr}}) {
        json screen = good_screen;
        screen[name] = value;
        EXPECT_EQ(visitor.post("/api/begin", {{"screen", screen}}).status, 422) << name;
    }
    EXPECT_EQ(visitor.post("/api/begin", json::object()).status, 422);
    const std::string token = visitor.begin({{"screen", good_screen}});
    EXPECT_TRUE(visitor.picture(token, 0).starts_with("\x89PNG"));
    EXPECT_EQ(visitor.get("/api/picture", {{"token", token}, {"position", "1"}}).status, 409);
    const json state = visitor.state(token);
    EXPECT_EQ(state.size(), 6U) << state.dump();
    EXPECT_FALSE(state.contains("radius") || state.contains("line"));
    EXPECT_EQ(visitor.post("/api/answer", {{"token", token}, {"position", 0}, {"line", "yes"}}).status, 422);
    // A restart shows the same trial.
    const std::string before = visitor.picture(token, 0);
    Visitor again(folder);
    EXPECT_EQ(again.picture(token, 0), before);
}

TEST(Threshold, AKilledServerLosesNoAnsweredTrial) {
    const StudyPlan plan = small_threshold();
    const auto folder = study_folder("killed", plan);
    std::string token;
    {
        Visitor visitor(folder);
        token = visitor.begin({{"screen", good_screen}});
    }
    int acknowledged = 0;
    for (int round = 0; round < 20; ++round) {
        int ends[2];
        ASSERT_EQ(pipe(ends), 0);
        const pid_t server = fork();
        if (server == 0) {
            close(ends[0]);
            Visitor visitor(folder);
            for (int position = visitor.state(token).at("position"); position < 300; ++position) {
                // Wrong answers as often as right ones: the session goes on for long.
                const StudyReply reply = visitor.post(
                    "/api/answer", {{"token", token}, {"position", position}, {"line", position % 2 == 0}});
                if (reply.status != 200 || write(ends[1], &position, sizeof position) != sizeof position) {
                    _exit(0);
                }
            }
            _exit(0);
        }
        close(ends[1]);
        // After one to four answers, at a moment of its own.
        int position = 0;
        for (int i = 0; i <= round % 4 && read(ends[0], &position, sizeof position) == sizeof position; ++i) {
            acknowledged = position + 1;
        }
        usleep(static_cast<useconds_t>(7'919 * round % 6'000));
        kill(server, SIGKILL);
        int state = 0;
        ASSERT_EQ(waitpid(server, &state, 0), server);
        while (read(ends[0], &position, sizeof position) == sizeof position) {
            acknowledged = position + 1;
        }
        close(ends[0]);
        Visitor visitor(folder);
        const int kept = visitor.state(token).at("position");
        EXPECT_GE(kept, acknowledged) << "an acknowledged answer is kept";
        EXPECT_LE(kept, acknowledged + 1) << "and none is doubled";
        acknowledged = kept;
    }
    EXPECT_GT(acknowledged, 20);
}

TEST(Study, PlansThatMakeNoSenseAreRefused) {
    const auto folder = study_folder("plans", small_survey());
    const auto refused = [&](const std::string& text) {
        std::ofstream(folder / "study.json") << text;
        EXPECT_THROW(read_plan(folder), Error) << text;
    };
    refused("");
    refused("{\"kind\": \"poll\"}");
    refused("{\"kind\": \"survey\", \"pages\": []}");
    refused(R"({"kind": "survey", "pages": [{"name": "a", "pictures": [{"name": "b", "file": "c"}]}]})");
    refused(
        R"({"kind": "survey", "pages": [{"name": "a", "pictures": [{"name": "b", "file": "/etc/passwd"}, {"name": "c", "file": "d"}]}]})");
    refused(
        R"({"kind": "survey", "pages": [{"name": "a", "pictures": [{"name": "b", "file": "x/../../y"}, {"name": "c", "file": "d"}]}]})");
    refused(R"({"kind": "threshold", "artifacts": [0], "contrasts": [1], "picture_size": 100})");
}

}  // namespace
}  // namespace gn::study_service_test
