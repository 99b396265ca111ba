/* SPDX-License-Identifier: MIT */
/* A host in C: it draws depth alone, has two frames in flight, and takes a sun's shadow from Gnomon through gnomon.h.
 *
 *     embed_c before.pgm shadow.pgm [--validate]
 *
 * A wall of 2 x 2 metres glides over a floor of 8 x 8; the sun comes from behind it, 45 degrees high. V of the last two frames, one
 * of each slot, becomes pictures. Status 0: all is well. 1: it failed, or validation had something to say. 2: Gnomon refused. */
#include "host.h"

#include "shadow/embed/gnomon.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Two squares of 2 x 2 metres: one lies around the origin, one stands there on its edge. */
static const float positions[] = {-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1, -1, 0, 0, 1, 0, 0, 1, 2, 0, -1, 2, 0};
static const uint32_t indices[] = {0, 2, 1, 0, 3, 2, 0, 1, 2, 0, 2, 3};
static const GnomonObject objects[] = {{.first_index = 0, .index_count = 6, .first_vertex = 0, .vertex_count = 4},
                                       {.first_index = 6, .index_count = 6, .first_vertex = 4, .vertex_count = 4}};
enum { object_count = 2 };
/* Where they are in a frame: columns of matrices. */
typedef float Transforms[object_count][16];
enum { frames = 8, warm_frames = 2 };

typedef struct Renderer {
    Host host;
    Buffer positions, indices;
    Buffer transforms[slots]; /* written while the frame before may still be read */
    Buffer pixels[slots];     /* V, copied there */
    Image depth, visibility;
    Pipeline pipeline;
    float cs_from_ws[16];
} Renderer;

/* out = a * b. */
static void multiply(float out[16], const float a[16], const float b[16]) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            out[4 * column + row] = 0;
            for (int i = 0; i < 4; ++i) {
                out[4 * column + row] += a[4 * i + row] * b[4 * column + i];
            }
        }
    }
}

/* From (0, 5, 7) towards the origin; depth is 0 half a metre away and 1 at 30 metres. */
static void set_camera(float cs_from_ws[16]) {
    const float length = sqrtf(5 * 5 + 7 * 7), s = 5 / length, c = 7 / length; /* of the angle down from the horizon */
    const float vs_from_ws[16] = {1, 0, 0, 0, 0, c, s, 0, 0, -s, c, 0, 0, 0, -length, 1};
    const float near = 0.5F, far = 30, scale = 1 / tanf(0.45F);
    float cs_from_vs[16] = {0};
    cs_from_vs[0] = scale * height / width;
    cs_from_vs[5] = -scale;
    cs_from_vs[10] = far / (near - far);
    cs_from_vs[11] = -1;
    cs_from_vs[14] = near * far / (near - far);
    multiply(cs_from_ws, cs_from_vs, vs_from_ws);
}

static void create(Renderer* r, bool validate) {
    host_create(&r->host, validate);
    const VkBufferUsageFlags lent = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    r->positions = buffer_create(&r->host, sizeof positions, lent | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, positions);
    r->indices = buffer_create(&r->host, sizeof indices, lent | VK_BUFFER_USAGE_INDEX_BUFFER_BIT, indices);
    for (int i = 0; i < slots; ++i) {
        r->transforms[i] = buffer_create(&r->host, sizeof(Transforms), lent, NULL);
        r->pixels[i] = buffer_create(&r->host, width * height, VK_BUFFER_USAGE_TRANSFER_DST_BIT, NULL);
    }
    r->depth = image_create(&r->host, VK_FORMAT_D32_SFLOAT,
                            VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                            VK_IMAGE_ASPECT_DEPTH_BIT);
    r->visibility = image_create(&r->host, VK_FORMAT_R8_UNORM,
                                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                 VK_IMAGE_ASPECT_COLOR_BIT);
    r->pipeline = depth_pipeline_create(&r->host);
    set_camera(r->cs_from_ws);
}

static void destroy(Renderer* r) {
    pipeline_destroy(&r->host, &r->pipeline);
    image_destroy(&r->host, &r->visibility);
    image_destroy(&r->host, &r->depth);
    for (int i = 0; i < slots; ++i) {
        buffer_destroy(&r->host, &r->pixels[i]);
        buffer_destroy(&r->host, &r->transforms[i]);
    }
    buffer_destroy(&r->host, &r->indices);
    buffer_destroy(&r->host, &r->positions);
    host_destroy(&r->host);
}

/* The wall is 40 cm further to the right in every frame, and stands at 1 m in the last. */
static void pose(float transforms[object_count][16], int frame) {
    const float x = 1 - 0.4F * (float)(frames - 1 - frame);
    const Transforms posed = {{4, 0, 0, 0, 0, 1, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1}, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1}};
    memcpy(transforms, posed, sizeof posed);
}

static void draw_depth(const Renderer* r, VkCommandBuffer commands, float transforms[object_count][16]) {
    const VkImageMemoryBarrier2 begin = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                         .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                         .dstStageMask = VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT,
                                         .dstAccessMask = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                                         .newLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                         .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                         .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                         .image = r->depth.image,
                                         .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1}};
    const VkDependencyInfo dependency = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &begin};
    vkCmdPipelineBarrier2(commands, &dependency);

    const VkRenderingAttachmentInfo depth = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = r->depth.view,
                                             .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                             .clearValue = {.depthStencil = {.depth = 1}}};
    const VkRenderingInfo rendering = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                       .renderArea = {{0, 0}, {width, height}},
                                       .layerCount = 1,
                                       .pDepthAttachment = &depth};
    vkCmdBeginRendering(commands, &rendering);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, r->pipeline.pipeline);
    const VkDeviceSize start = 0;
    vkCmdBindVertexBuffers(commands, 0, 1, &r->positions.buffer, &start);
    vkCmdBindIndexBuffer(commands, r->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    for (int i = 0; i < object_count; ++i) {
        float cs_from_os[16];
        multiply(cs_from_os, r->cs_from_ws, transforms[i]);
        vkCmdPushConstants(commands, r->pipeline.layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof cs_from_os, cs_from_os);
        vkCmdDrawIndexed(commands, objects[i].index_count, 1, objects[i].first_index, (int32_t)objects[i].first_vertex, 0);
    }
    vkCmdEndRendering(commands);
}

/* Ends the program where Gnomon gives a sentence. */
static void demand(const char* why) {
    if (why != NULL) {
        fprintf(stderr, "embed_c: %s\n", why);
        exit(2);
    }
}

static GnomonShadows* create_shadows(const Renderer* r) {
    const char* const extensions[] = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
    const GnomonInfo info = {.size = sizeof(GnomonInfo),
                             .instance = r->host.instance,
                             .physical = r->host.physical,
                             .device = r->host.device,
                             .queue = r->host.queue,
                             .queue_family = r->host.queue_family,
                             .extension_count = 1,
                             .extensions = extensions,
                             .features = &r->host.features,
                             .recipe = "pcf,resolution=2048",
                             .width = width,
                             .height = height,
                             .lights = 1,
                             .frames_in_flight = slots,
                             .normals = GNOMON_NORMALS_NONE,
                             .baked = EMBED_BAKED};
    GnomonShadows* shadows = NULL;
    demand(gnomon_create(&info, &shadows));
    return shadows;
}

static void record_shadows(const Renderer* r, VkCommandBuffer commands, GnomonShadows* shadows, int number) {
    const uint32_t slot = (uint32_t)number % slots;
    const float half = sqrtf(0.5F);
    const GnomonLight sun = {.kind = GNOMON_LIGHT_DIRECTIONAL,
                             .direction_ws = {0, -half, half},
                             .visibility = {r->visibility.image, VK_FORMAT_R8_UNORM, VK_IMAGE_LAYOUT_UNDEFINED,
                                            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}};
    GnomonFrame frame = {.size = sizeof(GnomonFrame),
                         .object_size = sizeof(GnomonObject),
                         .light_size = sizeof(GnomonLight),
                         .slot = slot,
                         .width = width,
                         .height = height,
                         .depth = {r->depth.image, VK_FORMAT_D32_SFLOAT, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                   VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL},
                         .positions = {r->positions.buffer, 0, r->positions.bytes},
                         .indices = {r->indices.buffer, 0, r->indices.bytes},
                         .transforms = {r->transforms[slot].buffer, 0, r->transforms[slot].bytes},
                         .stride = 3 * sizeof(float),
                         .object_count = object_count,
                         .light_count = 1,
                         .objects = objects,
                         .lights = &sun,
                         .poses = (uint64_t)number,
                         .bounds_min_ws = {-4, 0, -4},
                         .bounds_max_ws = {4, 2, 4}};
    memcpy(frame.cs_from_ws, r->cs_from_ws, sizeof frame.cs_from_ws);
    const char* refused = NULL;
    demand(gnomon_record(shadows, commands, &frame, &refused));
    demand(refused);
}

/* Copies V to where the host will read it. */
static void copy_visibility(const Renderer* r, VkCommandBuffer commands, VkBuffer pixels) {
    const VkBufferImageCopy all = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                   .imageExtent = {width, height, 1}};
    vkCmdCopyImageToBuffer(commands, r->visibility.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels, 1, &all);
    const VkMemoryBarrier2 read = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                   .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                   .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                   .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                   .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo dependency = {
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &read};
    vkCmdPipelineBarrier2(commands, &dependency);
}

/* One frame: waits for the one before the last, and for nothing else. */
static void draw_frame(Renderer* r, GnomonShadows* shadows, int number) {
    const uint32_t slot = (uint32_t)number % slots;
    const VkCommandBuffer commands = host_begin(&r->host, slot);
    Transforms transforms;
    pose(transforms, number);
    memcpy(r->transforms[slot].mapped, transforms, sizeof transforms);
    draw_depth(r, commands, transforms);
    record_shadows(r, commands, shadows, number);
    copy_visibility(r, commands, r->pixels[slot].buffer);
    host_submit(&r->host, slot);
}

/* V of a frame as a grey picture. */
static void write_picture(const Renderer* r, int number, const char* path) {
    const uint32_t slot = (uint32_t)number % slots;
    host_wait(&r->host, slot);
    FILE* file = fopen(path, "wb");
    if (file == NULL || fprintf(file, "P5 %d %d 255\n", width, height) < 0 ||
        fwrite(r->pixels[slot].mapped, 1, width * height, file) != width * height || fclose(file) != 0) {
        fprintf(stderr, "embed_c: the picture '%s' cannot be written\n", path);
        exit(1);
    }
}

int main(int argc, char** argv) {
    if (argc < 3) {
        fprintf(stderr, "embed_c: name two pictures to write: embed_c before.pgm shadow.pgm [--validate]\n");
        return 1;
    }
    Renderer renderer;
    create(&renderer, argc > 3 && strcmp(argv[3], "--validate") == 0);
    GnomonShadows* shadows = create_shadows(&renderer);
    GnomonCounters warm = {0};
    for (int i = 0; i < frames; ++i) {
        draw_frame(&renderer, shadows, i);
        warm = i == warm_frames - 1 ? gnomon_counters(shadows) : warm;
    }
    const GnomonCounters last = gnomon_counters(shadows);
    const bool steady = memcmp(&warm, &last, sizeof last) == 0;
    write_picture(&renderer, frames - 2, argv[1]);
    write_picture(&renderer, frames - 1, argv[2]);
    gnomon_destroy(shadows);
    destroy(&renderer);
    printf("%s and %s, %u messages of validation, created in the last %d frames: %s\n", argv[1], argv[2],
           renderer.host.messages, frames - warm_frames, steady ? "nothing" : "something");
    return renderer.host.messages == 0 ? 0 : 1;
}
