// SPDX-License-Identifier: MIT
#include "reference/occluders.h"

#include "base/error.h"
#include "shadow/scene/casting.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gn {
namespace {

/// A texel's index along one axis, wrapped or clamped.
int wrap(int i, int size, bool repeat) {
    return repeat ? ((i % size) + size) % size : std::clamp(i, 0, size - 1);
}

/// Bilinear alpha in [0,1] at level 0.
float sample_alpha(const Texture& texture, vec2 uv) {
    const Image8& image = texture.image;
    if (image.width <= 0 || image.height <= 0) {
        return 1.0F;
    }

    // Reduce repeating coordinates to one period first, so that far ones keep their fraction and fit an int.
    uv.x = texture.repeat_u ? uv.x - std::floor(uv.x) : std::clamp(uv.x, 0.0F, 1.0F);
    uv.y = texture.repeat_v ? uv.y - std::floor(uv.y) : std::clamp(uv.y, 0.0F, 1.0F);
    const vec2 p = uv * vec2(image.width, image.height) - 0.5F;
    const vec2 base = glm::floor(p);
    const vec2 f = p - base;

    const auto texel = [&](int dx, int dy) {
        const int x = wrap(static_cast<int>(base.x) + dx, image.width, texture.repeat_u);
        const int y = wrap(static_cast<int>(base.y) + dy, image.height, texture.repeat_v);
        const std::size_t i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
        return static_cast<float>(image.rgba[4 * i + 3]) / 255.0F;
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), f.x), glm::mix(texel(0, 1), texel(1, 1), f.x), f.y);
}

void on_embree_error(void* /*context*/, RTCError code, const char* message) {
    if (code == RTC_ERROR_OUT_OF_MEMORY) {
        return;  // reported through rtcGetDeviceError where memory is asked for
    }
    fmt::print(stderr, "gnomon: ray tracing: {}\n", message != nullptr ? message : "unknown fault");
}

}  // namespace

/// What the filter of shadow rays needs to know; Embree hands the first member through.
struct Occluders::Query {
    RTCIntersectContext context;
    const Occluders* self;
    const Blockers* blockers;
    const Seat* seat;
    const float* distance;  ///< to the light, by the ray's id
    vec3* tint;             ///< by the ray's id
};

struct Occluders::SeatQuery {
    RTCIntersectContext context;
    const Occluders* self;
    dvec3 p_ws, n_ws;
    double nearest;          ///< signed distance to the best plane so far, along n
    std::uint32_t triangle;  ///< its triangle, to break ties
};

Occluders::Occluders(const Scene& scene) : scene_(scene) {
    // Remember whose every triangle is.
    object_.assign(scene.triangles.size(), 0);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const auto first = object_.begin() + scene.objects[i].first_triangle;
        std::fill(first, first + scene.objects[i].triangle_count, static_cast<std::uint32_t>(i));
    }

    device_ = rtcNewDevice(nullptr);
    if (device_ == nullptr) {
        fail("the ray tracer for the reference cannot start; it needs a processor with SSE2");
    }
    rtcSetDeviceErrorFunction(device_, on_embree_error, nullptr);
    if (rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0) {
        width_ = 16;
    } else if (rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0) {
        width_ = 8;
    }
    bvh_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(bvh_, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneFlags(bvh_, RTC_SCENE_FLAG_ROBUST);
    if (!scene.triangles.empty()) {
        copy_geometry();
    }
    rtcCommitScene(bvh_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) {
        rtcReleaseScene(bvh_);
        rtcReleaseDevice(device_);
        fail("scene '{}' with {} triangles does not fit into memory for the reference", scene.name,
             scene.triangles.size());
    }
}

Occluders::~Occluders() {
    rtcReleaseScene(bvh_);
    rtcReleaseDevice(device_);
}

void Occluders::copy_geometry() {
    // Embree's own buffers are padded as its vector loads need; a null buffer means no memory, which the caller reports.
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3),
                                             scene_.positions_ws.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3),
                                            scene_.triangles.size());
    if (vertices != nullptr && indices != nullptr) {
        std::copy(scene_.positions_ws.begin(), scene_.positions_ws.end(), static_cast<vec3*>(vertices));
        std::copy(scene_.triangles.begin(), scene_.triangles.end(), static_cast<uvec3*>(indices));
        for (const vec3& p : scene_.positions_ws) {
            largest_coordinate_ = std::max(largest_coordinate_, largest(dvec3(p)));
        }
        rtcSetGeometryUserData(geometry, this);
        rtcSetGeometryOccludedFilterFunction(geometry, reject);
        rtcSetGeometryIntersectFilterFunction(geometry, find_seat);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(bvh_, geometry);
    }
    rtcReleaseGeometry(geometry);
}

std::array<dvec3, 3> Occluders::corners(std::uint32_t triangle) const {
    const uvec3 t = scene_.triangles[triangle];
    return {dvec3(scene_.positions_ws[t.x]), dvec3(scene_.positions_ws[t.y]), dvec3(scene_.positions_ws[t.z])};
}

namespace {

/// The largest coordinates of a point and a triangle, by axis.
dvec3 magnitude_of(dvec3 p, const std::array<dvec3, 3>& t) {
    return glm::max(glm::max(glm::abs(p), glm::abs(t[0])), glm::max(glm::abs(t[1]), glm::abs(t[2])));
}

/// Of unit length, or null.
dvec3 normal_of(const std::array<dvec3, 3>& t) {
    const dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double length = glm::length(normal);
    return length > 0.0 ? normal / length : dvec3(0.0);
}

}  // namespace

bool Occluders::holds(std::uint32_t triangle, dvec3 p_ws) const {
    const auto t = corners(triangle);
    const dvec3 normal = normal_of(t);
    return normal == dvec3(0.0) ||
           std::abs(glm::dot(normal, p_ws - t[0])) <= ulps_along(plane_ulps, normal, magnitude_of(p_ws, t));
}

bool Occluders::below(std::uint32_t triangle, const Seat& seat) const {
    const auto t = corners(triangle);
    const double most = ulps_along(plane_ulps, seat.n_ws, magnitude_of(seat.p_ws, t));
    return std::all_of(t.begin(), t.end(),
                       [&](const dvec3& corner) { return glm::dot(seat.n_ws, corner - seat.p_ws) <= most; });
}

bool Occluders::beyond(std::uint32_t triangle, dvec3 origin_ws, dvec3 light_ws) const {
    const auto t = corners(triangle);
    const dvec3 normal = normal_of(t);
    const double start = glm::dot(normal, origin_ws - t[0]);
    const double end = glm::dot(normal, light_ws - t[0]);
    const dvec3 magnitude = glm::max(magnitude_of(light_ws, t), glm::abs(light_ws - origin_ws));
    return std::abs(end) <= ulps_along(end_ulps, normal, magnitude) || (start > 0.0) == (end > 0.0);
}

bool Occluders::transparent(std::uint32_t triangle, float u, float v) const {
    const Object& object = scene_.objects[object_[triangle]];
    const Material& material = scene_.materials[static_cast<std::size_t>(object.material)];
    if (material.alpha_mode == AlphaMode::opaque) {
        return false;
    }
    const uvec3 t = scene_.triangles[triangle];
    const auto interpolate = [&](const auto& values) {
        return (1.0F - u - v) * values[t.x] + u * values[t.y] + v * values[t.z];
    };
    float alpha = material.base_color.a;
    if (scene_.colors.size() == scene_.positions_ws.size()) {
        alpha *= interpolate(scene_.colors).a;
    }
    const auto texture = static_cast<std::size_t>(material.base_color_texture);
    if (material.base_color_texture >= 0 && texture < scene_.textures.size() &&
        scene_.uvs.size() == scene_.positions_ws.size()) {
        alpha *= sample_alpha(scene_.textures[texture], interpolate(scene_.uvs));
    }
    return alpha < (material.alpha_mode == AlphaMode::blend ? 0.5F : material.alpha_cutoff);
}

bool Occluders::seen_from_behind(std::uint32_t triangle, dvec3 towards_light) const {
    if (!is_single_sided(scene_, scene_.objects[object_[triangle]])) {
        return false;
    }
    const uvec3 t = scene_.triangles[triangle];
    const dvec3 a(scene_.positions_ws[t.x]);
    const dvec3 normal = glm::cross(dvec3(scene_.positions_ws[t.y]) - a, dvec3(scene_.positions_ws[t.z]) - a);
    return glm::dot(normal, towards_light) < 0.0;
}

Blockers Occluders::blockers(const Light* light, bool colours) const {
    Blockers found(scene_.objects.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        const CasterClass caster = caster_class(scene_, i, light);
        found[i] = caster == CasterClass::none          ? Blocks::nothing
                   : caster != CasterClass::translucent ? Blocks::all
                   : colours                            ? Blocks::tinted
                                                        : Blocks::nothing;
    }
    return found;
}

void Occluders::reject(const RTCFilterFunctionNArguments* arguments) {
    const auto& query = *reinterpret_cast<const Query*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) {
            continue;
        }
        const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
        const float u = RTCHitN_u(arguments->hit, arguments->N, i);
        const float v = RTCHitN_v(arguments->hit, arguments->N, i);
        const dvec3 towards_light(RTCRayN_dir_x(arguments->ray, arguments->N, i),
                                  RTCRayN_dir_y(arguments->ray, arguments->N, i),
                                  RTCRayN_dir_z(arguments->ray, arguments->N, i));
        const dvec3 origin_ws(RTCRayN_org_x(arguments->ray, arguments->N, i),
                              RTCRayN_org_y(arguments->ray, arguments->N, i),
                              RTCRayN_org_z(arguments->ray, arguments->N, i));
        // Near the light's end the side of the triangle's plane decides.
        const auto distance = static_cast<double>(query.distance[RTCRayN_id(arguments->ray, arguments->N, i)]);
        const auto at = static_cast<double>(RTCRayN_tfar(arguments->ray, arguments->N, i));
        const bool near_end = at > distance - ulps_at(hit_ulps, distance + largest(origin_ws));
        const bool rises = glm::dot(query.seat->n_ws, towards_light) > 0.0;
        const Blocks blocks = (*query.blockers)[query.self->object_[triangle]];
        if (triangle == query.seat->triangle || blocks == Blocks::nothing ||
            query.self->seen_from_behind(triangle, towards_light) ||
            (blocks == Blocks::all && query.self->transparent(triangle, u, v)) ||
            query.self->holds(triangle, query.seat->p_ws) || (rises && query.self->below(triangle, *query.seat)) ||
            (near_end && query.self->beyond(triangle, origin_ws, origin_ws + distance * towards_light))) {
            arguments->valid[i] = 0;
        } else if (blocks == Blocks::tinted) {
            // The ray goes on in the surface's colour.
            const Object& object = query.self->scene_.objects[query.self->object_[triangle]];
            query.tint[RTCRayN_id(arguments->ray, arguments->N, i)] *=
                transmittance(query.self->scene_.materials[static_cast<std::size_t>(object.material)]);
            arguments->valid[i] = 0;
        }
    }
}

void Occluders::find_seat(const RTCFilterFunctionNArguments* arguments) {
    // Keep the nearest plane, the first triangle among equals, and reject every hit so that all are seen: the order in
    // which the hierarchy meets them then does not matter.
    auto& query = *reinterpret_cast<SeatQuery*>(arguments->context);
    const Scene& scene = query.self->scene_;
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) {
            continue;
        }
        arguments->valid[i] = 0;
        const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
        const uvec3 t = scene.triangles[triangle];
        const dvec3 a(scene.positions_ws[t.x]);
        const dvec3 b(scene.positions_ws[t.y]);
        const dvec3 c(scene.positions_ws[t.z]);
        const dvec3 normal = glm::cross(b - a, c - a);
        const double facing = glm::dot(normal, query.n_ws);

        // Only a surface that lies along the sample's normal can be the sample's own.
        if (!(std::abs(facing) > 0.99 * glm::length(normal))) {
            continue;
        }
        const double height = glm::dot(normal, a - query.p_ws) / facing;
        const double vertices = std::max({largest(a), largest(b), largest(c), largest(query.p_ws)});
        if (std::abs(height) > ulps_at(seat_ulps, vertices)) {
            continue;
        }
        const bool nearer = std::abs(height) < std::abs(query.nearest);
        if (nearer || (std::abs(height) == std::abs(query.nearest) && triangle < query.triangle)) {
            query.nearest = height;
            query.triangle = triangle;
        }
    }
}

Seat Occluders::seat(dvec3 p_ws, dvec3 n_ws) const {
    // Search the segment of the sample's possible error along its normal.
    const double reach = ulps_at(seat_ulps, std::max(largest(p_ws), largest_coordinate_));
    SeatQuery query{{}, this, p_ws, n_ws, std::numeric_limits<double>::infinity(), RTC_INVALID_GEOMETRY_ID};
    rtcInitIntersectContext(&query.context);
    RTCRayHit ray{};
    const dvec3 start = p_ws + 2.0 * reach * n_ws;
    ray.ray = {static_cast<float>(start.x),
               static_cast<float>(start.y),
               static_cast<float>(start.z),
               0.0F,
               static_cast<float>(-n_ws.x),
               static_cast<float>(-n_ws.y),
               static_cast<float>(-n_ws.z),
               0.0F,
               static_cast<float>(4.0 * reach),
               ~0U,
               0U,
               0U};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(bvh_, &query.context, &ray);

    const bool found = std::isfinite(query.nearest);
    const dvec3 seated = found ? p_ws + query.nearest * n_ws : p_ws;
    const dvec3 normal = found ? normal_of(corners(query.triangle)) : dvec3(0.0);
    return {seated, vec3(seated + ulps_along(origin_ulps, n_ws, glm::abs(seated)) * n_ws), query.triangle,
            glm::dot(normal, n_ws) < 0.0 ? -normal : normal};
}

template <int Width>
void Occluders::trace(const Seat& seat, const Blockers& blockers, const int* valid, Packet<Width>& packet) const {
    packet.tint.fill(vec3(1));
    Query query{{}, this, &blockers, &seat, packet.distance.data(), packet.tint.data()};
    rtcInitIntersectContext(&query.context);
    query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    if constexpr (Width == 16) {
        rtcOccluded16(valid, bvh_, &query.context, reinterpret_cast<RTCRay16*>(&packet.rays));
    } else if constexpr (Width == 8) {
        rtcOccluded8(valid, bvh_, &query.context, reinterpret_cast<RTCRay8*>(&packet.rays));
    } else if constexpr (Width == 4) {
        rtcOccluded4(valid, bvh_, &query.context, reinterpret_cast<RTCRay4*>(&packet.rays));
    } else {
        rtcOccluded1(bvh_, &query.context, reinterpret_cast<RTCRay*>(&packet.rays));
    }
}

template void Occluders::trace<1>(const Seat&, const Blockers&, const int*, Packet<1>&) const;
template void Occluders::trace<4>(const Seat&, const Blockers&, const int*, Packet<4>&) const;
template void Occluders::trace<8>(const Seat&, const Blockers&, const int*, Packet<8>&) const;
template void Occluders::trace<16>(const Seat&, const Blockers&, const int*, Packet<16>&) const;

}  // namespace gn
