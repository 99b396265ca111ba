// SPDX-License-Identifier: MIT
#include "apps/evaluation/study_plan.h"

#include "base/error.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <sstream>

namespace gn {
namespace {

using nlohmann::ordered_json;

StudyPlan plan_from(const ordered_json& data, const std::string& where) {
    StudyPlan plan;
    const std::string kind = data.at("kind");
    if (kind != "survey" && kind != "threshold") {
        fail("{}: kind '{}'; valid are survey, threshold", where, kind);
    }
    plan.kind = kind == "survey" ? StudyKind::survey : StudyKind::threshold;
    if (plan.kind == StudyKind::threshold) {
        plan.artifacts = data.at("artifacts").get<std::vector<double>>();
        plan.contrasts = data.at("contrasts").get<std::vector<double>>();
        plan.picture_size = data.at("picture_size");
        const auto within = [](const std::vector<double>& values, double low, double high) {
            return !values.empty() && std::all_of(values.begin(), values.end(),
                                                  [&](double value) { return value >= low && value <= high; });
        };
        if (!within(plan.artifacts, 1, 100) || !within(plan.contrasts, 0.01, 1) || plan.picture_size < 64 ||
            plan.picture_size > 2048) {
            fail("{}: artifacts are 1 to 100 pixels, contrasts 0.01 to 1, picture_size 64 to 2048", where);
        }
        return plan;
    }
    for (const ordered_json& page : data.at("pages")) {
        SurveyPage one{page.at("name"), {}};
        for (const ordered_json& picture : page.at("pictures")) {
            one.pictures.push_back({picture.at("name"), picture.at("file")});
            // Files are those of the folder, whoever wrote the plan.
            const std::filesystem::path file = one.pictures.back().file;
            if (file.is_absolute() || file.lexically_normal().native().starts_with("..")) {
                fail("{}: the picture '{}' is not inside the study's folder", where, file.string());
            }
        }
        if (one.pictures.size() < 2 || one.pictures.size() > 9) {
            fail("{}: page '{}' has {} pictures; two to nine can be ranked", where, one.name, one.pictures.size());
        }
        plan.pages.push_back(std::move(one));
    }
    if (plan.pages.empty()) {
        fail("{}: a survey needs a page", where);
    }
    return plan;
}

}  // namespace

StudyPlan read_plan(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / "study.json";
    std::ifstream stream(path);
    if (!stream) {
        fail("{}: cannot be read; 'gnomon study prepare {}' makes it", path.string(), folder.string());
    }
    std::stringstream text;
    text << stream.rdbuf();
    try {
        return plan_from(ordered_json::parse(text.str()), path.string());
    } catch (const nlohmann::json::exception& error) {
        fail("{}: {}", path.string(), error.what());
    }
}

std::string plan_text(const StudyPlan& plan) {
    ordered_json data{{"kind", plan.kind == StudyKind::survey ? "survey" : "threshold"}};
    if (plan.kind == StudyKind::threshold) {
        data["artifacts"] = plan.artifacts;
        data["contrasts"] = plan.contrasts;
        data["picture_size"] = plan.picture_size;
    } else {
        data["pages"] = ordered_json::array();
        for (const SurveyPage& page : plan.pages) {
            ordered_json pictures = ordered_json::array();
            for (const SurveyPicture& picture : page.pictures) {
                pictures.push_back({{"name", picture.name}, {"file", picture.file}});
            }
            data["pages"].push_back({{"name", page.name}, {"pictures", pictures}});
        }
    }
    return data.dump(1) + "\n";
}

}  // namespace gn
