// SPDX-License-Identifier: MIT
// What a sequence of frames keeps: named textures, pairs of them, and values. One history serves one camera's sequence;
// frames without one keep nothing.
#pragma once

#include "gpu/memory.h"

#include <any>
#include <array>
#include <map>
#include <memory>
#include <string>

namespace gn {

/// Whether a texture can be used as the one that is wanted, whatever its name and what else it is used for.
bool serves(const TextureDesc& held, const TextureDesc& wanted);

/// By which name a placement that chooses its resolution leaves how many texels a frame drew of a light's map (ivec2, along each
/// axis), for whoever reports a sequence.
std::string chosen_texels(std::uint64_t light_id);

class History {
  public:
    explicit History(Device& device) : device_(device) {}

    /// Frames completed so far.
    [[nodiscard]] std::uint64_t frame() const { return frame_; }
    /// A frame completed (or was recorded, by a host): what it wrote is what the next one finds. Until then the frame may
    /// be run again and finds what it found before.
    void advance();
    /// Forgets everything: after a frame that failed, or a cut.
    void clear();

    /// The texture of this name, that frames add to. `fresh` becomes true where no completed frame drew into it: it is new, or
    /// its description changed. It lives until clear or a call with another description.
    Texture2D& texture(const TextureDesc& desc, bool& fresh);

    /// Two textures of one description: what the latest completed frame that asked for it left, null where none has yet, and
    /// what this frame writes. They change places with advance.
    struct Pair {
        Texture2D* before = nullptr;
        Texture2D* now = nullptr;
    };
    Pair pair(const TextureDesc& desc);

    /// The value of this name that completed frames left last; null where none did. Throws Error when it was left with another
    /// type.
    template <class Value>
    [[nodiscard]] const Value* before(const std::string& name) const {
        const auto found = values_.find(name);
        if (found == values_.end() || !found->second.before.has_value()) {
            return nullptr;
        }
        const auto* value = std::any_cast<Value>(&found->second.before);
        if (value == nullptr) {
            fail("history: '{}' was kept as another type; use one type for one name", name);
        }
        return value;
    }
    /// What the next frame will find by this name, once this one completes.
    template <class Value>
    void leave(const std::string& name, Value value) {
        values_[name].now = std::move(value);
    }
    /// A number of this name that the answers of frames write (FrameGraph::answer) and later frames read: 0 until one came.
    std::shared_ptr<std::uint32_t> answered(const std::string& name) {
        std::shared_ptr<std::uint32_t>& number = answers_[name];
        number = number != nullptr ? number : std::make_shared<std::uint32_t>(0);
        return number;
    }

  private:
    Device& device_;
    std::uint64_t frame_ = 0;
    struct KeptTexture {
        Texture2D texture;
        bool written = false;  ///< by a completed frame
        bool asked = false;    ///< in this frame
    };
    struct KeptPair {
        std::array<Texture2D, 2> textures;
        std::size_t now = 0;
        bool written = false;  ///< the other one, by a completed frame
        bool asked = false;    ///< in this frame
    };
    struct KeptValue {
        std::any before, now;
    };
    std::map<std::string, KeptTexture> textures_;
    std::map<std::string, KeptPair> pairs_;
    std::map<std::string, KeptValue> values_;
    std::map<std::string, std::shared_ptr<std::uint32_t>> answers_;

    /// Textures that were replaced or forgotten: frames in flight may still read them.
    struct Dropped {
        std::uint64_t frame = 0;
        Texture2D texture;
    };
    void drop(Texture2D texture) { dropped_.push_back({frame_, std::move(texture)}); }
    std::vector<Dropped> dropped_;
};

}  // namespace gn
