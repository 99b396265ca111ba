// SPDX-License-Identifier: MIT
#include "apps/view/viewport.h"

#include "apps/view/display.h"
#include "shadow/show/show.h"
#include "shadow/view/read_back.h"

#include <algorithm>

namespace gn {
namespace {

template <class T>
std::vector<T> values_of(std::span<const std::byte> bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

TextureDesc shown_desc(uint width, uint height) {
    return {.name = "shown",
            .format = VK_FORMAT_R8G8B8A8_UNORM,
            .width = width,
            .height = height,
            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
}

/// A picture of the hidden as a texture: display-ready values.
Texture2D texture_of(Device& device, const Image& picture) {
    std::vector<std::uint8_t> texels(4 * picture.pixels(), 255);
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            texels[4 * i + c] =
                static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(picture.values[3 * i + c], 0.0F, 1.0F)));
        }
    }
    TextureDesc desc = shown_desc(static_cast<uint>(picture.width), static_cast<uint>(picture.height));
    desc.name = "hidden";
    return upload_texture(device, desc, std::as_bytes(std::span(texels)));
}

}  // namespace

Viewport::Viewport(Device& device, World& world, const ViewportSetup& setup, std::uint32_t frames_in_flight)
    : recipe(device),
      other(device),
      camera(world.scene.camera(setup.view)),
      show(setup.show),
      device_(device),
      world_(world),
      frames_(device, frames_in_flight) {
    if (!setup.camera.empty()) {
        camera = parse_camera(setup.camera, camera);
    }
    if (!show.empty()) {
        find_hidden(show);
    }
    recipe.ask(RecipeText::parse(setup.recipe));
}

void Viewport::begin(std::uint32_t slot) {
    slot_ = slot;
    frames_.begin(slot);
    const GraphStatistics& completed = frames_.completed(slot);
    if (device_.has(Feature::timestamps)) {
        average(completed);
    } else if (!completed.resources.empty()) {
        costs_.resources = completed.resources;
        costs_.transient_bytes = completed.transient_bytes;
    }
}

void Viewport::cut() {
    for (LiveRecipe* live : {&recipe, &other}) {
        if (live->now() != nullptr) {
            live->forget();
        }
    }
}

bool Viewport::coloured() const {
    return recipe.now() != nullptr && recipe.now()->recipe().translucent_map != nullptr;
}

std::set<std::string> Viewport::remarks() const {
    return *late_remarks_;
}

ViewSamples Viewport::add_samples(FrameGraph& graph, FrameCasters& casters) {
    return add_view_samples(graph, world_.gpu, casters.handles, camera, width, height);
}

Viewport::Side Viewport::add_side(FrameGraph& graph, const ViewSamples& samples, const FrameCasters& casters,
                                  const PreparedRecipe& with, History& history, std::vector<std::string>* refused) {
    Side side;
    if (refused != nullptr) {
        refused->clear();
    }
    for (const LightShadow& shadow :
         add_frame(graph, samples, casters, lights_of(world_.scene), with, &history, late_remarks_.get())) {
        side.visibility.push_back(shadow.visibility.image);
        if (refused != nullptr) {
            refused->push_back(shadow.refused);
        }
    }
    graph.group("shading");
    FrameInput input{device_, graph, world_.scene, casters.handles, samples};
    input.prepared = &with;
    side.picture = add_shading(input, side.visibility);
    return side;
}

TextureHandle Viewport::add_truth(FrameGraph& graph, const ViewSamples& samples, const FrameCasters& casters,
                                  const SharedView& shared, std::vector<TextureHandle>& visibility) {
    graph.group("truth");
    graph.hold(shared.truth);
    for (Texture2D& texture : shared.truth->visibility) {
        visibility.push_back(graph.import(texture));
    }
    FrameInput input{device_, graph, world_.scene, casters.handles, samples};
    input.prepared = recipe.now().get();
    return add_shading(input, visibility);
}

void Viewport::take_recipes(PipelineCompiler& compiler, const SharedView& shared) {
    try {
        recipe.take(compiler, [&](FrameGraph& graph, const PreparedRecipe& with, History& history) {
            graph.group("scene");
            FrameCasters casters{world_.scene, import_scene(graph, world_.gpu)};
            const ViewSamples samples = add_samples(graph, casters);
            const Side side = add_side(graph, samples, casters, with, history, nullptr);
            const BufferHandle exposure = graph.import(*shared.exposure);
            add_exposure(graph, with, side.picture, exposure);
            add_display(graph, with, {.picture = side.picture, .exposure = exposure, .target = graph.import(*shown_)});
        });
    } catch (const Error& error) {
        trouble = error.what();
        if (recipe.now() == nullptr) {
            throw;
        }
    }
    if (shared.against != Against::recipe) {
        return;
    }
    try {
        other.take(compiler, [&](FrameGraph& graph, const PreparedRecipe& with, History& history) {
            FrameCasters casters{world_.scene, import_scene(graph, world_.gpu)};
            const ViewSamples samples = add_samples(graph, casters);
            graph.keep(add_side(graph, samples, casters, with, history, nullptr).picture);
        });
    } catch (const Error& error) {
        trouble = error.what();
    }
}

void Viewport::declare(FrameGraph& graph, const SharedView& shared, bool sets_exposure) {
    // What is seen, with the shadows of the recipe: the frame that hosts embed.
    const PreparedRecipe& with = *recipe.now();
    graph.group("scene");
    FrameCasters casters{world_.scene, import_scene(graph, world_.gpu)};
    const ViewSamples samples = add_samples(graph, casters);
    const Side side = add_side(graph, samples, casters, with, *recipe.history(), &refused_);

    // What it is held against.
    Side beside;
    if (shared.against == Against::recipe && other.now() != nullptr) {
        beside = add_side(graph, samples, casters, *other.now(), *other.history(), nullptr);
    } else if (shared.against == Against::truth && shared.truth != nullptr) {
        beside.picture = add_truth(graph, samples, casters, shared, beside.visibility);
    }

    // What the window shows of both.
    graph.group("display");
    const BufferHandle exposure = graph.import(*shared.exposure);
    if (sets_exposure) {
        add_exposure(graph, with, side.picture, exposure);
    }
    DisplayInputs inputs{.picture = side.picture,
                         .beside = beside.picture,
                         .exposure = exposure,
                         .stops = shared.stops,
                         .split = beside.picture.valid() ? shared.split : 1.0F,
                         .target = graph.import(*shown_)};
    if (shared.error && shared.light < beside.visibility.size()) {
        inputs.visibility = side.visibility.at(shared.light);
        inputs.visibility_b = beside.visibility[shared.light];
    }
    add_display(graph, with, inputs);
    answer(graph, samples, side.picture);
}

void Viewport::answer(FrameGraph& graph, const ViewSamples& samples, TextureHandle picture) {
    if (receive_picture_) {
        Image image(static_cast<int>(width), static_cast<int>(height), 4);
        add_answer(graph, picture, [image, receive = std::exchange(receive_picture_, {})](auto bytes) mutable {
            image.values = values_of<float>(bytes);
            receive(without_alpha(image));
        });
    }
    if (receive_samples_) {
        auto found = std::make_shared<CpuSamples>();
        found->width = width;
        found->height = height;
        found->camera = camera;
        add_answer(graph, samples.position, [found](auto bytes) { found->position_ws = values_of<vec4>(bytes); });
        add_answer(graph, samples.normal, [found, receive = std::exchange(receive_samples_, {})](auto bytes) {
            found->normal_ws = values_of<vec4>(bytes);
            receive(std::move(*found));
        });
    }
}

void Viewport::make_shown() {
    const TextureDesc desc = shown_desc(width, height);
    if (shown_ == nullptr || (show.empty() && !serves(shown_->desc(), desc))) {
        frames_.retire(std::exchange(shown_, std::make_shared<Texture2D>(device_, desc)));
    }
}

void Viewport::draw(VkCommandBuffer commands, PipelineCompiler& compiler, const SharedView& shared,
                    bool sets_exposure) {
    trouble.clear();
    make_shown();
    take_recipes(compiler, shared);
    if (!show.empty()) {
        draw_hidden(shared);
        return;
    }
    hidden_key_.clear();
    legend.clear();
    FrameGraph graph(device_);
    declare(graph, shared, sets_exposure);
    if (shared.measures) {
        graph.execute(true);
        average(graph.statistics());
    } else {
        graph.record(frames_, commands);
    }
    // Frames in flight use what these hold.
    for (LiveRecipe* live : {&recipe, &other}) {
        if (live->now() != nullptr) {
            frames_.retire(live->now());
            frames_.retire(live->history());
            live->history()->advance();
        }
    }
    frames_.retire(late_remarks_);
    frames_.retire(shown_);
}

void Viewport::draw_hidden(const SharedView& shared) {
    const std::string key = fmt::format(
        "{} {} {} {}x{} {} {} {}", show, recipe.now()->recipe().name + "," + recipe.now()->recipe().overrides,
        text_of(camera), width, height, shared.light, world_.lights_version, world_.gpu.version);
    if (key == hidden_key_) {
        return;
    }
    hidden_key_ = key;
    try {
        const std::vector<Shown> pictures = show_hidden(device_, world_.gpu, camera, recipe.now()->recipe(), {&show, 1},
                                                        {.width = width, .height = height, .light = shared.light});
        frames_.retire(
            std::exchange(shown_, std::make_shared<Texture2D>(texture_of(device_, pictures.front().picture))));
        legend = pictures.front().legend;
    } catch (const Error& error) {
        legend = error.what();
        frames_.retire(std::exchange(shown_, std::make_shared<Texture2D>(texture_of(device_, Image(8, 8, 3, 0.1F)))));
    }
}

void Viewport::average(const GraphStatistics& completed) {
    if (completed.passes.empty()) {
        return;
    }
    constexpr std::size_t frames = 10;
    const auto same = [&](const GraphStatistics& o) {
        return std::equal(o.passes.begin(), o.passes.end(), completed.passes.begin(), completed.passes.end(),
                          [](const PassTime& a, const PassTime& b) { return a.name == b.name; });
    };
    if (!completed_.empty() && !same(completed_.front())) {
        completed_.clear();
    }
    completed_.push_back(completed);
    completed_.erase(completed_.begin(),
                     completed_.end() - static_cast<std::ptrdiff_t>(std::min(frames, completed_.size())));
    costs_ = completed;
    for (std::size_t i = 0; i < costs_.passes.size(); ++i) {
        double sum = 0;
        for (const GraphStatistics& one : completed_) {
            sum += one.passes[i].ms;
        }
        costs_.passes[i].ms = sum / static_cast<double>(completed_.size());
    }
}

}  // namespace gn
