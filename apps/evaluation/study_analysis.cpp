// SPDX-License-Identifier: MIT
#include "apps/evaluation/study_analysis.h"

#include "apps/evaluation/csv.h"
#include "base/error.h"
#include "base/stats.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace gn {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

Screen screen_in(const Participant& participant) {
    return read_screen(json::parse(participant.details).at("screen"));
}

/// The kept answers of a survey's participant, as JSON.
std::vector<json> pages_of(StudyStore& store, const Participant& participant) {
    std::vector<json> pages;
    for (const std::string& text : store.answers(participant.id)) {
        pages.push_back(json::parse(text));
    }
    return pages;
}

/// Ranks on paper: 1 is the best. Difficulty is the weight: who hardly saw a difference says little.
struct Rows {
    std::vector<std::vector<double>> ranks;
    std::vector<double> weights;
};

std::vector<double> paper_ranks(const json& answer, const std::vector<std::string>& names) {
    std::vector<double> ranks;
    for (const std::string& name : names) {
        ranks.push_back(10.0 - answer.at("ranks").at(name).get<double>());
    }
    return ranks;
}

std::vector<std::string> names_of(const SurveyPage& page) {
    std::vector<std::string> names;
    for (const SurveyPicture& picture : page.pictures) {
        names.push_back(picture.name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

Rows rows_of_page(const StudyPlan&, StudyStore& store, const SurveyPage& page) {
    Rows rows;
    for (const Participant& participant : store.participants()) {
        for (const json& answer : pages_of(store, participant)) {
            if (answer.at("page") == page.name) {
                rows.ranks.push_back(paper_ranks(answer, names_of(page)));
                rows.weights.push_back(answer.at("difficulty"));
            }
        }
    }
    return rows;
}

/// A row a participant: the weighted mean of their pages, for answers of one person are not independent.
Rows rows_of_people(StudyStore& store, const std::vector<std::string>& names) {
    Rows rows;
    for (const Participant& participant : store.participants()) {
        std::vector<double> sums(names.size(), 0.0);
        double weight = 0;
        for (const json& answer : pages_of(store, participant)) {
            const double difficulty = answer.at("difficulty");
            const std::vector<double> ranks = paper_ranks(answer, names);
            for (std::size_t i = 0; i < sums.size(); ++i) {
                sums[i] += difficulty * ranks[i];
            }
            weight += difficulty;
        }
        if (weight > 0) {
            for (double& sum : sums) {
                sum /= weight;
            }
            rows.ranks.push_back(sums);
            rows.weights.push_back(weight);
        }
    }
    return rows;
}

ordered_json ranking_json(const std::string& name, const std::vector<std::string>& names, const Rows& rows) {
    const Ranking ranking = rank_techniques(names, rows.ranks, rows.weights);
    ordered_json order = ordered_json::array(), subsets = ordered_json::array(), pairs = ordered_json::array();
    for (const Placed& placed : ranking.order) {
        order.push_back({{"name", placed.name}, {"mean_rank", placed.mean}});
    }
    for (const auto& [first, last] : ranking.subsets) {
        ordered_json subset = ordered_json::array();
        for (std::size_t i = first; i <= last; ++i) {
            subset.push_back(ranking.order[i].name);
        }
        subsets.push_back(subset);
    }
    for (std::size_t i = 0; i < ranking.order.size(); ++i) {
        for (std::size_t j = i + 1; j < ranking.order.size(); ++j) {
            const PairedT& test = ranking.pairs[i][j];
            // JSON has no infinity; where all differ alike t is absent and p is 0.
            pairs.push_back({{"a", ranking.order[i].name},
                             {"b", ranking.order[j].name},
                             {"difference", test.difference},
                             {"low", test.low},
                             {"high", test.high},
                             {"t", std::isfinite(test.t) ? ordered_json(test.t) : ordered_json(nullptr)},
                             {"degrees", test.degrees},
                             {"p", test.p},
                             {"differs", test.p <= ranking.level}});
        }
    }
    return {{"name", name},   {"answers", rows.ranks.size()}, {"level", ranking.level},
            {"order", order}, {"subsets", subsets},           {"pairs", pairs}};
}

ordered_json survey_results(const StudyPlan& plan, StudyStore& store) {
    ordered_json rankings = ordered_json::array();
    const std::vector<std::string> names = names_of(plan.pages.front());
    const bool alike = std::all_of(plan.pages.begin(), plan.pages.end(),
                                   [&](const SurveyPage& page) { return names_of(page) == names; });
    if (alike) {
        rankings.push_back(ranking_json("all", names, rows_of_people(store, names)));
    }
    for (const SurveyPage& page : plan.pages) {
        rankings.push_back(ranking_json(page.name, names_of(page), rows_of_page(plan, store, page)));
    }
    return {{"kind", "survey"}, {"participants", store.participants().size()}, {"rankings", rankings}};
}

/// Radii over artifacts of one pattern and contrast.
struct Condition {
    Pattern pattern;
    double contrast;
    std::vector<double> artifacts, radii;
};

ordered_json threshold_results(const StudyPlan& plan, StudyStore& store) {
    std::vector<Condition> conditions;
    std::size_t finished = 0;
    for (const Participant& participant : store.participants()) {
        const ThresholdState state =
            threshold_state(plan, participant.seed, screen_in(participant), store.answers(participant.id));
        finished += state.next ? 0 : 1;
        for (const ThresholdRound& round : state.rounds) {
            auto condition = std::find_if(conditions.begin(), conditions.end(), [&](const Condition& c) {
                return c.pattern == round.pattern && c.contrast == round.contrast;
            });
            if (condition == conditions.end()) {
                condition = conditions.insert(condition, {round.pattern, round.contrast, {}, {}});
            }
            for (std::size_t q = 0; q < round.quests.size(); ++q) {
                if (round.quests[q].converged) {
                    condition->artifacts.push_back(plan.artifacts[q]);
                    condition->radii.push_back(round.quests[q].radius);
                }
            }
        }
    }
    ordered_json list = ordered_json::array();
    for (const Condition& condition : conditions) {
        ordered_json sizes = ordered_json::array();
        for (const double artifact : plan.artifacts) {
            Running radii;
            for (std::size_t i = 0; i < condition.radii.size(); ++i) {
                if (condition.artifacts[i] == artifact) {
                    radii.add(condition.radii[i]);
                }
            }
            sizes.push_back({{"artifact", artifact},
                             {"thresholds", radii.count()},
                             {"mean_radius", radii.count() > 0 ? ordered_json(radii.mean()) : ordered_json(nullptr)},
                             {"deviation", std::sqrt(radii.variance())}});
        }
        const LineFit fit = fit_through_zero(condition.artifacts, condition.radii);
        list.push_back({{"pattern", name_of(condition.pattern)},
                        {"contrast", condition.contrast},
                        {"sizes", sizes},
                        {"thresholds", fit.count},
                        {"c", fit.c},
                        {"low", fit.low},
                        {"high", fit.high}});
    }
    // The worst case first: what hides it hides all others.
    std::stable_sort(list.begin(), list.end(),
                     [](const ordered_json& a, const ordered_json& b) { return a.at("c") > b.at("c"); });
    return {{"kind", "threshold"},
            {"participants", store.participants().size()},
            {"finished", finished},
            {"conditions", list}};
}

}  // namespace

ordered_json admin_json(const StudyPlan& plan, StudyStore& store) {
    ordered_json people = ordered_json::array();
    for (const Participant& participant : store.participants()) {
        const std::vector<std::string> answers = store.answers(participant.id);
        ordered_json person{{"participant", participant.id}, {"answers", answers.size()}};
        if (plan.kind == StudyKind::survey) {
            person["done"] = answers.size() >= plan.pages.size();
        } else {
            const ThresholdState state = threshold_state(plan, participant.seed, screen_in(participant), answers);
            person["done"] = !state.next;
            person["round"] = state.next ? state.next->round : state.rounds.size() - 1;
            person["rounds"] = ordered_json::array();
            for (const ThresholdRound& round : state.rounds) {
                ordered_json quests = ordered_json::array();
                for (std::size_t q = 0; q < round.quests.size(); ++q) {
                    const QuestTrace& trace = round.quests[q];
                    quests.push_back({{"artifact", plan.artifacts[q]},
                                      {"radii", trace.radii},
                                      {"radius", trace.radius},
                                      {"deviation", trace.deviation},
                                      {"converged", trace.converged}});
                }
                person["rounds"].push_back(
                    {{"pattern", name_of(round.pattern)}, {"contrast", round.contrast}, {"quests", quests}});
            }
        }
        people.push_back(person);
    }
    return {{"kind", plan.kind == StudyKind::survey ? "survey" : "threshold"},
            {"pages", plan.pages.size()},
            {"people", people},
            {"results", study_results(plan, store)}};
}

std::string study_csv(const StudyPlan& plan, StudyStore& store) {
    const bool survey = plan.kind == StudyKind::survey;
    const auto text_of = [](const json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); };
    std::vector<std::string> keys{"pattern", "contrast", "artifact", "radius", "line", "said_line", "right"};
    std::vector<std::string> head{"participant", "position"};
    if (survey) {
        head.insert(head.end(), {"page", "technique", "rank_9_best", "rank_1_best", "difficulty", "comment"});
    } else {
        head.insert(head.end(), keys.begin(), keys.end());
        head.insert(head.end(), {"gamma", "pixels_per_cm", "distance_cm", "device_pixel_ratio"});
    }
    std::string text = csv_line(head);
    for (const Participant& participant : store.participants()) {
        const json details = json::parse(participant.details);
        int position = 0;
        for (const std::string& kept : store.answers(participant.id)) {
            const json answer = json::parse(kept);
            const std::vector<std::string> begin{fmt::format("{}", participant.id), fmt::format("{}", position++)};
            if (survey) {
                for (const auto& [technique, rank] : answer.at("ranks").items()) {
                    std::vector<std::string> line = begin;
                    line.insert(line.end(), {answer.at("page").get<std::string>(), technique, rank.dump(),
                                             fmt::format("{}", 10 - rank.get<int>()), answer.at("difficulty").dump(),
                                             answer.at("comment").get<std::string>()});
                    text += csv_line(line);
                }
                continue;
            }
            std::vector<std::string> line = begin;
            for (const std::string& key : keys) {
                line.push_back(text_of(answer.at(key)));
            }
            for (const char* key : {"gamma", "pixels_per_cm", "distance_cm", "device_pixel_ratio"}) {
                line.push_back(details.at("screen").at(key).dump());
            }
            text += csv_line(line);
        }
    }
    return text;
}

ordered_json study_results(const StudyPlan& plan, StudyStore& store) {
    return plan.kind == StudyKind::survey ? survey_results(plan, store) : threshold_results(plan, store);
}

std::string study_text(const ordered_json& results) {
    std::string text = fmt::format("{} participants\n", results.at("participants").get<std::size_t>());
    if (results.at("kind") == "survey") {
        for (const ordered_json& ranking : results.at("rankings")) {
            text +=
                fmt::format("\n{}: {} answers, pairs differ at p <= {:.5f}\n", ranking.at("name").get<std::string>(),
                            ranking.at("answers").get<std::size_t>(), ranking.at("level").get<double>());
            for (const ordered_json& placed : ranking.at("order")) {
                text += fmt::format("  {:<24} {:5.2f}", placed.at("name").get<std::string>(),
                                    placed.at("mean_rank").get<double>());
                int number = 0;
                for (const ordered_json& subset : ranking.at("subsets")) {
                    ++number;
                    const bool within = std::find(subset.begin(), subset.end(), placed.at("name")) != subset.end();
                    text += within ? fmt::format("  {}", number) : "   ";
                }
                text += "\n";
            }
        }
        return text +
               "\nRanks are 1 (best) to 9, weighted by how easily a difference was seen; behind them the subsets that "
               "do not "
               "differ.\n";
    }
    for (const ordered_json& condition : results.at("conditions")) {
        text += fmt::format("\n{}, contrast {:.0f} %: c = {:.2f} ({:.2f} to {:.2f}), {} thresholds\n",
                            condition.at("pattern").get<std::string>(), 100 * condition.at("contrast").get<double>(),
                            condition.at("c").get<double>(), condition.at("low").get<double>(),
                            condition.at("high").get<double>(), condition.at("thresholds").get<std::size_t>());
        for (const ordered_json& size : condition.at("sizes")) {
            if (!size.at("mean_radius").is_null()) {
                text +=
                    fmt::format("  artifact {:>4} px: radius {:.1f} +- {:.1f} px\n", size.at("artifact").get<double>(),
                                size.at("mean_radius").get<double>(), size.at("deviation").get<double>());
            }
        }
    }
    return text + "\nradius = c x artifact; the worst case stands first.\n";
}

}  // namespace gn
