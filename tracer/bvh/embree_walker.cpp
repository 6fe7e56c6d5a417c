#include "tracer/bvh/embree_walker.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "tracer/bvh/embree_parts.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

constexpr float no_hit = std::numeric_limits<float>::infinity();

/// Embree's types and functions for packets of W rays.
template <unsigned W>
struct Packet;

template <>
struct Packet<4> {
    using Rays = RTCRay4;
    using RayHits = RTCRayHit4;
    static constexpr auto intersect = rtcIntersect4;
    static constexpr auto occluded = rtcOccluded4;
};
template <>
struct Packet<8> {
    using Rays = RTCRay8;
    using RayHits = RTCRayHit8;
    static constexpr auto intersect = rtcIntersect8;
    static constexpr auto occluded = rtcOccluded8;
};
template <>
struct Packet<16> {
    using Rays = RTCRay16;
    using RayHits = RTCRayHit16;
    static constexpr auto intersect = rtcIntersect16;
    static constexpr auto occluded = rtcOccluded16;
};

RTCIntersectContext context_of(const WalkMode& mode) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = mode.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

template <class Rays>
void set_ray(Rays& to, unsigned i, const Ray& ray) {
    to.org_x[i] = ray.origin.x;
    to.org_y[i] = ray.origin.y;
    to.org_z[i] = ray.origin.z;
    to.tnear[i] = ray.t_min;
    to.dir_x[i] = ray.direction.x;
    to.dir_y[i] = ray.direction.y;
    to.dir_z[i] = ray.direction.z;
    to.time[i] = 0;
    to.tfar[i] = ray.t_max;
    to.mask[i] = ~0U;
    to.id[i] = i;
    to.flags[i] = 0;
}

/// Calls use(valid, first, count) for each packet; `set` makes lane i of it that ray. Lanes without a ray, and rays that
/// Embree does not take, are not valid.
template <unsigned W, class Set, class Use>
void for_each_packet(std::span<const Ray> rays, const Set& set, const Use& use) {
    alignas(4 * W) int valid[W];
    for (std::size_t first = 0; first < rays.size(); first += W) {
        const auto count = static_cast<unsigned>(std::min<std::size_t>(W, rays.size() - first));
        for (unsigned i = 0; i < W; ++i) {
            const Ray& ray = rays[first + std::min(i, count - 1)];
            set(i, ray);
            valid[i] = i < count && EmbreeParts::takes(ray) ? -1 : 0;
        }
        use(static_cast<const int*>(valid), first, count);
    }
}

template <unsigned W>
void closest_packets(RTCScene scene, std::span<const Ray> rays, const WalkMode& mode, float* ends) {
    RTCIntersectContext context = context_of(mode);
    typename Packet<W>::RayHits query;
    for_each_packet<W>(
        rays,
        [&](unsigned i, const Ray& ray) {
            set_ray(query.ray, i, ray);
            query.hit.geomID[i] = query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        },
        [&](const int* valid, std::size_t first, unsigned count) {
            Packet<W>::intersect(valid, scene, &context, &query);
            for (unsigned i = 0; i < count; ++i)
                ends[first + i] = query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? no_hit : query.ray.tfar[i];
        });
}

template <unsigned W>
void occluded_packets(RTCScene scene, std::span<const Ray> rays, const WalkMode& mode, float* ends) {
    RTCIntersectContext context = context_of(mode);
    typename Packet<W>::Rays query;
    for_each_packet<W>(
        rays, [&](unsigned i, const Ray& ray) { set_ray(query, i, ray); },
        [&](const int* valid, std::size_t first, unsigned count) {
            Packet<W>::occluded(valid, scene, &context, &query);
            for (unsigned i = 0; i < count; ++i) ends[first + i] = query.tfar[i] < 0 ? 0 : no_hit;
        });
}

struct ReleaseDevice {
    void operator()(RTCDevice handle) const { rtcReleaseDevice(handle); }
};

}  // namespace

const std::vector<WalkMode>& walk_modes() {
    static const std::vector<WalkMode> all{
        {"single", 1, false},          {"packet4", 4, false},   {"packet4-coherent", 4, true},  {"packet8", 8, false},
        {"packet8-coherent", 8, true}, {"packet16", 16, false}, {"packet16-coherent", 16, true}};
    return all;
}

const WalkMode& walk_mode(const std::string& name) {
    std::vector<std::string> valid;
    for (const WalkMode& mode : walk_modes()) {
        if (mode.name == name) return mode;
        valid.push_back(mode.name);
    }
    throw UsageError(fmt::format("unknown mode '{}'; expected one of: {}{}", name, fmt::join(valid, ", "),
                                 did_you_mean(name, valid)));
}

bool EmbreeFacts::walks(const WalkMode& mode) const {
    return mode.width == 1 || std::find(widths.begin(), widths.end(), mode.width) != widths.end();
}

EmbreeFacts embree_facts() {
    const std::unique_ptr<RTCDeviceTy, ReleaseDevice> device(rtcNewDevice("set_affinity=0"));
    if (!device) throw Error("Embree cannot start on this processor");
    const auto property = [&](RTCDeviceProperty which) { return rtcGetDeviceProperty(device.get(), which); };
    EmbreeFacts facts;
    facts.version =
        fmt::format("{}.{}.{}", property(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                    property(RTC_DEVICE_PROPERTY_VERSION_MINOR), property(RTC_DEVICE_PROPERTY_VERSION_PATCH));
    const bool by8 = property(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0;
    const bool by16 = property(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
    if (property(RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED) != 0) facts.widths.push_back(4);
    if (by8) facts.widths.push_back(8);
    if (by16) facts.widths.push_back(16);
    // Embree names no instruction set, only the widths that follow from it: 16 needs AVX-512, 8 AVX.
    facts.isa = by16 ? "AVX-512" : by8 ? "AVX" : "SSE";
#if defined(__x86_64__)
    if (by8 && !by16 && __builtin_cpu_supports("avx2") != 0) facts.isa = "AVX2";
#endif
    return facts;
}

EmbreeWalker::EmbreeWalker(const Scene& scene, const TexelLayout& texels)
    : scene_(std::make_unique<EmbreeParts>(scene, &texels)) {}
EmbreeWalker::~EmbreeWalker() = default;

void EmbreeWalker::closest(std::span<const Ray> rays, const WalkMode& mode, float* ends) const {
    const RTCScene scene = scene_->handle();
    if (mode.width == 4) return closest_packets<4>(scene, rays, mode, ends);
    if (mode.width == 8) return closest_packets<8>(scene, rays, mode, ends);
    if (mode.width == 16) return closest_packets<16>(scene, rays, mode, ends);
    RTCIntersectContext context = context_of(mode);
    RTCRayHit found;
    for (std::size_t i = 0; i < rays.size(); ++i)
        ends[i] = scene_->closest(rays[i], context, found) ? found.ray.tfar : no_hit;
}

void EmbreeWalker::occluded(std::span<const Ray> rays, const WalkMode& mode, float* ends) const {
    const RTCScene scene = scene_->handle();
    if (mode.width == 4) return occluded_packets<4>(scene, rays, mode, ends);
    if (mode.width == 8) return occluded_packets<8>(scene, rays, mode, ends);
    if (mode.width == 16) return occluded_packets<16>(scene, rays, mode, ends);
    RTCIntersectContext context = context_of(mode);
    for (std::size_t i = 0; i < rays.size(); ++i) ends[i] = scene_->occluded(rays[i], context) ? 0 : no_hit;
}

}  // namespace raycache::tracer
