// SPDX-License-Identifier: MIT
#include "shadow/scene/moves.h"

#include <algorithm>

namespace gn {

void Moves::add(std::uint64_t from, std::uint64_t to, std::optional<std::vector<Box>> touched_ws) {
    if (!touched_ws || touched_ws->size() > most_boxes || from != now_) {
        steps_.clear();
    }
    now_ = to;
    if (!touched_ws || touched_ws->size() > most_boxes) {
        return;
    }
    std::erase_if(*touched_ws, [](const Box& box_ws) { return box_ws.empty(); });
    steps_.push_back({from, to, std::move(*touched_ws)});
    if (steps_.size() > most_steps) {
        steps_.pop_front();
    }
}

std::optional<std::vector<Box>> Moves::since(std::uint64_t version) const {
    if (version == now_) {
        return std::vector<Box>{};
    }
    const auto first = std::find_if(steps_.begin(), steps_.end(), [&](const Step& s) { return s.from == version; });
    if (first == steps_.end()) {
        return {};
    }
    std::vector<Box> touched_ws;
    for (auto step = first; step != steps_.end(); ++step) {
        touched_ws.insert(touched_ws.end(), step->touched_ws.begin(), step->touched_ws.end());
    }
    return touched_ws;
}

}  // namespace gn
