// SPDX-License-Identifier: MIT
// A first pass over the JSON of a glTF file, without building anything: the parser behind it recurses on nesting,
// spends hundreds of bytes on a value, and takes a value of the wrong type for an absent one.
#include "shadow/scene/files/gltf_data.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace gn::gltf {

namespace {

constexpr std::size_t most_values = 8'000'000;
constexpr std::size_t deepest = 128;

using Keys = std::initializer_list<std::string_view>;

bool one_of(Keys names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// Keys whose value, or every element of whose list, is an index, an offset or a count.
bool is_whole(std::string_view key) {
    return one_of({"bufferView",
                   "buffer",
                   "byteOffset",
                   "byteLength",
                   "byteStride",
                   "componentType",
                   "count",
                   "mesh",
                   "material",
                   "indices",
                   "camera",
                   "skin",
                   "children",
                   "nodes",
                   "joints",
                   "skeleton",
                   "scene",
                   "source",
                   "sampler",
                   "index",
                   "texCoord",
                   "mode",
                   "inverseBindMatrices"},
                  key);
}

bool is_list(std::string_view key) {
    return one_of({"accessors", "buffers", "bufferViews", "cameras", "images", "materials", "meshes", "nodes",
                   "samplers", "scenes", "skins", "textures", "primitives", "children", "joints", "translation",
                   "rotation", "scale", "matrix"},
                  key);
}

// Receives the JSON as events.
class Checker : public nlohmann::json_sax<nlohmann::json> {
  public:
    explicit Checker(const std::string& shown) : shown_(shown) {}

    bool null() override { return count(); }
    bool boolean(bool) override { return count_scalar("true or false"); }
    bool string(string_t&) override { return count_scalar("a string"); }
    bool binary(binary_t&) override { return count(); }
    bool number_unsigned(number_unsigned_t) override { return count_number(true); }
    bool number_integer(number_integer_t value) override { return count_number(value >= 0); }
    bool number_float(number_float_t value, const string_t&) override {
        return count_number(value >= 0.0 && value == std::floor(value));
    }

    bool key(string_t& name) override {
        key_ = name;
        return true;
    }
    bool start_object(std::size_t) override {
        if (!free_ && is_list(key_) && !in_list_) {
            fail("{}: '{}' must be a list", shown_, clean_text(key_));
        }
        return enter(false);
    }
    bool start_array(std::size_t) override { return enter(true); }
    bool end_object() override { return leave(); }
    bool end_array() override { return leave(); }

    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& problem) override {
        const std::string reason = problem.what();
        const std::size_t tail = reason.rfind(": ");
        fail("{}: not valid JSON at byte {} ({})", shown_, position,
             clean_text(tail == std::string::npos ? reason : reason.substr(tail + 2)));
    }

  private:
    struct Level {
        std::string key;
        bool free, in_list;
    };

    bool count() {
        if (++values_ > most_values) {
            fail("{}: the JSON holds more than {} values", shown_, most_values);
        }
        return true;
    }

    // extras and extensions may hold anything, under any key.
    [[nodiscard]] bool wants_whole() const {
        return !free_ && (is_whole(key_) || (!levels_.empty() && levels_.back().key == "attributes" && !in_list_));
    }

    bool count_number(bool whole) {
        if (!whole && wants_whole()) {
            fail("{}: '{}' must be a whole number, 0 or more", shown_, clean_text(key_));
        }
        return count();
    }

    bool count_scalar(const char* what) {
        if (wants_whole() || (!free_ && !in_list_ && is_list(key_))) {
            fail("{}: '{}' cannot be {}", shown_, clean_text(key_), what);
        }
        return count();
    }

    bool enter(bool list) {
        levels_.push_back({key_, free_, in_list_});
        if (levels_.size() > deepest) {
            fail("{}: the JSON nests deeper than {} levels", shown_, deepest);
        }
        free_ = free_ || key_ == "extras" || key_ == "extensions";
        in_list_ = list;
        return count();
    }

    bool leave() {
        key_ = levels_.back().key;
        free_ = levels_.back().free;
        in_list_ = levels_.back().in_list;
        levels_.pop_back();
        return true;
    }

    const std::string& shown_;
    std::vector<Level> levels_;
    std::string key_;
    bool free_ = false, in_list_ = false;
    std::size_t values_ = 0;
};

}  // namespace

void check_json(std::string_view json, const std::string& shown) {
    Checker checker(shown);
    try {
        if (!nlohmann::json::sax_parse(json.begin(), json.end(), &checker)) {
            fail("{}: not valid JSON", shown);
        }
    } catch (const nlohmann::json::exception& problem) {
        fail("{}: not valid JSON ({})", shown, clean_text(problem.what()));
    }
}

}  // namespace gn::gltf
