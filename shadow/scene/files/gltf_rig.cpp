// SPDX-License-Identifier: MIT
// Animations and skins: nodes that curves move, and the joints that hold vertices. glTF 2.0, sections 3.7.3 and 3.11.
#include "shadow/scene/files/gltf_data.h"

#include <algorithm>

namespace gn::gltf {

namespace {

// Most keys of all curves of one file.
constexpr std::size_t most_keys = std::size_t{1} << 24;

Interpolation interpolation_of(const std::string& name) {
    if (name == "STEP") {
        return Interpolation::step;
    }
    if (name == "CUBICSPLINE") {
        return Interpolation::cubic_spline;
    }
    if (name != "LINEAR" && !name.empty()) {
        fail("interpolation '{}' is not known; STEP, LINEAR and CUBICSPLINE are", clean_text(name));
    }
    return Interpolation::linear;
}

// Reads every sampler once.
class Curves {
  public:
    Curves(const File& file, Rig& rig) : file_(file), rig_(rig) {}

    // The index of its curve. Throws Error where it cannot be played.
    std::size_t read(const tinygltf::AnimationSampler& sampler, int components) {
        const std::tuple key(sampler.input, sampler.output, sampler.interpolation, components);
        const auto known = known_.find(key);
        if (known != known_.end()) {
            return known->second;
        }
        Curve curve{.between = interpolation_of(sampler.interpolation)};
        read_times(sampler.input, curve);
        read_values(sampler.output, components, curve);
        rig_.curves.push_back(std::move(curve));
        return known_[key] = rig_.curves.size() - 1;
    }

  private:
    void read_times(int accessor, Curve& curve) {
        const Elements times(file_, accessor);
        if (times.size() == 0 || times.components() != 1) {
            fail("accessor {} holds no times", accessor);
        }
        for (std::size_t k = 0; k < times.size(); ++k) {
            const auto time = static_cast<float>(times.vector(k).x);
            if (!std::isfinite(time) || (k > 0 && time <= curve.times.back())) {
                fail("the time of key {} is {}; times are finite and grow", k, time);
            }
            if (++keys_ > most_keys) {
                fail("the file's curves have more than {} keys", most_keys);
            }
            curve.times.push_back(time);
        }
    }

    void read_values(int accessor, int components, Curve& curve) const {
        const Elements values(file_, accessor);
        const std::size_t count = curve.times.size() * (curve.between == Interpolation::cubic_spline ? 3 : 1);
        if (values.components() != components || values.size() < count) {
            fail("accessor {} holds {} values of {} numbers; {} of {} are needed", accessor, values.size(),
                 values.components(), count, components);
        }
        curve.values.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            const vec4 value(values.vector(i));
            if (!finite(vec3(value)) || !std::isfinite(value.w)) {
                fail("value {} is not finite", i);
            }
            curve.values.push_back(value);
        }
    }

    const File& file_;
    Rig& rig_;
    std::map<std::tuple<int, int, std::string, int>, std::size_t> known_;
    std::size_t keys_ = 0;
};

Channel::Path path_of(const tinygltf::AnimationChannel& channel) {
    if (channel.target_path == "translation") {
        return Channel::translation;
    }
    if (channel.target_path == "rotation") {
        return Channel::rotation;
    }
    if (channel.target_path == "scale") {
        return Channel::scale;
    }
    fail("'{}' is not moved; translation, rotation and scale are", clean_text(channel.target_path));
}

// The channel as the rig has it; nothing where its node is not in the scene that is shown. Throws Error where it cannot be played.
std::optional<Channel> read_channel(const File& file, const tinygltf::Animation& data,
                                    const tinygltf::AnimationChannel& channel, std::span<const int> walked,
                                    Curves& curves) {
    const tinygltf::Node& node = at(file.data.nodes, channel.target_node, file, "node");
    const Channel::Path path = path_of(channel);
    const tinygltf::AnimationSampler& sampler = at(data.samplers, channel.sampler, file, "sampler");
    if (node.matrix.size() == 16) {
        fail("node {} has a matrix, which no channel moves", channel.target_node);
    }
    const std::size_t curve = curves.read(sampler, path == Channel::rotation ? 4 : 3);
    const int place = walked[static_cast<std::size_t>(channel.target_node)];
    return place >= 0 ? std::optional(Channel{static_cast<std::size_t>(place), path, curve}) : std::nullopt;
}

Animation read_animation(File& file, std::size_t index, std::span<const int> walked, const Rig& rig, Curves& curves) {
    const tinygltf::Animation& data = file.data.animations[index];
    Animation animation{.name = clean_text(data.name)};
    if (animation.name.empty()) {
        animation.name = fmt::format("animation {}", index + 1);
    }
    std::size_t left_out = 0;
    std::string reason;
    for (const tinygltf::AnimationChannel& channel : data.channels) {
        try {
            if (const std::optional<Channel> read = read_channel(file, data, channel, walked, curves)) {
                animation.channels.push_back(*read);
                animation.seconds =
                    std::max(animation.seconds, static_cast<double>(rig.curves[read->curve].times.back()));
            }
        } catch (const Error& problem) {
            reason = left_out++ == 0 ? problem.what() : reason;
        }
    }
    if (left_out > 0) {
        add_note(file.notes, fmt::format("{} of the {} channels of animation '{}' {} not played: {}.", left_out,
                                         data.channels.size(), animation.name, left_out == 1 ? "is" : "are", reason));
    }
    return animation;
}

// What one animation moves twice follows the later channel; names are unlike, so that each can be asked for.
void add_animation(Rig& rig, Animation animation) {
    const std::string base = animation.name;
    const auto taken = [&] {
        return std::any_of(rig.animations.begin(), rig.animations.end(),
                           [&](const Animation& a) { return a.name == animation.name; });
    };
    for (std::size_t number = rig.animations.size() + 1; taken(); ++number) {
        animation.name = fmt::format("{} {}", base, number);
    }
    rig.animations.push_back(std::move(animation));
}

}  // namespace

Rig load_rig(File& file, std::span<const PlacedNode> nodes) {
    // More of them than a person chooses from would only take time.
    constexpr std::size_t most_animations = 1000;
    Rig rig;
    std::vector<int> walked(file.data.nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        walked[static_cast<std::size_t>(nodes[i].index)] = static_cast<int>(i);
    }
    Curves curves(file, rig);
    for (std::size_t i = 0; i < std::min(file.data.animations.size(), most_animations); ++i) {
        Animation animation = read_animation(file, i, walked, rig, curves);
        if (!animation.channels.empty()) {
            add_animation(rig, std::move(animation));
        }
    }
    if (file.data.animations.size() > most_animations) {
        add_note(file.notes, fmt::format("The file holds {} animations; the first {} can be played.",
                                         file.data.animations.size(), most_animations));
    }
    if (!rig.moves()) {
        note_count(file.notes, file.data.animations.size(),
                   "1 animation moves nothing that is shown: everything stands as at rest.",
                   "{} animations move nothing that is shown: everything stands as at rest.");
        return {};
    }
    for (const PlacedNode& node : nodes) {
        RigNode& placed = rig.nodes.emplace_back(node_at_rest(file.data.nodes[static_cast<std::size_t>(node.index)]));
        placed.parent = node.parent;
    }
    return rig;
}

Skin load_skin(const File& file, int skin_index, std::span<const int> walked) {
    const tinygltf::Skin& data = at(file.data.skins, skin_index, file, "skin");
    std::optional<Elements> inverses;
    if (data.inverseBindMatrices >= 0) {
        inverses.emplace(file, data.inverseBindMatrices);
    }
    Skin skin;
    for (std::size_t i = 0; i < data.joints.size(); ++i) {
        at(file.data.nodes, data.joints[i], file, "node");
        const bool given = inverses && i < inverses->size() && inverses->components() == 16;
        skin.joints.push_back(walked[static_cast<std::size_t>(data.joints[i])]);
        skin.joint_from_mesh.push_back(given ? inverses->matrix(i) : dmat4(1.0));
    }
    return skin;
}

}  // namespace gn::gltf
