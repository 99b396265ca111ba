// SPDX-License-Identifier: MIT
#include "gpu/frame_graph.h"

#include "gpu/frames.h"
#include "gpu/graph_account.h"
#include "gpu/graph_builder.h"
#include "gpu/graph_executor.h"
#include "gpu/graph_plan.h"
#include "gpu/graph_rounds.h"
#include "gpu/pipeline_warmer.h"
#include "gpu/transfer.h"

#include <algorithm>

namespace gn {

struct FrameGraph::Impl {
    Device& device;
    GraphDeclaration declaration;
    Imports imports;
    std::vector<Execute> executes;
    std::vector<Answer> answers;
    std::vector<std::shared_ptr<const void>> objects;  ///< that passes use
    std::string group;
    bool rests = false;
    Rounds texture_rounds, buffer_rounds;
    PassRounds pass_rounds;

    GraphPlan plan;
    bool stale = true;  ///< declarations changed since the plan was made
    std::unique_ptr<GraphResources> resources;
    std::unique_ptr<GraphExecutor> executor;
    std::vector<std::vector<VkImageLayout>> layouts;  ///< of everything, after execute
    bool executed = false;
    GraphStatistics statistics;

    explicit Impl(Device& on) : device(on) {}

    [[nodiscard]] bool is_null() const { return device.vk() == VK_NULL_HANDLE; }

    void refresh_imports() {
        for (std::size_t i = 0; i < imports.textures.size(); ++i) {
            if (imports.textures[i] != nullptr) {
                declaration.textures[i].initial = imports.textures[i]->layouts;
            }
        }
    }

    /// Brings the plan and the Vulkan objects up to date with the declarations and the imports' layouts.
    void prepare() {
        refresh_imports();
        if (!stale) {
            synchronize(declaration, plan);
            return;
        }
        executed = false;
        resources.reset();
        if (is_null()) {
            plan = make_plan(declaration, nominal_footprints(declaration));
        } else {
            auto made = std::make_unique<GraphResources>(device, declaration, imports);
            plan = make_plan(declaration, made->footprints());
            made->bind_memory(plan);
            resources = std::move(made);
        }
        stale = false;
    }

    /// Hands the layouts that execution left back to the imported textures.
    void keep_layouts() {
        layouts = plan.final_layouts;
        for (std::size_t i = 0; i < imports.textures.size(); ++i) {
            if (imports.textures[i] != nullptr) {
                imports.textures[i]->layouts = layouts[i];
            }
        }
    }

    /// Lets the passes that somebody reads record into what records nothing.
    void run_through(SilentRecorder& recorder) const {
        for (const std::uint32_t pass : living_passes(declaration)) {
            const Calls calls = calls_of(declaration, pass);
            for (std::uint32_t round = 0; round < calls.rounds; ++round) {
                if (const Execute& execute = executes[calls.first + round * calls.step]) {
                    recorder.begin(declaration.passes[pass]);
                    execute(recorder);
                }
            }
        }
    }

    /// After a failure half-way nobody knows the layout of what would have changed: its contents are given up.
    void forget_layouts() {
        for (std::size_t i = 0; i < imports.textures.size(); ++i) {
            if (imports.textures[i] == nullptr) {
                continue;
            }
            std::vector<VkImageLayout>& held = imports.textures[i]->layouts;
            for (std::size_t s = 0; s < held.size(); ++s) {
                held[s] = held[s] == plan.final_layouts[i][s] ? held[s] : VK_IMAGE_LAYOUT_UNDEFINED;
            }
        }
    }
};

FrameGraph::FrameGraph(Device& device) : impl_(std::make_unique<Impl>(device)) {}
FrameGraph::~FrameGraph() = default;

TextureHandle FrameGraph::create(const TextureDesc& desc) {
    if (desc.width == 0 || desc.height == 0 || desc.layers == 0 || desc.mips == 0 || desc.samples == 0) {
        fail("texture '{}' of {} x {}, {} layers, {} mips, {} samples is empty; every count must be at least 1",
             desc.name, desc.width, desc.height, desc.layers, desc.mips, desc.samples);
    }
    if (const auto again = impl_->texture_rounds.take(impl_->declaration.textures, desc)) {
        return {*again};
    }
    impl_->declaration.textures.push_back({.desc = desc, .group = impl_->group});
    impl_->imports.textures.push_back(nullptr);
    impl_->stale = true;
    const auto index = static_cast<std::uint32_t>(impl_->declaration.textures.size() - 1);
    impl_->texture_rounds.made(index);
    return {index};
}

BufferHandle FrameGraph::create(const BufferDesc& wanted) {
    BufferDesc desc = wanted;
    desc.bytes = std::max<VkDeviceSize>(desc.bytes, 16);
    if (const auto again = impl_->buffer_rounds.take(impl_->declaration.buffers, desc)) {
        return {*again};
    }
    impl_->declaration.buffers.push_back({.desc = desc, .group = impl_->group});
    impl_->imports.buffers.push_back(nullptr);
    impl_->stale = true;
    const auto index = static_cast<std::uint32_t>(impl_->declaration.buffers.size() - 1);
    impl_->buffer_rounds.made(index);
    return {index};
}

void FrameGraph::begin_rounds() {
    impl_->texture_rounds.begin();
    impl_->buffer_rounds.begin();
    impl_->pass_rounds.begin();
}

void FrameGraph::next_round() {
    impl_->texture_rounds.next();
    impl_->buffer_rounds.next();
    impl_->pass_rounds.next(impl_->declaration);
}

void FrameGraph::end_rounds() {
    impl_->texture_rounds.end();
    impl_->buffer_rounds.end();
    impl_->pass_rounds.end(impl_->declaration);
}

TextureHandle FrameGraph::import(Texture2D& texture) {
    // The same texture twice is one resource, or its barriers would not see each other.
    auto& textures = impl_->imports.textures;
    const auto found = std::find(textures.begin(), textures.end(), &texture);
    if (found != textures.end()) {
        return {static_cast<std::uint32_t>(found - textures.begin())};
    }
    impl_->declaration.textures.push_back(
        {.desc = texture.desc(), .group = impl_->group, .imported = true, .initial = texture.layouts});
    textures.push_back(&texture);
    impl_->stale = true;
    return {static_cast<std::uint32_t>(textures.size() - 1)};
}

BufferHandle FrameGraph::import(const Buffer& buffer) {
    auto& buffers = impl_->imports.buffers;
    const auto found = std::find(buffers.begin(), buffers.end(), &buffer);
    if (found != buffers.end()) {
        return {static_cast<std::uint32_t>(found - buffers.begin())};
    }
    impl_->declaration.buffers.push_back({.desc = buffer.desc(), .group = impl_->group, .imported = true});
    buffers.push_back(&buffer);
    impl_->stale = true;
    return {static_cast<std::uint32_t>(buffers.size() - 1)};
}

bool FrameGraph::imported(TextureHandle texture) const {
    GN_CHECK(texture.index < impl_->imports.textures.size());
    return impl_->imports.textures[texture.index] != nullptr;
}

void FrameGraph::place(TextureHandle texture, const std::function<Texture2D&(const TextureDesc&)>& give) {
    GN_CHECK(!imported(texture) && !impl_->pass_rounds.running());
    DeclaredTexture& declared = impl_->declaration.textures[texture.index];
    TextureDesc desc = declared.desc;
    desc.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    for (const DeclaredPass& pass : impl_->declaration.passes) {
        for (const Use& use : pass.uses) {
            desc.usage |= use.texture && use.resource == texture.index ? usage_of(use.kind) : 0;
        }
    }
    Texture2D& given = give(desc);
    declared.desc = given.desc();
    declared.imported = true;
    declared.initial = given.layouts;
    impl_->imports.textures[texture.index] = &given;
    impl_->stale = true;
}

const TextureDesc& FrameGraph::desc(TextureHandle texture) const {
    GN_CHECK(texture.index < impl_->declaration.textures.size());
    return impl_->declaration.textures[texture.index].desc;
}

const BufferDesc& FrameGraph::desc(BufferHandle buffer) const {
    GN_CHECK(buffer.index < impl_->declaration.buffers.size());
    return impl_->declaration.buffers[buffer.index].desc;
}

void FrameGraph::group(std::string name) {
    impl_->group = std::move(name);
}
const std::string& FrameGraph::group() const {
    return impl_->group;
}

void FrameGraph::rest(bool rests) {
    impl_->rests = rests;
}

void FrameGraph::add_pass(std::string name, const std::function<void(PassBuilder&)>& setup,
                          std::function<void(Recorder&)> execute) {
    DeclaredPass pass{.name = std::move(name), .group = impl_->group, .uses = {}, .rests = impl_->rests};
    DeclaredPassBuilder builder(impl_->declaration, pass);
    setup(builder);
    if (impl_->pass_rounds.running()) {
        impl_->pass_rounds.add(std::move(pass));
    } else {
        impl_->declaration.passes.push_back(std::move(pass));
    }
    impl_->executes.push_back(std::move(execute));
    impl_->stale = true;
}

void FrameGraph::keep(TextureHandle texture) {
    GN_CHECK(texture.index < impl_->declaration.textures.size());
    impl_->declaration.textures[texture.index].kept = true;
    impl_->stale = true;
}

void FrameGraph::keep(BufferHandle buffer) {
    GN_CHECK(buffer.index < impl_->declaration.buffers.size());
    impl_->declaration.buffers[buffer.index].kept = true;
    impl_->stale = true;
}

void FrameGraph::answer(BufferHandle buffer, std::function<void(std::span<const std::byte>)> receive) {
    keep(buffer);
    if (impl_->rests) {
        return;  // nobody writes it
    }
    impl_->answers.push_back({buffer.index, std::move(receive)});
}

void FrameGraph::hold(std::shared_ptr<const void> object) {
    impl_->objects.push_back(std::move(object));
}

void FrameGraph::compile() {
    PipelineWarmer warmer(impl_->device, impl_->declaration);
    impl_->run_through(warmer);
}

std::vector<PipelineOrder> FrameGraph::missing() {
    PipelineFinder finder(impl_->device, impl_->declaration);
    impl_->run_through(finder);
    return std::move(finder.missing);
}

void FrameGraph::find_shaders(const std::function<void(const ShaderSource&)>& found) {
    ShaderFinder finder(impl_->declaration, found);
    impl_->run_through(finder);
}

void FrameGraph::execute(bool timed) {
    Impl& impl = *impl_;
    impl.prepare();
    if (impl.is_null()) {
        impl.statistics = account(impl.declaration, impl.plan, {});
        return;
    }
    if (!impl.executor) {
        impl.executor = std::make_unique<GraphExecutor>(impl.device);
    }
    std::vector<double> ms;
    try {
        ms = impl.executor->run(impl.declaration, impl.plan, *impl.resources, impl.executes, timed);
    } catch (...) {
        impl.forget_layouts();
        impl.executed = false;
        throw;
    }
    impl.keep_layouts();
    impl.executed = true;
    impl.statistics = account(impl.declaration, impl.plan, ms);
    for (const Answer& answer : impl.answers) {
        if (impl.plan.buffers[answer.buffer].used) {
            answer.receive(download(BufferHandle{answer.buffer}));
        }
    }
}

void FrameGraph::record(Frames& frames, VkCommandBuffer commands) {
    Impl& impl = *impl_;
    impl.refresh_imports();
    const auto& layouts = frames.write(impl.declaration, impl.imports, impl.executes, impl.answers, commands);
    for (std::size_t i = 0; i < impl.imports.textures.size(); ++i) {
        if (impl.imports.textures[i] != nullptr) {
            impl.imports.textures[i]->layouts = layouts[i];
        }
    }
    for (const std::shared_ptr<const void>& object : impl.objects) {
        frames.retire(object);
    }
}

const GraphStatistics& FrameGraph::statistics() const {
    return impl_->statistics;
}

std::vector<std::byte> FrameGraph::download(TextureHandle texture, std::uint32_t mip, std::uint32_t layer) {
    const TextureDesc& held = desc(texture);
    if (Texture2D* imported = impl_->imports.textures[texture.index]) {
        return gn::download(impl_->device, *imported, mip, layer);
    }
    if (!impl_->executed || !impl_->declaration.textures[texture.index].kept ||
        !impl_->plan.textures[texture.index].used) {
        fail("texture '{}' cannot be downloaded: keep() it, write it in a pass and execute the graph first", held.name);
    }
    std::vector<VkImageLayout>& layouts = impl_->layouts[texture.index];
    const std::size_t at = mip + std::size_t{layer} * held.mips;
    const VkImageLayout layout = at < layouts.size() ? layouts[at] : VK_IMAGE_LAYOUT_UNDEFINED;
    std::vector<std::byte> bytes =
        read_image(impl_->device, impl_->resources->image(texture.index), held, layout, mip, layer);
    layouts[at] = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    return bytes;
}

std::vector<std::byte> FrameGraph::download(BufferHandle buffer) {
    const BufferDesc& held = desc(buffer);
    if (const Buffer* imported = impl_->imports.buffers[buffer.index]) {
        return gn::download(impl_->device, *imported);
    }
    if (!impl_->executed || !impl_->declaration.buffers[buffer.index].kept || !impl_->plan.buffers[buffer.index].used) {
        fail("buffer '{}' cannot be downloaded: keep() it, write it in a pass and execute the graph first", held.name);
    }
    return read_buffer(impl_->device, impl_->resources->buffer(buffer.index), held.bytes);
}

std::string FrameGraph::describe() const {
    impl_->prepare();
    return gn::describe(impl_->declaration, impl_->plan);
}

const GraphPlan& FrameGraph::plan() {
    impl_->prepare();
    impl_->statistics = account(impl_->declaration, impl_->plan, {});
    return impl_->plan;
}

Device& FrameGraph::device() {
    return impl_->device;
}

}  // namespace gn
