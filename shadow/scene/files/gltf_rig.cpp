// SPDX-License-Identifier: MIT
// Animations and skins: nodes that curves move, and the joints that hold vertices. glTF 2.0, sections 3.7.3 and 3.11.
#include "shadow/scene/files/gltf_data.h"

#include <algorithm>

namespace gn::gltf {

namespace {

// Most keys of all curves of one file, and most weights that its channels move.
constexpr std::size_t most_keys = std::size_t{1} << 24;
constexpr std::size_t most_weights = std::size_t{1} << 20;

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

    // The curve of every target's weight: the sampler's values are those of all targets, key by key.
    const std::vector<std::size_t>& read_weights(const tinygltf::AnimationSampler& sampler, std::size_t targets) {
        if ((moved_weights_ += targets) > most_weights) {
            fail("the file's channels move more than {} weights", most_weights);
        }
        const std::tuple key(sampler.input, sampler.output, sampler.interpolation, targets);
        const auto known = weights_.find(key);
        if (known != weights_.end()) {
            return known->second;
        }
        Curve curve{.between = interpolation_of(sampler.interpolation)};
        read_times(sampler.input, curve);
        count_keys(curve.times.size() * (targets - 1));
        const Elements values(file_, sampler.output);
        const std::size_t parts = curve.between == Interpolation::cubic_spline ? 3 : 1;
        const std::size_t count = curve.times.size() * parts * targets;
        if (values.components() != 1 || values.size() != count) {
            fail("accessor {} holds {} values of {} numbers; {} keys of {} morph targets take {} of 1", sampler.output,
                 values.size(), values.components(), curve.times.size(), targets, count);
        }
        std::vector<Curve> curves(targets, curve);
        // With tangents a key has those that arrive, the values, and those that leave, of all targets each.
        for (std::size_t i = 0; i < count; ++i) {
            const auto value = static_cast<float>(values.vector(i).x);
            if (!std::isfinite(value)) {
                fail("value {} is not finite", i);
            }
            curves[i % targets].values.emplace_back(value, 0, 0, 0);
        }
        std::vector<std::size_t>& numbers = weights_[key];
        for (Curve& one : curves) {
            numbers.push_back(rig_.curves.size());
            rig_.curves.push_back(std::move(one));
        }
        return numbers;
    }

  private:
    void count_keys(std::size_t more) {
        if (more > most_keys || (keys_ += more) > most_keys) {
            fail("the file's curves have more than {} keys", most_keys);
        }
    }

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
            count_keys(1);
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
    std::map<std::tuple<int, int, std::string, std::size_t>, std::vector<std::size_t>> weights_;
    std::size_t keys_ = 0, moved_weights_ = 0;
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
    if (channel.target_path == "weights") {
        return Channel::weight;
    }
    fail("'{}' is not moved; translation, rotation, scale and weights are", clean_text(channel.target_path));
}

// How many morph targets the mesh of a node has.
std::size_t targets_of(const File& file, const tinygltf::Node& node) {
    return node.mesh < 0 ? 0 : count_targets(at(file.data.meshes, node.mesh, file, "mesh"));
}

// The weights of a node's targets at rest: its own, or else those of its mesh. [glTF 2.0, 3.7.2.2]
std::vector<double> weights_at_rest(const File& file, const tinygltf::Node& node) {
    const std::size_t targets = targets_of(file, node);
    if (targets == 0) {
        return {};
    }
    std::vector<double> weights =
        node.weights.empty() ? file.data.meshes[static_cast<std::size_t>(node.mesh)].weights : node.weights;
    weights.resize(targets, 0.0);
    for (double& weight : weights) {
        weight = std::isfinite(weight) ? weight : 0.0;
    }
    return weights;
}

// The channel as the rig has it, weights one by one; nothing where its node is not in the scene that is shown. Throws Error
// where it cannot be played.
std::vector<Channel> read_channel(const File& file, const tinygltf::Animation& data,
                                  const tinygltf::AnimationChannel& channel, std::span<const int> walked,
                                  Curves& curves) {
    const tinygltf::Node& node = at(file.data.nodes, channel.target_node, file, "node");
    const Channel::Path path = path_of(channel);
    const tinygltf::AnimationSampler& sampler = at(data.samplers, channel.sampler, file, "sampler");
    const int place = walked[static_cast<std::size_t>(channel.target_node)];
    std::vector<Channel> channels;
    if (path == Channel::weight) {
        const std::size_t targets = targets_of(file, node);
        if (targets == 0) {
            fail("node {} has no mesh with morph targets", channel.target_node);
        }
        for (const std::size_t curve : curves.read_weights(sampler, targets)) {
            channels.push_back({static_cast<std::size_t>(place), path, curve, channels.size()});
        }
    } else if (node.matrix.size() == 16) {
        fail("node {} has a matrix, which no channel moves", channel.target_node);
    } else {
        const std::size_t curve = curves.read(sampler, path == Channel::rotation ? 4 : 3);
        channels.push_back({static_cast<std::size_t>(place), path, curve});
    }
    return place >= 0 ? channels : std::vector<Channel>{};
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
            for (const Channel& read : read_channel(file, data, channel, walked, curves)) {
                animation.channels.push_back(read);
                animation.seconds =
                    std::max(animation.seconds, static_cast<double>(rig.curves[read.curve].times.back()));
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

std::vector<bool> find_morphed(const Rig& rig, std::size_t nodes) {
    std::vector<bool> morphed(nodes, false);
    for (const Animation& animation : rig.animations) {
        for (const Channel& channel : animation.channels) {
            if (channel.path == Channel::weight) {
                morphed[channel.node] = true;
            }
        }
    }
    return morphed;
}

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
    const std::vector<bool> morphed = find_morphed(rig, nodes.size());
    for (const PlacedNode& node : nodes) {
        const tinygltf::Node& data = file.data.nodes[static_cast<std::size_t>(node.index)];
        RigNode& placed = rig.nodes.emplace_back(node_at_rest(data));
        placed.parent = node.parent;
        if (morphed[rig.nodes.size() - 1]) {
            placed.weights = weights_at_rest(file, data);
        }
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
