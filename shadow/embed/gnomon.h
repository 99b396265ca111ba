/* SPDX-License-Identifier: MIT */
/* The boundary of shadow/embed/embed.h for C11 and for whatever calls C: what there is said of types and calls holds here.
 *
 *     GnomonShadows* shadows = NULL;
 *     const char* why = gnomon_create(&info, &shadows);
 *     if (why) { puts(why); }
 *     for (;;) {
 *         ... draw depth and normals ...
 *         why = gnomon_record(shadows, commands, &frame, NULL);
 *         ... shade with the images of V, submit ...
 *     }
 *     gnomon_destroy(shadows);
 *
 * Functions that can fail give NULL or one sentence, which stays until the thread's next call. Vectors are world space, metres,
 * y up; matrices are columns first. All that is zero is off, none or unset: nothing is chosen silently. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

/* C has its own ways: NOLINTBEGIN(modernize-use-using, readability-identifier-naming) */

typedef struct GnomonShadows GnomonShadows;

typedef enum GnomonNormals {
    GNOMON_NORMALS_NONE = 0,
    GNOMON_NORMALS_SIGNED_XYZ = 1,
    GNOMON_NORMALS_UNSIGNED_XYZ = 2,
    GNOMON_NORMALS_SIGNED_OCTAHEDRAL = 3,
    GNOMON_NORMALS_UNSIGNED_OCTAHEDRAL = 4
} GnomonNormals;

typedef enum GnomonLightKind {
    GNOMON_LIGHT_DIRECTIONAL = 0,
    GNOMON_LIGHT_SPOT = 1,
    GNOMON_LIGHT_POINT = 2,
    GNOMON_LIGHT_RECTANGLE = 3
} GnomonLightKind;

/* The device that is lent, what was enabled in it, the recipe, the limits and the form of depth and normals. */
typedef struct GnomonInfo {
    size_t size; /* sizeof(GnomonInfo): a header of another version is refused */
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t queue_family;
    uint32_t extension_count;
    const char* const* extensions;
    const VkPhysicalDeviceFeatures2* features;
    const char* recipe;
    uint32_t width, height; /* most pixels */
    uint32_t lights;        /* most lights */
    uint32_t frames_in_flight;
    GnomonNormals normals;
    bool reversed_depth;
    const char* baked;  /* a folder that `gnomon bake` wrote, or NULL */
    const char* data;   /* without it: the folder of recipes and shader functions, or NULL for the program's own */
    bool in_background; /* a thread makes the recipe's pipelines, and V is 1 until all are there */
} GnomonInfo;

typedef struct GnomonImage {
    VkImage image;
    VkFormat format;
    VkImageLayout before, after;
} GnomonImage;

typedef struct GnomonBuffer {
    VkBuffer buffer;
    VkDeviceSize offset, bytes;
} GnomonBuffer;

typedef struct GnomonObject {
    uint32_t first_index, index_count;
    uint32_t first_vertex, vertex_count;
    bool single_sided;
} GnomonObject;

typedef struct GnomonBox {
    float min_ws[3], max_ws[3];
} GnomonBox;

typedef struct GnomonLight {
    uint64_t id; /* the same in every frame */
    GnomonLightKind kind;
    float position_ws[3];
    float direction_ws[3];       /* unit: the way the light travels */
    float right_ws[3], up_ws[3]; /* unit: a rectangle's axes */
    float half_size[2];          /* of a rectangle along them */
    float radius;                /* of a spot's disc or a point's ball, metres */
    float angular_radius;        /* of a directional light, radians */
    float cos_inner, cos_outer;  /* of a spot's cone */
    float range;                 /* metres; 0: without end */
    GnomonImage visibility;      /* where V goes */
} GnomonLight;

/* A view of a light that is ready to be drawn into: one depth attachment of one layer, tested with LESS, depth clamped; viewport
 * and scissor are set as dynamic state. */
typedef struct GnomonCasterView {
    VkCommandBuffer commands;
    uint64_t light_id;
    /* gl_Position = cs_from_ws * (p_ws, 1). Where grid is not 0, maps that are kept over frames want x and y rounded before the
     * matrix's last column is added: (x + grid) - grid. */
    float cs_from_ws[16];
    float grid;
    bool writes_depth; /* gl_FragDepth = clamp(dot(depth_from_ws, (p_ws, 1)), 0, 1) */
    float depth_from_ws[4];
} GnomonCasterView;
typedef void (*GnomonDraw)(void* user, const GnomonCasterView* view);

typedef struct GnomonFrame {
    size_t size;                    /* sizeof(GnomonFrame) */
    size_t object_size, light_size; /* sizeof(GnomonObject), sizeof(GnomonLight) */
    uint32_t slot;
    bool cut;

    uint32_t width, height; /* of depth, normals and every V */
    GnomonImage depth, normals;
    float cs_from_ws[16];
    const float* before_cs_from_ws; /* 16 numbers, or NULL: as the frame before said */

    GnomonBuffer positions, indices, transforms;
    uint32_t stride; /* bytes from one position to the next */
    uint32_t object_count, light_count;
    const GnomonObject* objects;
    const GnomonLight* lights;
    float bounds_min_ws[3], bounds_max_ws[3];
    uint64_t topology, poses;
    /* Boxes of what moved since the frame recorded last, then and now; NULL: anything may have. */
    const GnomonBox* moved;
    uint32_t moved_count;
    /* Draws the casters instead, into each view that must be drawn; buffers and objects are then not read. NULL: they are. */
    GnomonDraw draw;
    void* draw_user;
} GnomonFrame;

typedef struct GnomonPass {
    const char* name;
    const char* group;
    double ms;
} GnomonPass;

/* What a frame will ask for. */
typedef struct GnomonForeseen {
    size_t size; /* sizeof(GnomonForeseen) */
    /* What pipelines of GnomonFrame::draw must match, where that is given: no colour, no stencil. */
    VkFormat depth;
    VkSampleCountFlagBits samples;
    VkCullModeFlags culled; /* with VK_FRONT_FACE_COUNTER_CLOCKWISE for the front */
    bool affine, bent;      /* there are views without and with writes_depth */
    uint64_t transient_bytes, persistent_bytes;
    uint32_t pass_count;
    const GnomonPass* passes; /* without times; they stay until the next gnomon_foresee */
} GnomonForeseen;

/* Objects that the device was asked for since the shadows were created. */
typedef struct GnomonCounters {
    uint64_t pipelines, samplers, images, buffers, views, allocations, pools,
        texts; /* texts: of shaders, composed anew */
} GnomonCounters;

const char* gnomon_create(const GnomonInfo* info, GnomonShadows** shadows);
/* The device must have finished with every slot. NULL is allowed. */
void gnomon_destroy(GnomonShadows* shadows);

/* `refused`, when it is not NULL, has room for light_count pointers: why each light has no shadow, or NULL. They stay until the
 * next gnomon_record. */
const char* gnomon_record(GnomonShadows* shadows, VkCommandBuffer commands, const GnomonFrame* frame,
                          const char** refused);

/* What gnomon_record would do with such a frame, of which images and buffers may be missing. `refused` as there; its sentences
 * stay until the next gnomon_foresee. */
const char* gnomon_foresee(GnomonShadows* shadows, const GnomonFrame* frame, GnomonForeseen* foreseen,
                           const char** refused);

/* Why the recipe serves no such light, or NULL. */
const char* gnomon_refuses(const GnomonShadows* shadows, const GnomonLight* light);
const char* gnomon_set_recipe(GnomonShadows* shadows, const char* recipe);
/* The same without a stall: a thread makes the pipelines, and frames go on with the recipe of before until all are there. */
const char* gnomon_prepare_recipe(GnomonShadows* shadows, const char* recipe);
/* Why the recipe that was asked for last never comes, or NULL; `awaited`, when it is not NULL, says whether it is to come. */
const char* gnomon_preparation(const GnomonShadows* shadows, bool* awaited);
void gnomon_forget_images(GnomonShadows* shadows);
/* In development: compiles shaders again whose files were written since; `changed`, when it is not NULL, becomes their number. */
const char* gnomon_reload(GnomonShadows* shadows, size_t* changed);

/* Passes of the slot's last completed use; they stay until the next call of this function. Gives their number. */
uint32_t gnomon_completed(GnomonShadows* shadows, uint32_t slot, const GnomonPass** passes);
GnomonCounters gnomon_counters(const GnomonShadows* shadows);

/* NOLINTEND(modernize-use-using, readability-identifier-naming) */

#ifdef __cplusplus
}
#endif
