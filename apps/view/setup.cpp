// SPDX-License-Identifier: MIT
// Words of cameras and lights.
#include "apps/view/setup.h"

#include "base/param.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

namespace gn {
namespace {

double number_of(std::string_view text, std::string_view where) {
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
        fail("{}: '{}' is no number", where, text);
    }
    return value;
}

vec3 vector_of(std::string_view text, std::string_view where) {
    vec3 v(0);
    for (int i = 0; i < 3; ++i) {
        const std::size_t end = std::min(text.find('/'), text.size());
        if ((i < 2) != (end < text.size())) {
            fail("{}: '{}' is no vector; one is written x/y/z", where, text);
        }
        v[i] = static_cast<float>(number_of(text.substr(0, end), where));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return v;
}

vec3 direction_of(std::string_view text, std::string_view where) {
    const vec3 v = vector_of(text, where);
    const float length = glm::length(v);
    if (!(length > 1e-6F)) {
        fail("{}: '{}' is no direction; it must be longer than 0", where, text);
    }
    // A unit vector stays as it was written.
    return std::abs(length - 1.0F) < 1e-5F ? v : v / length;
}

float at_least_0(std::string_view text, std::string_view where) {
    const double value = number_of(text, where);
    if (value < 0) {
        fail("{}: {} is not valid; it is 0 or more", where, text);
    }
    return static_cast<float>(value);
}

float radians_of(std::string_view text, std::string_view where) {
    return static_cast<float>(glm::radians(static_cast<double>(number_of(text, where))));
}

std::string text_of(vec3 v) {
    return fmt::format("{}/{}/{}", v.x, v.y, v.z);
}

std::string degrees(float radians) {
    return fmt::format("{}", glm::degrees(static_cast<double>(radians)));
}

/// A word that may be said of a thing.
struct Word {
    std::string_view key;
    std::function<void(std::string_view value, std::string_view where)> set;
};

/// Takes "key=value,key=value".
void take_words(std::string_view text, std::string_view what, const std::vector<Word>& words) {
    while (!text.empty()) {
        const std::size_t comma = std::min(text.find(','), text.size());
        const std::string_view item = text.substr(0, comma);
        text.remove_prefix(std::min(text.size(), comma + 1));
        const std::size_t equals = std::min(item.find('='), item.size());
        const std::string_view key = item.substr(0, equals);
        const auto found = std::find_if(words.begin(), words.end(), [&](const Word& word) { return word.key == key; });
        if (found == words.end() || equals == item.size()) {
            std::vector<std::string_view> known;
            for (const Word& word : words) {
                known.push_back(word.key);
            }
            fail("{}: '{}' is not key=value with a known key; {}", what, item, suggest(key, known));
        }
        found->set(item.substr(equals + 1), fmt::format("{}: {}", what, key));
    }
}

}  // namespace

Camera parse_camera(std::string_view words, const Camera& otherwise) {
    Camera camera = otherwise;
    take_words(words, "camera",
               {{"position", [&](auto v, auto where) { camera.position_ws = vector_of(v, where); }},
                {"direction", [&](auto v, auto where) { camera.forward_ws = direction_of(v, where); }},
                {"up", [&](auto v, auto where) { camera.up_ws = direction_of(v, where); }},
                {"yfov_deg", [&](auto v, auto where) { camera.yfov = radians_of(v, where); }},
                {"half_height", [&](auto v, auto where) { camera.half_height = at_least_0(v, where); }},
                {"near", [&](auto v, auto where) { camera.near = at_least_0(v, where); }},
                {"far", [&](auto v, auto where) { camera.far = at_least_0(v, where); }}});
    if (!(camera.yfov > 0.0017F && camera.yfov < 3.06F)) {
        fail("camera: yfov_deg = {} is not valid; it is between 0.1 and 175", degrees(camera.yfov));
    }
    if (!(camera.near > 0 && camera.far > camera.near)) {
        fail("camera: near = {} and far = {} are not valid; 0 < near < far", camera.near, camera.far);
    }
    if (glm::length(glm::cross(camera.forward_ws, camera.up_ws)) < 1e-6F) {
        fail("camera: direction and up are parallel; they must differ");
    }
    return camera;
}

std::string text_of(const Camera& camera) {
    const std::string lens = is_orthographic(camera) ? fmt::format("half_height={}", camera.half_height)
                                                     : "yfov_deg=" + degrees(camera.yfov);
    return fmt::format("position={},direction={},up={},{},near={},far={}", text_of(camera.position_ws),
                       text_of(camera.forward_ws), text_of(camera.up_ws), lens, camera.near, camera.far);
}

GnLight parse_light(std::string_view words, const GnLight& otherwise) {
    GnLight light = otherwise;
    take_words(words, "light",
               {{"position", [&](auto v, auto where) { light.position_ws = vec4(vector_of(v, where), 0); }},
                {"direction", [&](auto v, auto where) { light.direction_ws = vec4(direction_of(v, where), 0); }},
                {"right", [&](auto v, auto where) { light.right_ws = vec4(direction_of(v, where), 0); }},
                {"up", [&](auto v, auto where) { light.up_ws = vec4(direction_of(v, where), 0); }},
                {"color", [&](auto v, auto where) { light.color = vec4(vector_of(v, where), light.color.w); }},
                {"intensity", [&](auto v, auto where) { light.intensity = at_least_0(v, where); }},
                {"radius", [&](auto v, auto where) { light.radius = at_least_0(v, where); }},
                {"angular_radius_deg", [&](auto v, auto where) { light.angular_radius = radians_of(v, where); }},
                {"range", [&](auto v, auto where) { light.range = at_least_0(v, where); }}});
    return light;
}

std::string text_of(const GnLight& light, const GnLight& otherwise) {
    std::string text;
    const auto vector = [&](std::string_view key, const vec4& now, const vec4& before) {
        text += vec3(now) != vec3(before) ? fmt::format(",{}={}", key, text_of(vec3(now))) : "";
    };
    const auto number = [&](std::string_view key, float now, float before) {
        text += now != before ? fmt::format(",{}={}", key, now) : "";
    };
    vector("position", light.position_ws, otherwise.position_ws);
    vector("direction", light.direction_ws, otherwise.direction_ws);
    vector("right", light.right_ws, otherwise.right_ws);
    vector("up", light.up_ws, otherwise.up_ws);
    vector("color", light.color, otherwise.color);
    number("intensity", light.intensity, otherwise.intensity);
    number("radius", light.radius, otherwise.radius);
    number("range", light.range, otherwise.range);
    if (light.angular_radius != otherwise.angular_radius) {
        text += ",angular_radius_deg=" + degrees(light.angular_radius);
    }
    return text.empty() ? text : text.substr(1);
}

}  // namespace gn
