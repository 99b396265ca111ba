// SPDX-License-Identifier: MIT
#include "apps/notes.h"

#include "base/error.h"
#include "shadow/frame/frame.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>

namespace gn {
namespace {

constexpr std::size_t names_shown = 3;

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

/// The sentence without quoted names and numbers. A quote opens after a blank, so that an apostrophe is none.
std::string kind_of(std::string_view note) {
    std::string kind;
    for (std::size_t i = 0; i < note.size(); ++i) {
        const bool begins = i == 0 || !is_word(note[i - 1]);
        const std::size_t close = note[i] == '\'' && begins ? note.find('\'', i + 1) : std::string_view::npos;
        if (close != std::string_view::npos) {
            kind += "''";
            i = close;
        } else if (std::isdigit(static_cast<unsigned char>(note[i])) != 0) {
            kind += kind.ends_with('0') ? "" : "0";
        } else if (!(kind.ends_with('0') && (note[i] == '.' || note[i] == 'e'))) {
            kind += note[i];
        }
    }
    return kind;
}

struct Group {
    std::string kind;
    std::vector<std::string> members;
};

Group& group_of(std::vector<Group>& groups, const std::string& kind) {
    const auto found =
        std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.kind == kind; });
    return found != groups.end() ? *found : groups.emplace_back(Group{kind, {}});
}

std::string quoted_names(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), names_shown); ++i) {
        text += fmt::format("{}'{}'", i == 0 ? "" : ", ", names[i]);
    }
    return text + (names.size() > names_shown ? fmt::format(" and {} more", names.size() - names_shown) : "");
}

}  // namespace

std::vector<std::string> grouped(std::span<const std::string> notes) {
    std::vector<Group> groups;
    for (const std::string& note : notes) {
        group_of(groups, kind_of(note)).members.push_back(note);
    }
    std::vector<std::string> lines;
    for (const Group& group : groups) {
        const std::size_t more = group.members.size() - 1;
        lines.push_back(group.members.front() + (more > 0 ? fmt::format(" ({} more of this kind)", more) : ""));
    }
    return lines;
}

void say_notes(const std::string& of, std::span<const std::string> notes) {
    const bool all = spdlog::should_log(spdlog::level::info);
    for (const std::string& line : all ? std::vector<std::string>(notes.begin(), notes.end()) : grouped(notes)) {
        spdlog::warn("{}: note: {}", of, line);
    }
}

std::vector<std::string> grouped_reasons(std::span<const LightReason> lights, std::string_view what) {
    // Take each light's own name out of its sentence: what is left is the reason.
    std::vector<Group> groups;
    std::vector<std::string> sentences;
    for (const auto& [name, reason] : lights) {
        const std::string opening = "light '" + name + "': ";
        const std::string sentence = reason.starts_with(opening) ? reason.substr(opening.size()) : reason;
        std::string kind = sentence;
        if (const std::size_t at = kind.find("'" + name + "'"); at != std::string::npos) {
            kind.replace(at, name.size() + 2, "''");
        }
        Group& group = group_of(groups, kind);
        sentences.resize(groups.size());
        if (group.members.empty()) {
            sentences.back() = sentence;
        }
        group.members.push_back(name);
    }
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const std::vector<std::string>& names = groups[i].members;
        const std::string of = names.size() == 1 ? "light " + quoted_names(names)
                                                 : fmt::format("{} lights ({})", names.size(), quoted_names(names));
        sentences[i] = fmt::format("{}{}: {}", of, what, sentences[i]);
    }
    return sentences;
}

std::vector<LightReason> refused_lights(const Scene& scene, const FrameResult& frame) {
    std::vector<LightReason> refused;
    for (std::size_t l = 0; l < frame.refused.size(); ++l) {
        if (!frame.refused[l].empty()) {
            refused.emplace_back(scene.lights.at(l).name, frame.refused[l]);
        }
    }
    return refused;
}

std::string joined_reasons(std::span<const LightReason> lights) {
    return fmt::format("{}", fmt::join(grouped_reasons(lights), "; "));
}

}  // namespace gn
