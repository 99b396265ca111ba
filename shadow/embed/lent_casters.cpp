// SPDX-License-Identifier: MIT
#include "shadow/embed/lent_casters.h"

#include "gpu/shader_inputs.h"
#include "shadow/embed/lent_images.h"

namespace gn::embed {
namespace {

/// As GnLentObject of lent_casters.glsl.
struct LentObject {
    std::uint32_t first_index, first_vertex, vertex_count, transform, out_index, out_vertex;
};

constexpr std::uint32_t opaque_white = 0xFFFFFFFF;

constexpr const char* find_text = R"(
layout(local_size_x = 64) in;
// Where buffers begin is pushed, in words: a renderer may move through a ring of them.
layout(push_constant) uniform Push {
    uint count, objects, row;
    uint first, stride;
    uint first_transform;
} push;
// Work beyond the most groups of one axis lies in further rows.
uint work() { return gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * push.row; }
uint first_of(uint i);
// The last object that begins at or before a place.
uint object_at(uint place) {
    uint low = 0, high = push.objects - 1;
    while (low < high) {
        uint middle = (low + high + 1) / 2;
        if (first_of(middle) <= place) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    return low;
}
)";

constexpr const char* positions_text = R"(
uint first_of(uint i) { return objects[i].out_vertex; }
void main() {
    uint vertex = work();
    if (vertex >= push.count) {
        return;
    }
    GnLentObject o = objects[object_at(vertex)];
    uint word = push.first + push.stride * (o.first_vertex + vertex - o.out_vertex);
    vec3 p_os = vec3(positions_os[word], positions_os[word + 1], positions_os[word + 2]);
    uint m = push.first_transform + 16 * o.transform;
    mat4x3 ws_from_os = mat4x3(transforms[m], transforms[m + 1], transforms[m + 2], transforms[m + 4], transforms[m + 5],
                               transforms[m + 6], transforms[m + 8], transforms[m + 9], transforms[m + 10],
                               transforms[m + 12], transforms[m + 13], transforms[m + 14]);
    positions_ws[vertex] = ws_from_os * vec4(p_os, 1.0);
}
)";

constexpr const char* indices_text = R"(
uint first_of(uint i) { return objects[i].out_index; }
void main() {
    uint place = work();
    if (place >= push.count) {
        return;
    }
    GnLentObject o = objects[object_at(place)];
    uint index = lent_indices[push.first + o.first_index + place - o.out_index];
    indices[place] = o.out_vertex + min(index, o.vertex_count - 1);
}
)";

void check_ranges(const CasterBuffers& casters) {
    if (casters.stride < 12 || casters.stride % 4 != 0) {
        fail("the casters' positions are {} bytes apart; a multiple of 4, 12 or more, is needed", casters.stride);
    }
    const std::uint64_t vertices =
        casters.positions.bytes / casters.stride + (casters.positions.bytes % casters.stride >= 12 ? 1 : 0);
    const std::uint64_t indices = casters.indices.bytes / 4;
    for (std::size_t i = 0; i < casters.objects.size(); ++i) {
        const CasterObject& o = casters.objects[i];
        if (o.index_count % 3 != 0) {
            fail("caster object {} has {} indices; triangles have three each", i, o.index_count);
        }
        if (std::uint64_t{o.first_index} + o.index_count > indices ||
            std::uint64_t{o.first_vertex} + o.vertex_count > vertices) {
            fail(
                "caster object {} reads indices {} to {} of {} and vertices {} to {} of {}; ranges must lie in the "
                "buffers",
                i, o.first_index, std::uint64_t{o.first_index} + o.index_count, indices, o.first_vertex,
                std::uint64_t{o.first_vertex} + o.vertex_count, vertices);
        }
    }
}

/// What may change in every frame.
void check_poses(const CasterBuffers& casters) {
    if (!casters.draw && casters.objects.size() * sizeof(mat4) > casters.transforms.bytes) {
        fail("the casters' transforms are {} bytes; {} objects need {}", casters.transforms.bytes,
             casters.objects.size(), casters.objects.size() * sizeof(mat4));
    }
    if (casters.bounds_ws.empty()) {
        fail("the casters' bounds are empty; give a box around all objects and all that the camera sees");
    }
}

/// The boxes of what moved since the frame before; unset where anything may have.
std::optional<std::vector<Box>> moved_of(const CasterBuffers& casters, bool rebuilt) {
    if (rebuilt || !casters.moved_ws) {
        return {};
    }
    return std::vector<Box>(casters.moved_ws->begin(), casters.moved_ws->end());
}

/// Where lent buffers begin, in words; positions and indices are never read by one pass.
struct Begins {
    std::uint32_t first = 0, stride = 0, first_transform = 0;
};

std::uint32_t word_of(VkDeviceSize bytes) {
    return static_cast<std::uint32_t>(bytes / 4);
}

/// Dispatches over `count` invocations of 64 a group, in as many rows as it takes.
void dispatch_over(Recorder& r, std::uint32_t count, std::uint32_t objects, const Begins& begins) {
    constexpr std::uint32_t most = 65535;
    const std::uint32_t groups = (count + 63) / 64;
    const std::uint32_t across = std::min(groups, most);
    const std::array<std::uint32_t, 6> push{count,        objects,       across * 64,
                                            begins.first, begins.stride, begins.first_transform};
    r.push_value(push);
    r.dispatch(across, (groups + across - 1) / across);
}

ComputeDesc composed(const char* name, const ShaderInputs& inputs, const char* text) {
    return sealed(ComputeDesc{
        {ShaderKind::compute, name, "#include \"shadow/embed/lent_casters.glsl\"\n" + inputs.text() + find_text + text},
        {}});
}

/// Both shaders, composed once: what their inputs declare never changes.
const ComputeDesc& indices_shader(const ShaderInputs& inputs) {
    static const ComputeDesc shader = composed("lent indices", inputs, indices_text);
    return shader;
}
const ComputeDesc& positions_shader(const ShaderInputs& inputs) {
    static const ComputeDesc shader = composed("lent positions", inputs, positions_text);
    return shader;
}

}  // namespace

LentCasters::LentCasters(Device& device)
    : LentCasters(device,
                  std::make_shared<Buffer>(
                      device, BufferDesc{.name = "no attributes", .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}),
                  std::make_shared<Texture2D>(upload_texture(
                      device, {.name = "white", .format = VK_FORMAT_R8G8B8A8_SRGB, .usage = VK_IMAGE_USAGE_SAMPLED_BIT},
                      std::as_bytes(std::span(&opaque_white, 1)))),
                  false) {}

LentCasters LentCasters::twin() const {
    return {device_, empty_, white_, true};
}

LentCasters::LentCasters(Device& device, std::shared_ptr<Buffer> empty, std::shared_ptr<Texture2D> white, bool foreseen)
    : device_(device), empty_(std::move(empty)), white_(std::move(white)), foreseen_(foreseen) {
    scene_.name = "lent";
    scene_.materials = {Material{.name = "both sides"}, Material{.name = "one side", .double_sided = false}};
}

std::shared_ptr<Buffer> LentCasters::borrow(const char* name, const LentBuffer& lent) const {
    const bool missing = lent.buffer == VK_NULL_HANDLE && !foreseen_;
    if (missing || lent.offset % 4 != 0) {
        fail("the casters' {} are {}; give a buffer and an offset in whole words", name,
             missing ? "no buffer" : fmt::format("at byte {}", lent.offset));
    }
    const VkDeviceSize most = device_.properties().limits.maxStorageBufferRange;
    if (lent.bytes > most || lent.offset > most - lent.bytes) {
        fail("the casters' {} reach from byte {} over {} bytes; device '{}' lets shaders read the first {} of a buffer",
             name, lent.offset, lent.bytes, device_.info().name, most);
    }
    return std::make_shared<Buffer>(Buffer::borrow({.name = fmt::format("{}{}", lent_mark, name),
                                                    .bytes = lent.offset + lent.bytes,
                                                    .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT},
                                                   lent.buffer));
}

void LentCasters::rebuild(Frames& frames, std::span<const CasterObject> objects) {
    // Objects lie behind each other; runs of the same sidedness are drawn as one.
    std::vector<LentObject> table;
    scene_.objects.clear();
    vertices_ = index_count_ = 0;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const CasterObject& o = objects[i];
        if (o.index_count == 0 || o.vertex_count == 0) {
            continue;
        }
        const int material = o.single_sided ? 1 : 0;
        if (scene_.objects.empty() || scene_.objects.back().material != material) {
            scene_.objects.push_back(
                {.name = "lent", .first_triangle = index_count_ / 3, .triangle_count = 0, .material = material});
        }
        scene_.objects.back().triangle_count += o.index_count / 3;
        table.push_back(
            {o.first_index, o.first_vertex, o.vertex_count, static_cast<std::uint32_t>(i), index_count_, vertices_});
        vertices_ += o.vertex_count;
        index_count_ += o.index_count;
    }
    const auto bytes = std::as_bytes(std::span(table));
    table_.assign(bytes.begin(), bytes.end());

    frames.retire(positions_);
    frames.retire(indices_);
    constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    positions_ =
        std::make_shared<Buffer>(device_, BufferDesc{.name = "casters' positions",
                                                     .bytes = std::max<VkDeviceSize>(vertices_, 1) * sizeof(vec3),
                                                     .usage = storage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT});
    indices_ = std::make_shared<Buffer>(device_, BufferDesc{.name = "casters' indices",
                                                            .bytes = std::max<VkDeviceSize>(index_count_, 3) * 4,
                                                            .usage = storage | VK_BUFFER_USAGE_INDEX_BUFFER_BIT});
    poses_.reset();
}

SceneHandles LentCasters::add(FrameGraph& graph, Frames& frames, const CasterBuffers& casters) {
    const bool drawn = static_cast<bool>(casters.draw);
    const bool rebuilt = topology_ != casters.topology || drawn_ != drawn;
    if (rebuilt) {
        if (!drawn) {
            check_ranges(casters);
        }
        rebuild(frames, drawn ? std::span<const CasterObject>() : casters.objects);
        topology_ = casters.topology;
        drawn_ = drawn;
    }
    if (drawn && scene_.objects.empty()) {
        scene_.objects.push_back({.name = "drawn"});
    }
    check_poses(casters);
    const bool moved = poses_ != casters.poses;
    scene_.bounds_ws = casters.bounds_ws;
    for (Object& object : scene_.objects) {
        object.bounds_ws = casters.bounds_ws;
    }

    const BufferHandle positions = graph.import(*positions_), indices = graph.import(*indices_);
    const auto objects = static_cast<std::uint32_t>(table_.size() / sizeof(LentObject));
    const auto add_pass = [&](const char* name, const auto& shader_of, ShaderInputs inputs, std::uint32_t count,
                              const Begins& begins) {
        inputs.block("readonly buffer", "Objects", "GnLentObject objects[];", table_);
        graph.add_pass(
            name, [&](PassBuilder& pass) { inputs.declare(pass); },
            [=, &shader = shader_of(inputs)](Recorder& r) {
                r.bind(shader);
                inputs.set(r);
                dispatch_over(r, count, objects, begins);
            });
    };
    if (rebuilt && index_count_ > 0) {
        ShaderInputs inputs;
        const auto lent = borrow("indices", casters.indices);
        graph.hold(lent);
        inputs.buffer("readonly buffer", "LentIndices", "uint lent_indices[];", graph.import(*lent));
        inputs.buffer("writeonly buffer", "Indices", "uint indices[];", indices);
        add_pass("lent indices", indices_shader, inputs, index_count_, {.first = word_of(casters.indices.offset)});
    }
    if (moved && vertices_ > 0) {
        ShaderInputs inputs;
        const auto lent = borrow("positions", casters.positions);
        const auto poses = borrow("transforms", casters.transforms);
        graph.hold(lent);
        graph.hold(poses);
        inputs.buffer("readonly buffer", "LentPositions", "float positions_os[];", graph.import(*lent));
        inputs.buffer("readonly buffer", "LentTransforms", "float transforms[];", graph.import(*poses));
        inputs.buffer("writeonly buffer", "Positions", "vec3 positions_ws[];", positions);
        add_pass("lent positions", positions_shader, inputs, vertices_,
                 {.first = word_of(casters.positions.offset),
                  .stride = word_of(casters.stride),
                  .first_transform = word_of(casters.transforms.offset)});
    }
    if (moved) {
        const std::uint64_t before = version_;
        poses_ = casters.poses;
        version_ = next_version();
        moves_->add(before, version_, moved_of(casters, rebuilt));
    }

    SceneHandles handles{.positions = positions,
                         .normals = graph.import(*empty_),
                         .uvs = graph.import(*empty_),
                         .colors = graph.import(*empty_),
                         .indices = indices};
    handles.white = graph.import(*white_);
    handles.version = version_;
    handles.derived = derived_;
    handles.moves = moves_;
    handles.drawn = drawn ? std::make_shared<DrawnCasters>(DrawnCasters{casters.draw, {}}) : nullptr;
    return handles;
}

}  // namespace gn::embed
