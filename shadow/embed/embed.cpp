// SPDX-License-Identifier: MIT
#include "shadow/embed/embed.h"

#include "gpu/glsl.h"
#include "gpu/memory_barrier.h"
#include "gpu/reload.h"
#include "shadow/embed/lent_receivers.h"
#include "shadow/embed/state.h"
#include "shadow/recipe/check_recipe.h"

namespace gn::embed {
namespace {

/// Throws Error naming the recipe's parts that read more than casters' buffers and receivers.
void check_parts(const Recipe& recipe) {
    for (const Part* part : recipe.parts()) {
        if (part->needs_scene) {
            fail(
                "{} '{}' reads the scene on the CPU, which a renderer's buffers do not bring; gn::host::Session in "
                "shadow/embed/host.h draws with it",
                stage_names[static_cast<std::size_t>(part->stage)], part->id);
        }
    }
    if (recipe.casters == Casters::ids) {
        fail(
            "casters=ids compares object ids of the view's samples, which a renderer's depth and normals do not bring; "
            "valid here are all, front, back, midpoint and dual");
    }
}

/// Throws Error where a recipe that goes by name has no file in the folder.
void demand_recipe(const BakedShaders& baked, const std::string& text) {
    const std::string name = text.substr(0, text.find(','));
    const std::vector<std::string> known = recipe_names(baked.folder());
    if (name.find('/') == std::string::npos && !name.ends_with(".toml") &&
        std::none_of(known.begin(), known.end(), [&](const auto& k) { return identifier(k) == identifier(name); })) {
        fail("recipe '{}' is not in {}; this makes it: {}", text, baked.folder().string(), baked.command_with(text));
    }
}

/// Where the shaders come from. Throws Error where there is neither a baked folder nor a compiler.
std::shared_ptr<ShaderCompiler> shaders_for(const Info& info, const std::shared_ptr<const BakedShaders>& baked) {
    if (baked != nullptr) {
        return std::make_shared<ShaderCompiler>(baked);
    }
    if (!has_glsl_compiler()) {
        fail(
            "this program links no compiler of shaders; give a baked folder (gnomon bake {} -o FOLDER), or link "
            "gnomon::gn_shadow",
            info.recipe);
    }
    return info.data.empty() ? nullptr : compiler_of(info.data);
}

}  // namespace

std::string text_of(const Recipe& recipe) {
    return recipe.name + (recipe.overrides.empty() ? "" : ",") + recipe.overrides;
}

Shadows::State::State(const Info& asked, std::shared_ptr<const BakedShaders> found, std::unique_ptr<Device> given)
    : info(asked),
      baked(std::move(found)),
      device(given != nullptr ? std::move(given) : Device::adopt(info.device, shaders_for(info, baked))),
      frames(*device, info.limits.frames_in_flight),
      images(*device, frames),
      casters(*device) {
    forget_history();
}

/// Nothing is kept from before; frames in flight still read what was.
void Shadows::State::forget_history() {
    frames.retire(history);
    history = std::make_shared<History>(*device);
}

std::shared_ptr<const PreparedRecipe> Shadows::State::load(const std::string& text) const {
    if (baked != nullptr) {
        demand_recipe(*baked, text);
    }
    Recipe loaded = load_recipe(text, baked != nullptr ? baked->folder() : info.data);
    check_parts(loaded);
    auto prepared = std::make_shared<const PreparedRecipe>(*device, std::move(loaded));
    if (baked != nullptr) {
        demand_shaders(*prepared);
    }
    return prepared;
}

std::string Shadows::State::missing_from(const PreparedRecipe& with, const MissingShader& missing) const {
    const std::string text = text_of(with.recipe());
    return fmt::format("recipe '{}': {}; this makes it: {}", text, missing.what(), baked->command_with(text));
}

void Shadows::State::set(std::shared_ptr<const PreparedRecipe> next) {
    awaited.reset();
    failed.clear();
    frames.retire(recipe);
    recipe = std::move(next);
    forget_history();
}

void Shadows::State::check(const Frame& frame) const {
    const Receivers& seen = frame.receivers;
    const Limits& limits = info.limits;
    if (seen.width == 0 || seen.height == 0 || seen.width > limits.width || seen.height > limits.height) {
        fail("the frame's receivers are {} x {} pixels; the limits given to create allow 1 x 1 to {} x {}", seen.width,
             seen.height, limits.width, limits.height);
    }
    if (frame.lights.size() > limits.lights) {
        fail("the frame has {} lights; the limits given to create allow {}", frame.lights.size(), limits.lights);
    }
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (frame.lights[i].id == frame.lights[j].id) {
                fail("lights {} and {} of the frame have the same id {}; every light needs one of its own", j, i,
                     frame.lights[i].id);
            }
        }
    }
}

namespace {

std::vector<FrameLight> take_lights(Scene& scene, const Frame& frame) {
    scene.lights.resize(frame.lights.size());
    std::vector<FrameLight> lights;
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        scene.lights[i].name = fmt::format("{}", frame.lights[i].id);
        scene.lights[i].shape = frame.lights[i].shape;
        lights.push_back({&scene.lights[i], frame.lights[i].id});
    }
    return lights;
}

}  // namespace

Foreseen Shadows::State::declare(FrameGraph& graph, const Lenders& lenders, const Frame& frame,
                                 const PreparedRecipe& with) const {
    // What the renderer lends.
    graph.group("lent");
    const SceneHandles geometry = lenders.casters.add(graph, lenders.frames, frame.casters);
    const TextureHandle depth =
        lenders.images.import(graph, "depth", frame.receivers.depth, VK_IMAGE_USAGE_SAMPLED_BIT);
    const TextureHandle normals =
        info.receivers.normals != Normals::none
            ? lenders.images.import(graph, "normals", frame.receivers.normals, VK_IMAGE_USAGE_SAMPLED_BIT)
            : TextureHandle{};
    const ViewSamples receivers =
        add_lent_receivers(graph, info.receivers, frame.receivers, depth, normals, frame.casters.bounds_ws, &with);

    // The shadows.
    const std::vector<FrameLight> lights = take_lights(lenders.casters.scene(), frame);
    const std::vector<LightShadow> shadows = add_frame(graph, receivers, {lenders.casters.scene(), geometry}, lights,
                                                       with, &lenders.history, &lenders.late_remarks);

    // What it gets.
    graph.group("lent");
    Foreseen declared;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const TextureHandle target =
            lenders.images.import(graph, "visibility", frame.lights[i].visibility, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        add_copy(graph, shadows[i].refused.empty() ? shadows[i].visibility.image : TextureHandle{}, target, &with);
        declared.refused.push_back(shadows[i].refused);
    }
    declared.casters = geometry.drawn != nullptr ? geometry.drawn->formats : CasterFormats{};
    return declared;
}

Foreseen Shadows::State::declare_lit(FrameGraph& graph, const Frame& frame) {
    Foreseen declared;
    graph.group("lent");
    for (const LentLight& light : frame.lights) {
        const TextureHandle target =
            images.import(graph, "visibility", light.visibility, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        add_copy(graph, {}, target, nullptr);
        declared.refused.push_back(
            awaited != nullptr ? fmt::format("the pipelines of recipe '{}' are being made; until they are there V is 1",
                                             text_of(awaited->recipe()))
                               : failed);
    }
    return declared;
}

Foreseen Shadows::State::begin(FrameGraph& graph, const Frame& frame) {
    check(frame);
    frames.begin(frame.slot);
    images.begin(frame.receivers.width, frame.receivers.height);
    if (frame.cut) {
        forget_history();
    }
    take_awaited(frame);
    return recipe != nullptr ? declare(graph, {frames, images, casters, *history, late_remarks}, frame, *recipe)
                             : declare_lit(graph, frame);
}

std::vector<std::string> Shadows::State::record(VkCommandBuffer commands, const Frame& frame) {
    FrameGraph graph(*device);
    Foreseen declared = begin(graph, frame);
    memory_barrier(commands, all_writes, all_uses);
    try {
        graph.record(frames, commands);
    } catch (const MissingShader& missing) {
        fail("{}", missing_from(*recipe, missing));
    }
    images.give_back(commands);
    history->advance();
    return std::move(declared.refused);
}

std::size_t Shadows::State::reload() {
    compiler.reset();  // shaders are compiled by one thread at a time
    Reloaded reloaded = reload_shaders(*device);
    if (reloaded.shaders > 0) {
        frames.retire(std::move(reloaded.before));
        forget_history();
        casters.forget();
    }
    return reloaded.shaders;
}

Shadows::Shadows(std::unique_ptr<State> state) : state_(std::move(state)) {}
Shadows::Shadows(Shadows&&) noexcept = default;
Shadows& Shadows::operator=(Shadows&&) noexcept = default;
Shadows::~Shadows() = default;

Result<Shadows> Shadows::create(const Info& info) noexcept {
    return create(info, nullptr);
}

Result<Shadows> Shadows::create(const Info& info, std::unique_ptr<Device> device) noexcept {
    return guarded<Shadows>([&] {
        auto baked = info.baked.empty() ? nullptr : std::make_shared<const BakedShaders>(info.baked);
        auto state = std::make_unique<State>(info, std::move(baked), std::move(device));
        auto recipe = state->load(info.recipe);
        info.in_background ? state->await(std::move(recipe)) : state->set(std::move(recipe));
        return Shadows(std::move(state));
    });
}

Result<Done> Shadows::set_recipe(const std::string& recipe) noexcept {
    return guarded<Done>([&] {
        state_->set(state_->load(recipe));
        return Done{};
    });
}

void Shadows::forget_images() noexcept {
    (void)guarded<Done>([&] {
        state_->images.forget();
        return Done{};
    });
}

std::string Shadows::refuses(const GnLight& light) const noexcept {
    const Result<Done> checked = guarded<Done>([&] {
        Scene scene;
        scene.materials.emplace_back();
        scene.lights = {Light{.name = "asked", .shape = light}};
        check_recipe(state_->present().recipe(), scene, scene.lights.front(), *state_->device);
        return Done{};
    });
    return checked.ok() ? "" : checked.why();
}

Result<std::vector<std::string>> Shadows::record(VkCommandBuffer commands, const Frame& frame) noexcept {
    auto recorded = guarded<std::vector<std::string>>([&] { return state_->record(commands, frame); });
    if (!recorded.ok()) {
        // Nothing says how far its commands came: what they would have made is made with the next.
        (void)guarded<Done>([&] {
            state_->casters.forget();
            state_->forget_history();
            return Done{};
        });
    }
    return recorded;
}

Result<std::size_t> Shadows::reload() noexcept {
    return guarded<std::size_t>([&] { return state_->reload(); });
}

Result<std::vector<std::string>> Shadows::rehearse(const Frame& frame,
                                                   const std::function<void(const ShaderSource&)>& found) noexcept {
    return guarded<std::vector<std::string>>([&] {
        FrameGraph graph(*state_->device);
        Foreseen declared = state_->begin(graph, frame);
        graph.find_shaders(found);
        state_->history->advance();
        return std::move(declared.refused);
    });
}

GraphStatistics Shadows::completed(std::uint32_t slot) const noexcept {
    const auto asked = guarded<GraphStatistics>([&] { return state_->frames.completed(slot); });
    return asked.ok() ? asked.value() : GraphStatistics{};
}

std::vector<std::string> Shadows::remarks() const noexcept {
    const auto asked = guarded<std::vector<std::string>>(
        [&] { return std::vector<std::string>(state_->late_remarks.begin(), state_->late_remarks.end()); });
    return asked.ok() ? asked.value() : std::vector<std::string>{};
}

Counters Shadows::counters() const noexcept {
    return state_->device->counters();
}

}  // namespace gn::embed
