// SPDX-License-Identifier: MIT
// What a sequence of frames keeps: named textures and values. One history serves one camera's sequence; frames without
// one keep nothing.
#pragma once

#include "gpu/memory.h"

#include <any>
#include <map>
#include <string>

namespace gn {

class History {
  public:
    explicit History(Device& device) : device_(device) {}

    /// Frames completed so far.
    [[nodiscard]] std::uint64_t frame() const { return frame_; }
    void advance() { ++frame_; }
    /// Forgets everything: after a frame that failed, or a cut.
    void clear() {
        textures_.clear();
        values_.clear();
    }

    /// The texture of this name. `fresh` becomes true where its contents are undefined: it is new, or its description
    /// changed. It lives until clear or a call with another description; import it into one graph at a time.
    Texture2D& texture(const TextureDesc& desc, bool& fresh);

    /// The value of this name, default-made at first. Throws Error when the name was used with another type.
    template <class Value>
    Value& value(const std::string& name) {
        std::any& held = values_[name];
        if (!held.has_value()) {
            held = Value{};
        }
        auto* value = std::any_cast<Value>(&held);
        if (value == nullptr) {
            fail("history: '{}' was kept as another type; use one type for one name", name);
        }
        return *value;
    }

  private:
    Device& device_;
    std::uint64_t frame_ = 0;
    std::map<std::string, Texture2D> textures_;
    std::map<std::string, std::any> values_;
};

}  // namespace gn
