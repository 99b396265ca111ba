// SPDX-License-Identifier: MIT
#include "steady.h"

#include <array>
#include <utility>

void Steady::after_frame(const gn::Counters& now) {
    constexpr std::uint32_t settled = 3;
    if (++since_ > settled) {
        ++frames_;
        const std::array<std::pair<const char*, std::uint64_t>, 8> made{{
            {"pipelines", now.pipelines - known_->pipelines},
            {"samplers", now.samplers - known_->samplers},
            {"images", now.images - known_->images},
            {"buffers", now.buffers - known_->buffers},
            {"views", now.views - known_->views},
            {"allocations", now.allocations - known_->allocations},
            {"pools", now.pools - known_->pools},
            {"shader texts", now.texts - known_->texts},
        }};
        for (const auto& [name, count] : made) {
            if (count > 0) {
                created_ += (created_.empty() ? "" : ", ") + std::to_string(count) + " " + name;
            }
        }
    }
    known_ = now;
}
