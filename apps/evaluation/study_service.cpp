// SPDX-License-Identifier: MIT
#include "apps/evaluation/study_service.h"

#include "apps/evaluation/study_analysis.h"
#include "base/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

namespace gn {
namespace {

using nlohmann::json;

/// A reply that is not 200, with a sentence.
struct Denied {
    int status;
    std::string sentence;
};

StudyReply reply_of(const nlohmann::ordered_json& document) {
    return {200, "application/json", document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)};
}

/// Takes as long for a wrong key as for a right one.
bool same_secret(const std::string& a, const std::string& b) {
    unsigned difference = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < a.size() && !b.empty(); ++i) {
        difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i % b.size()]);
    }
    return difference == 0;
}

std::string asked(const StudyRequest& request, const std::string& name) {
    const auto found = request.query.find(name);
    return found == request.query.end() ? "" : found->second;
}

std::size_t index_of(const std::string& text, const std::string& name) {
    std::size_t value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || code != std::errc{} || end != text.data() + text.size() || value > 1'000'000) {
        throw Denied{400, "'" + name + "' is no index"};
    }
    return value;
}

json body_of(const StudyRequest& request) {
    // A form on another site can send a text, but not this type.
    if (!request.content_type.starts_with("application/json")) {
        throw Denied{415, "what is sent is JSON, and says so"};
    }
    if (request.body.size() > most_body_bytes) {
        throw Denied{413, "too much was sent"};
    }
    json body = json::parse(request.body, nullptr, false);
    if (body.is_discarded() || !body.is_object()) {
        throw Denied{400, "what was sent is no JSON object"};
    }
    return body;
}

std::string text_in(const json& body, const char* key) {
    const auto found = body.find(key);
    return found != body.end() && found->is_string() ? found->get<std::string>() : "";
}

/// The position that an answer or picture is of must be the one that is open.
void check_position(std::size_t position, std::size_t open, bool done) {
    if (done) {
        throw Denied{409, "all questions are answered"};
    }
    if (position != open) {
        throw Denied{409, fmt::format("question {} is open, not {}", open + 1, position + 1)};
    }
}

}  // namespace

StudyService::StudyService(const std::filesystem::path& folder, std::string admin_key, StudyPages pages,
                           std::vector<std::string> hosts)
    : folder_(folder),
      plan_(read_plan(folder)),
      store_(folder / "answers.sqlite"),
      admin_key_(std::move(admin_key)),
      pages_(std::move(pages)),
      hosts_(std::move(hosts)) {}

StudyReply StudyService::handle(const StudyRequest& request) {
    const std::lock_guard lock(mutex_);
    const auto denied = [](int status, const std::string& sentence) {
        StudyReply reply = reply_of({{"error", sentence}});
        reply.status = status;
        return reply;
    };
    try {
        return answer_to(request);
    } catch (const Denied& reason) {
        return denied(reason.status, reason.sentence);
    } catch (const Error& error) {
        // What a participant sent makes no sense; the sentence says what would.
        return denied(422, error.what());
    } catch (const std::exception&) {
        return denied(500, "the server failed; nothing that was answered is lost");
    }
}

StudyReply StudyService::answer_to(const StudyRequest& request) {
    if (std::find(hosts_.begin(), hosts_.end(), request.host) == hosts_.end()) {
        throw Denied{421, "this server is not called so"};
    }
    const bool get = request.method == "GET", post = request.method == "POST";
    if (get && request.path == "/") {
        return {200, "text/html; charset=utf-8", pages_.participant};
    }
    if (request.path == "/admin" || request.path.starts_with("/api/admin")) {
        return administrate(request);
    }
    if (get && request.path == "/api/kind") {
        return reply_of({{"kind", plan_.kind == StudyKind::survey ? "survey" : "threshold"}});
    }
    if (post && request.path == "/api/begin") {
        return begin(request);
    }
    if (get && request.path == "/api/state") {
        return state(participant_of(request, asked(request, "token")));
    }
    if (get && request.path == "/api/picture") {
        return picture(participant_of(request, asked(request, "token")), request);
    }
    if (post && request.path == "/api/answer") {
        return take(participant_of(request, text_in(body_of(request), "token")), request);
    }
    throw Denied{404, "there is nothing here"};
}

Participant StudyService::participant_of(const StudyRequest&, const std::string& token) {
    const auto found = store_.find(token);
    if (!found) {
        throw Denied{403, "this session is not known"};
    }
    return *found;
}

Screen StudyService::screen_of(const Participant& participant) const {
    const json details = json::parse(participant.details, nullptr, false);
    return plan_.kind == StudyKind::threshold ? read_screen(details.at("screen")) : Screen{};
}

StudyReply StudyService::begin(const StudyRequest& request) {
    const json body = body_of(request);
    if (store_.participants().size() >= most_participants) {
        throw Denied{503, "this study has as many participants as it takes"};
    }
    json details = json::object();
    if (plan_.kind == StudyKind::threshold) {
        const Screen screen = read_screen(body.value("screen", json()));
        details["screen"] = {{"gamma", screen.gamma},
                             {"pixels_per_cm", screen.pixels_per_cm},
                             {"distance_cm", screen.distance_cm},
                             {"device_pixel_ratio", screen.device_pixel_ratio}};
    }
    const std::string token = random_token();
    store_.begin(token, random_seed(), details.dump());
    return reply_of({{"token", token}});
}

StudyReply StudyService::state(const Participant& participant) {
    const std::vector<std::string> answers = store_.answers(participant.id);
    if (plan_.kind == StudyKind::survey) {
        const SurveyState state = survey_state(plan_, participant.seed, answers.size());
        return reply_of({{"kind", "survey"},
                         {"position", state.answered},
                         {"total", plan_.pages.size()},
                         {"done", state.done(plan_)},
                         {"pictures", state.slots.size()}});
    }
    const ThresholdState state = threshold_state(plan_, participant.seed, screen_of(participant), answers);
    // Neither the radius nor what the trial is: they are nobody's business but the administrator's.
    return reply_of({{"kind", "threshold"},
                     {"position", state.answered},
                     {"done", !state.next},
                     {"round", state.next ? state.next->round + 1 : state.rounds.size()},
                     {"rounds", state.rounds.size()},
                     {"size", plan_.picture_size}});
}

StudyReply StudyService::take(const Participant& participant, const StudyRequest& request) {
    const json body = body_of(request);
    const auto position = body.find("position");
    if (position == body.end() || !position->is_number_unsigned()) {
        throw Denied{400, "'position' is missing"};
    }
    const std::vector<std::string> answers = store_.answers(participant.id);
    std::string document;
    if (plan_.kind == StudyKind::survey) {
        const SurveyState state = survey_state(plan_, participant.seed, answers.size());
        check_position(position->get<std::size_t>(), state.answered, state.done(plan_));
        document = survey_answer(plan_, state, body);
    } else {
        const ThresholdState state = threshold_state(plan_, participant.seed, screen_of(participant), answers);
        check_position(position->get<std::size_t>(), state.answered, !state.next);
        document = threshold_answer(*state.next, body);
    }
    // On the disk before the participant hears of it.
    if (!store_.add(participant.id, static_cast<int>(answers.size()), document)) {
        throw Denied{409, "this question was answered already"};
    }
    return state(participant);
}

StudyReply StudyService::picture(const Participant& participant, const StudyRequest& request) {
    const std::vector<std::string> answers = store_.answers(participant.id);
    const std::size_t position = index_of(asked(request, "position"), "position");
    if (plan_.kind == StudyKind::threshold) {
        const ThresholdState state = threshold_state(plan_, participant.seed, screen_of(participant), answers);
        check_position(position, state.answered, !state.next);
        const std::vector<std::byte> png = encode_png(draw(state.next->stimulus, plan_.picture_size));
        return {200, "image/png", std::string(reinterpret_cast<const char*>(png.data()), png.size())};
    }
    const SurveyState state = survey_state(plan_, participant.seed, answers.size());
    check_position(position, state.answered, state.done(plan_));
    const std::size_t slot = index_of(asked(request, "slot"), "slot");
    if (slot >= state.slots.size()) {
        throw Denied{404, "there is no such picture"};
    }
    std::ifstream stream(folder_ / plan_.pages[state.page].pictures[state.slots[slot]].file, std::ios::binary);
    std::stringstream bytes;
    bytes << stream.rdbuf();
    if (!stream || bytes.str().empty()) {
        throw Denied{500, "a picture of the study is gone"};
    }
    return {200, "image/png", bytes.str()};
}

StudyReply StudyService::administrate(const StudyRequest& request) {
    if (request.method != "GET" || !same_secret(asked(request, "key"), admin_key_)) {
        throw Denied{403, "the administrator's key is in what 'gnomon study serve' printed"};
    }
    if (request.path == "/admin") {
        return {200, "text/html; charset=utf-8", pages_.administrator};
    }
    if (request.path == "/api/admin") {
        return reply_of(admin_json(plan_, store_));
    }
    if (request.path == "/api/admin/export") {
        return {200, "text/csv; charset=utf-8", study_csv(plan_, store_)};
    }
    throw Denied{404, "there is nothing here"};
}

}  // namespace gn
