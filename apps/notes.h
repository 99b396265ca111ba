// SPDX-License-Identifier: MIT
// What is said on standard error besides results: notes, and refusals of many lights in few sentences.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gn {

struct FrameResult;
struct Scene;

/// Sentences that differ in names and numbers only as one: the first, and how many more there are.
std::vector<std::string> grouped(std::span<const std::string> notes);

/// Says each note of a scene or a run on a line of its own: grouped, or all of them with --verbose; none with --quiet.
void say_notes(const std::string& of, std::span<const std::string> notes);

/// A light and the sentence why it was refused.
using LightReason = std::pair<std::string, std::string>;
/// Those of a frame's lights that were refused.
std::vector<LightReason> refused_lights(const Scene& scene, const FrameResult& frame);
/// One sentence a reason: "light 'key': why", "9 lights ('a', 'b', 'c' and 6 more): why". Reasons that differ only in the
/// name of their own light are one. `what` follows the lights' names.
std::vector<std::string> grouped_reasons(std::span<const LightReason> lights, std::string_view what = "");
/// The same in one sentence.
std::string joined_reasons(std::span<const LightReason> lights);

}  // namespace gn
