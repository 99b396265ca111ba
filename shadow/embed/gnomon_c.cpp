// SPDX-License-Identifier: MIT
// The C header over the C++ one: structs are copied field by field, failures become a sentence of the thread's.
#include "shadow/embed/gnomon.h"

#include "shadow/embed/embed.h"

#include <glm/gtc/type_ptr.hpp>

using namespace gn;
using namespace gn::embed;

struct GnomonShadows {
    Shadows shadows;
    std::vector<std::string> refused;
    GraphStatistics completed;
    std::vector<GnomonPass> passes;
    Foreseen foreseen;
    std::vector<GnomonPass> foreseen_passes;
};

namespace {

static_assert(static_cast<int>(Normals::none) == GNOMON_NORMALS_NONE);
static_assert(static_cast<int>(Normals::signed_xyz) == GNOMON_NORMALS_SIGNED_XYZ);
static_assert(static_cast<int>(Normals::unsigned_xyz) == GNOMON_NORMALS_UNSIGNED_XYZ);
static_assert(static_cast<int>(Normals::signed_octahedral) == GNOMON_NORMALS_SIGNED_OCTAHEDRAL);
static_assert(static_cast<int>(Normals::unsigned_octahedral) == GNOMON_NORMALS_UNSIGNED_OCTAHEDRAL);
static_assert(GN_LIGHT_DIRECTIONAL == GNOMON_LIGHT_DIRECTIONAL && GN_LIGHT_SPOT == GNOMON_LIGHT_SPOT);
static_assert(GN_LIGHT_POINT == GNOMON_LIGHT_POINT && GN_LIGHT_RECTANGLE == GNOMON_LIGHT_RECTANGLE);

/// Runs `work`, whose failure becomes the thread's sentence.
template <class Work>
const char* sentence_of(Work&& work) noexcept {
    thread_local std::string sentence;
    const Result<Done> done = guarded<Done>([&] {
        work();
        return Done{};
    });
    if (done.ok()) {
        return nullptr;
    }
    try {
        sentence = done.why();
    } catch (const std::bad_alloc&) {
        return "out of memory";
    }
    return sentence.c_str();
}

void demand_size(const char* name, std::size_t given, std::size_t known) {
    if (given != known) {
        fail(
            "a {} is {} bytes to the caller and {} to the library; set its size, and compile with the library's own "
            "gnomon.h",
            name, given, known);
    }
}

template <class T>
const T& given(const T* pointer, const char* name) {
    if (pointer == nullptr) {
        fail("{} is NULL, and must not be", name);
    }
    return *pointer;
}

/// The element of an array that may be missing.
template <class T>
const T& element(const T* array, std::uint32_t i, const char* name) {
    return (&given(array, name))[i];
}

LentImage image_of(const GnomonImage& c) {
    return {.image = c.image, .format = c.format, .before = c.before, .after = c.after};
}

LentBuffer buffer_of(const GnomonBuffer& c) {
    return {.buffer = c.buffer, .offset = c.offset, .bytes = c.bytes};
}

vec4 vector_of(const float (&c)[3]) {
    return {c[0], c[1], c[2], 0};
}

GnLight shape_of(const GnomonLight& c) {
    GnLight light;
    light.position_ws = vector_of(c.position_ws);
    light.direction_ws = vector_of(c.direction_ws);
    light.right_ws = vector_of(c.right_ws);
    light.up_ws = vector_of(c.up_ws);
    light.half_size = {c.half_size[0], c.half_size[1]};
    light.kind = static_cast<uint>(c.kind);
    light.radius = c.radius;
    light.angular_radius = c.angular_radius;
    light.cos_inner = c.cos_inner;
    light.cos_outer = c.cos_outer;
    light.range = c.range;
    return light;
}

Info info_of(const GnomonInfo& c) {
    Info info;
    info.device = {.instance = c.instance,
                   .physical = c.physical,
                   .device = c.device,
                   .queue = c.queue,
                   .queue_family = c.queue_family,
                   .features = c.features};
    for (std::uint32_t i = 0; i < c.extension_count; ++i) {
        info.device.extensions.push_back(&given(element(c.extensions, i, "extensions"), "an extension's name"));
    }
    info.recipe = &given(c.recipe, "the recipe");
    info.limits = {.width = c.width, .height = c.height, .lights = c.lights, .frames_in_flight = c.frames_in_flight};
    info.receivers = {.reversed_depth = c.reversed_depth, .normals = static_cast<Normals>(c.normals)};
    info.baked = c.baked != nullptr ? c.baked : "";
    info.data = c.data != nullptr ? c.data : "";
    info.in_background = c.in_background;
    return info;
}

std::vector<Box> moved_of(const GnomonFrame& c) {
    std::vector<Box> moved;
    for (std::uint32_t i = 0; c.moved != nullptr && i < c.moved_count; ++i) {
        moved.push_back({vec3(vector_of(c.moved[i].min_ws)), vec3(vector_of(c.moved[i].max_ws))});
    }
    return moved;
}

CasterFunction draw_of(const GnomonFrame& c) {
    if (c.draw == nullptr) {
        return {};
    }
    return [draw = c.draw, user = c.draw_user](const CasterView& view) {
        GnomonCasterView given{.commands = view.commands,
                               .light_id = view.light_id,
                               .grid = view.view.grid,
                               .writes_depth = view.writes_depth};
        std::copy_n(glm::value_ptr(view.view.cs_from_ws), 16, given.cs_from_ws);
        std::copy_n(glm::value_ptr(view.view.depth_from_ws), 4, given.depth_from_ws);
        draw(user, &given);
    };
}

CasterBuffers casters_of(const GnomonFrame& c, std::span<const CasterObject> objects, std::span<const Box> moved) {
    return {.positions = buffer_of(c.positions),
            .stride = c.stride,
            .indices = buffer_of(c.indices),
            .transforms = buffer_of(c.transforms),
            .objects = objects,
            .bounds_ws = {vec3(vector_of(c.bounds_min_ws)), vec3(vector_of(c.bounds_max_ws))},
            .topology = c.topology,
            .poses = c.poses,
            .moved_ws = c.moved != nullptr ? std::optional(moved) : std::nullopt,
            .draw = draw_of(c)};
}

std::optional<mat4> before_of(const GnomonFrame& c) {
    return c.before_cs_from_ws != nullptr ? std::optional(glm::make_mat4(c.before_cs_from_ws)) : std::nullopt;
}

/// Hands the frame, as C++ has it, to `use`.
template <class Use>
void with_frame(const GnomonFrame& c, Use&& use) {
    demand_size("GnomonFrame", c.size, sizeof(GnomonFrame));
    demand_size("GnomonObject", c.object_size, sizeof(GnomonObject));
    demand_size("GnomonLight", c.light_size, sizeof(GnomonLight));
    std::vector<CasterObject> objects;
    objects.reserve(c.object_count);
    for (std::uint32_t i = 0; i < c.object_count; ++i) {
        const GnomonObject& o = element(c.objects, i, "objects");
        objects.push_back({o.first_index, o.index_count, o.first_vertex, o.vertex_count, o.single_sided});
    }
    const std::vector<Box> moved = moved_of(c);
    std::vector<LentLight> lights;
    for (std::uint32_t i = 0; i < c.light_count; ++i) {
        const GnomonLight& light = element(c.lights, i, "lights");
        lights.push_back({.id = light.id, .shape = shape_of(light), .visibility = image_of(light.visibility)});
    }
    use(Frame{.slot = c.slot,
              .cut = c.cut,
              .receivers = {.width = c.width,
                            .height = c.height,
                            .depth = image_of(c.depth),
                            .normals = image_of(c.normals),
                            .cs_from_ws = glm::make_mat4(c.cs_from_ws),
                            .before_cs_from_ws = before_of(c)},
              .casters = casters_of(c, objects, moved),
              .lights = lights});
}

/// The value of a result. Throws Error with its sentence.
template <class T>
T value_of(Result<T> result) {
    if (!result.ok()) {
        throw Error(result.why());
    }
    return std::move(result.value());
}

/// Where the caller asks, why each light is refused.
void tell(const std::vector<std::string>& refused, const char** told) {
    for (std::size_t i = 0; told != nullptr && i < refused.size(); ++i) {
        told[i] = refused[i].empty() ? nullptr : refused[i].c_str();
    }
}

std::vector<GnomonPass> passes_of(const std::vector<PassTime>& passes) {
    std::vector<GnomonPass> c;
    for (const PassTime& pass : passes) {
        c.push_back({pass.name.c_str(), pass.group.c_str(), pass.ms});
    }
    return c;
}

}  // namespace

const char* gnomon_create(const GnomonInfo* info, GnomonShadows** shadows) {
    return sentence_of([&] {
        demand_size("GnomonInfo", given(info, "info").size, sizeof(GnomonInfo));
        if (shadows == nullptr) {
            fail("shadows is NULL, and must say where the shadows go");
        }
        *shadows = new GnomonShadows{value_of(Shadows::create(info_of(*info))), {}, {}, {}, {}, {}};
    });
}

void gnomon_destroy(GnomonShadows* shadows) {
    delete shadows;
}

const char* gnomon_record(GnomonShadows* shadows, VkCommandBuffer commands, const GnomonFrame* frame,
                          const char** refused) {
    return sentence_of([&] {
        given(shadows, "shadows");
        with_frame(given(frame, "frame"),
                   [&](const Frame& f) { shadows->refused = value_of(shadows->shadows.record(commands, f)); });
        tell(shadows->refused, refused);
    });
}

const char* gnomon_foresee(GnomonShadows* shadows, const GnomonFrame* frame, GnomonForeseen* foreseen,
                           const char** refused) {
    return sentence_of([&] {
        given(shadows, "shadows");
        demand_size("GnomonForeseen", given(foreseen, "foreseen").size, sizeof(GnomonForeseen));
        with_frame(given(frame, "frame"),
                   [&](const Frame& f) { shadows->foreseen = value_of(shadows->shadows.foresee(f)); });
        const Foreseen& told = shadows->foreseen;
        shadows->foreseen_passes = passes_of(told.passes);
        *foreseen = {.size = sizeof(GnomonForeseen),
                     .depth = told.casters.depth,
                     .samples = told.casters.samples,
                     .culled = told.casters.culled,
                     .affine = told.casters.affine,
                     .bent = told.casters.bent,
                     .transient_bytes = told.transient_bytes,
                     .persistent_bytes = told.persistent_bytes,
                     .pass_count = static_cast<uint32_t>(shadows->foreseen_passes.size()),
                     .passes = shadows->foreseen_passes.data()};
        tell(told.refused, refused);
    });
}

const char* gnomon_refuses(const GnomonShadows* shadows, const GnomonLight* light) {
    return sentence_of([&] {
        const std::string why = given(shadows, "shadows").shadows.refuses(shape_of(given(light, "light")));
        if (!why.empty()) {
            throw Error(why);
        }
    });
}

const char* gnomon_set_recipe(GnomonShadows* shadows, const char* recipe) {
    return sentence_of([&] {
        given(shadows, "shadows");
        value_of(shadows->shadows.set_recipe(&given(recipe, "the recipe")));
    });
}

const char* gnomon_prepare_recipe(GnomonShadows* shadows, const char* recipe) {
    return sentence_of([&] {
        given(shadows, "shadows");
        value_of(shadows->shadows.prepare_recipe(&given(recipe, "the recipe")));
    });
}

const char* gnomon_preparation(const GnomonShadows* shadows, bool* awaited) {
    return sentence_of([&] {
        const Preparation coming = given(shadows, "shadows").shadows.preparation();
        if (awaited != nullptr) {
            *awaited = !coming.recipe.empty();
        }
        if (!coming.failed.empty()) {
            throw Error(coming.failed);
        }
    });
}

const char* gnomon_reload(GnomonShadows* shadows, size_t* changed) {
    return sentence_of([&] {
        given(shadows, "shadows");
        const Result<std::size_t> reloaded = shadows->shadows.reload();
        if (!reloaded.ok()) {
            throw Error(reloaded.why());
        }
        if (changed != nullptr) {
            *changed = reloaded.value();
        }
    });
}

void gnomon_forget_images(GnomonShadows* shadows) {
    shadows->shadows.forget_images();
}

uint32_t gnomon_completed(GnomonShadows* shadows, uint32_t slot, const GnomonPass** passes) {
    shadows->passes.clear();
    const Result<Done> done = guarded<Done>([&] {
        shadows->completed = shadows->shadows.completed(slot);
        shadows->passes = passes_of(shadows->completed.passes);
        return Done{};
    });
    *passes = shadows->passes.data();
    return done.ok() ? static_cast<uint32_t>(shadows->passes.size()) : 0;
}

GnomonCounters gnomon_counters(const GnomonShadows* shadows) {
    const Counters now = shadows->shadows.counters();
    return {now.pipelines, now.samplers, now.images, now.buffers, now.views, now.allocations, now.pools, now.texts};
}
