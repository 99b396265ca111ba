// SPDX-License-Identifier: MIT
// Values of any type that are made once and kept: by name and key, as long as the version that they were made of is current.
#pragma once

#include "base/error.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <typeindex>
#include <utility>

namespace gn {

class Kept {
  public:
    /// The value of this name and key for a version, made by `make` where there is none. Another version than the last drops
    /// everything; whoever still uses a value holds it. One name means one type. Not thread-safe.
    template <class Make>
    auto get(std::uint64_t version, std::string_view name, std::uint64_t key, Make make)
        -> std::shared_ptr<const std::invoke_result_t<Make>> {
        using Value = std::invoke_result_t<Make>;
        if (version != version_) {
            entries_.clear();
            version_ = version;
        }
        auto found = entries_.find(Asked{name, key});
        if (found == entries_.end()) {
            Entry entry{std::make_shared<const Value>(make()), typeid(Value)};
            found = entries_.emplace(Key{std::string(name), key}, std::move(entry)).first;
        }
        GN_CHECK(found->second.type == typeid(Value));
        return std::static_pointer_cast<const Value>(found->second.value);
    }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }

  private:
    using Key = std::pair<std::string, std::uint64_t>;
    using Asked = std::pair<std::string_view, std::uint64_t>;
    struct Less {
        using is_transparent = void;
        bool operator()(const auto& a, const auto& b) const {
            return a.second != b.second ? a.second < b.second : std::string_view(a.first) < std::string_view(b.first);
        }
    };
    struct Entry {
        std::shared_ptr<const void> value;
        std::type_index type;
    };
    std::uint64_t version_ = 0;
    std::map<Key, Entry, Less> entries_;
};

}  // namespace gn
