// SPDX-License-Identifier: MIT
// The boundary to a renderer that keeps its own G-buffer, casters, command buffers and frames in flight. It lends them, and
// gets V of every light, recorded into its own command buffer. (shadow/embed/host.h is the offline session: it draws the
// view itself, waits, and reads back.)
//
//     auto shadows = gn::embed::Shadows::create({.device = ..., .recipe = "cascades", .limits = {.frames_in_flight = 2}});
//     if (!shadows.ok()) { log(shadows.why()); }
//     for (;;) {
//         wait_for(fences[slot]);                                    // the renderer's own
//         ... draw depth and normals ...
//         const auto recorded = shadows.value().record(commands, {.slot = slot, .receivers = ..., .casters = ..., .lights = ...});
//         ... shade with the images of V, submit ...
//     }
//
// No exception leaves it; every failure is one sentence. Recording never submits and never waits; where sizes, formats,
// topology and lights' kinds stay what they were, it creates nothing on the device. Nothing is moved or made up.
#pragma once

#include "gpu/device.h"
#include "gpu/frame_graph.h"
#include "shadow/casters/drawn.h"
#include "shadow/embed/result.h"
#include "shadow/scene/scene.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gn::embed {

/// How a renderer stores its normals: world space, unit. They need not be geometric, but biases trust them.
enum class Normals {
    none,                 ///< there are none: the depth's neighbours tell them
    signed_xyz,           ///< xyz in [-1,1]: float or snorm formats
    unsigned_xyz,         ///< xyz in [0,1], 0.5 means 0
    signed_octahedral,    ///< two components in [-1,1] [Meyer et al. 2010]
    unsigned_octahedral,  ///< the same in [0,1]
};

/// The form of the renderer's depth and normals.
struct ReceiverForm {
    bool reversed_depth = true;  ///< near is 1, far and nothing are 0; false: near is 0, far and nothing are 1
    Normals normals = Normals::signed_xyz;
};

/// What create makes room for; a frame beyond it is refused with a sentence.
struct Limits {
    uint width = 1920, height = 1080;  ///< pixels
    uint lights = 8;
    uint frames_in_flight = 2;  ///< 1 to 8
};

struct Info {
    AdoptedDevice device;
    std::string recipe = "pcf";  ///< a name or a file, with overrides
    /// The recipe's pipelines are made by a thread, as prepare_recipe makes another one's: until all are there V is 1, and record
    /// says so for every light. Else the first frame of a kind waits for what it binds.
    bool in_background = false;
    Limits limits;
    ReceiverForm receivers;
    /// A folder that `gnomon bake` wrote for the recipes: compiled shaders and the recipes' files. Then nothing is compiled, and
    /// no other file is read; a recipe of which a shader is missing is refused when it is chosen.
    std::filesystem::path baked;
    /// Without `baked`: the folder of recipes/ and of the shader functions; empty: the program's own (base/paths.h).
    std::filesystem::path data;
};

/// An image of the renderer's: one mip and one layer of it.
struct LentImage {
    VkImage image = VK_NULL_HANDLE;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkImageLayout before = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;  ///< in which it is when record's commands begin
    VkImageLayout after = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;   ///< in which they leave it
};

/// What receives shadows: all that the camera sees.
struct Receivers {
    uint width = 0, height = 0;
    LentImage depth;    ///< made with VK_IMAGE_USAGE_SAMPLED_BIT
    LentImage normals;  ///< likewise; not read where the form says none
    /// Vulkan's clip space, y downwards, from the space that casters and lights are given in: perspective (an infinite far
    /// plane is fine) or orthographic, with square pixels, jittered or not.
    mat4 cs_from_ws{1};
    /// Clip space of the frame before, from this frame's world space. Unset: as that frame said, which is right where the origin
    /// of the coordinates stays.
    std::optional<mat4> before_cs_from_ws{};
};

/// A buffer of the renderer's, made with VK_BUFFER_USAGE_STORAGE_BUFFER_BIT.
struct LentBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;  ///< bytes; a multiple of 4
    VkDeviceSize bytes = 0;
};

/// What one draw of the renderer's draws: triangles of one mesh under one transform.
struct CasterObject {
    std::uint32_t first_index = 0, index_count = 0;    ///< a multiple of three; indices count from first_vertex
    std::uint32_t first_vertex = 0, vertex_count = 0;  ///< several objects may share a mesh
    bool single_sided = false;                         ///< casts from its front alone
};

/// What casts shadows: all objects, at their places of this frame. Either the renderer's buffers hold them, or `draw` draws
/// them into views of the lights that are ready for it; then buffers and objects are not read.
struct CasterBuffers {
    LentBuffer positions;       ///< three floats at the begin of every `stride` bytes, object space
    std::uint32_t stride = 12;  ///< bytes, a multiple of 4
    LentBuffer indices;         ///< 32 bits each
    /// A mat4 for every object, columns first: ws_from_os, affine. It may lie elsewhere in every frame.
    LentBuffer transforms;
    std::span<const CasterObject> objects;
    Box bounds_ws;  ///< of all objects and of all that the camera sees, in this frame
    /// Another number whenever objects, indices, or the buffers of positions and indices change.
    std::uint64_t topology = 0;
    /// Another number whenever positions or transforms change: else maps may be kept.
    std::uint64_t poses = 0;
    /// Boxes in which all that moved since the frame recorded last lay then, and in which it lies now: kept maps are drawn anew
    /// there alone. Unset: anything may have moved. Not read where poses are what they were.
    std::optional<std::span<const Box>> moved_ws{};
    /// Called while record runs, once a view that must be drawn: records into view.commands draws of all that casts, with
    /// pipelines that match Foreseen::casters. It may bind what it likes, must not end rendering, and what it throws becomes
    /// record's sentence. Maps that depths alone do not tell, curved views and parts that need geometry refuse it by name.
    CasterFunction draw{};
};

struct LentLight {
    std::uint64_t id = 0;  ///< the same in every frame; keys what is kept for the light, in whatever order lights come
    GnLight shape;
    /// Where V goes: 1 lit, 0 in shadow or turned away. Any format that can be drawn to, of the receivers' size, made with
    /// VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT.
    LentImage visibility;
};

struct Frame {
    std::uint32_t slot = 0;  ///< below frames_in_flight; the device has finished what was recorded with it last
    bool cut = false;        ///< the camera jumped, or the origin of the coordinates moved: nothing is kept from before
    Receivers receivers;
    CasterBuffers casters;
    std::span<const LentLight> lights;
};

/// What a frame will ask for, known before anything of it is drawn.
struct Foreseen {
    std::vector<std::string> refused;   ///< one a light: why it will have no shadow, a sentence or ""
    CasterFormats casters;              ///< what pipelines of CasterBuffers::draw must match; only where that is given
    std::vector<PassTime> passes;       ///< in order, without times
    VkDeviceSize transient_bytes = 0;   ///< memory that all frames of this size and with these lights share
    VkDeviceSize persistent_bytes = 0;  ///< of what outlives frames: the casters' mesh, kept maps, tables
};

/// How a recipe that was asked for ahead comes along.
struct Preparation {
    std::string recipe;  ///< whose pipelines are awaited; "": none
    std::string failed;  ///< why the one asked for last never comes, a sentence or ""
};

/// Shadows for one view of one renderer. Not thread-safe.
class Shadows {
  public:
    /// Fails with a sentence that names what is missing: of the device, of what was enabled in it, or in the recipe. Parts
    /// that need the triangles on the CPU are refused by name.
    static Result<Shadows> create(const Info& info) noexcept;
    /// The same on a device of the library's: info.device, baked and data are not looked at.
    static Result<Shadows> create(const Info& info, std::unique_ptr<Device> device) noexcept;
    Shadows(Shadows&&) noexcept;
    Shadows& operator=(Shadows&&) noexcept;
    /// The device must have finished with every slot.
    ~Shadows();

    /// Why the recipe serves no such light: a sentence, or "".
    [[nodiscard]] std::string refuses(const GnLight& light) const noexcept;

    /// What record would do with such a frame: sizes, lights, casters and formats count, images and buffers may be missing.
    /// Records and keeps nothing, but takes and gives back the frame's memory: for when a recipe is chosen.
    [[nodiscard]] Result<Foreseen> foresee(const Frame& frame) const noexcept;

    /// Records the frame's shadows; commands must not be inside a render pass. All images are left in the layouts that were
    /// asked for; what comes later on the queue sees the results once ALL_COMMANDS of this have finished, for which record
    /// ends with a barrier. Gives, for every light, why it has no shadow, a sentence or "": its image then is 1 everywhere.
    /// Where it fails, the commands hold a part of the frame and must not be submitted.
    Result<std::vector<std::string>> record(VkCommandBuffer commands, const Frame& frame) noexcept;

    /// Before lent images or buffers are destroyed, unless all images change their size: no view of them is kept.
    void forget_images() noexcept;
    /// Another recipe or other values from the next frame on; what was kept over frames begins anew.
    Result<Done> set_recipe(const std::string& recipe) noexcept;
    /// The same without a stall: a thread makes the pipelines, and frames go on with the recipe of before. The first frame that
    /// finds all that it would bind is drawn with the new one. What set_recipe, or this, asked for before is awaited no longer.
    Result<Done> prepare_recipe(const std::string& recipe) noexcept;
    [[nodiscard]] Preparation preparation() const noexcept;
    /// In development: compiles again the shaders whose .glsl files were written since they were read, with the next frame for
    /// their first. Gives how many became others. Where one does not compile it gives the compiler's sentence, and all stay as
    /// they were. Frames in flight are not disturbed.
    Result<std::size_t> reload() noexcept;
    /// Tells every shader that a frame like this would bind, and records nothing: what `gnomon bake` compiles.
    Result<std::vector<std::string>> rehearse(const Frame& frame,
                                              const std::function<void(const ShaderSource&)>& found) noexcept;
    /// Passes with their times and the bytes of resources, of the slot's last completed use.
    [[nodiscard]] GraphStatistics completed(std::uint32_t slot) const noexcept;
    /// What parts found out when frames had completed, one sentence each: lists that were too short, and the like.
    [[nodiscard]] std::vector<std::string> remarks() const noexcept;
    /// Objects that the device was asked for so far: in a steady sequence they stay as they are.
    [[nodiscard]] Counters counters() const noexcept;

  private:
    struct State;
    explicit Shadows(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace gn::embed
