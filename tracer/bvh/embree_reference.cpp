#include "tracer/bvh/embree_reference.hpp"

#include <embree3/rtcore.h>

#include <algorithm>

#include "traces/error.hpp"

namespace raycache::tracer {

struct EmbreeReference::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
};

EmbreeReference::EmbreeReference(const Scene& scene) : impl_(std::make_unique<Impl>()) {
    impl_->device = rtcNewDevice("set_affinity=0");
    if (impl_->device == nullptr) throw Error("Embree cannot start on this processor");
    impl_->scene = rtcNewScene(impl_->device);
    rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry mesh = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree reads 16 bytes of each vertex: its own copy is padded.
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), scene.positions.size()));
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
        vertices[3 * i] = scene.positions[i].x;
        vertices[3 * i + 1] = scene.positions[i].y;
        vertices[3 * i + 2] = scene.positions[i].z;
    }
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), scene.triangle_count()));
    std::copy(scene.indices.begin(), scene.indices.end(), indices);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(impl_->scene, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(impl_->scene);
}

EmbreeReference::~EmbreeReference() {
    rtcReleaseScene(impl_->scene);
    rtcReleaseDevice(impl_->device);
}

Hit EmbreeReference::intersect(const Ray& ray) const {
    RTCRayHit query{};
    query.ray = {ray.origin.x,
                 ray.origin.y,
                 ray.origin.z,
                 ray.t_min,
                 ray.direction.x,
                 ray.direction.y,
                 ray.direction.z,
                 0,
                 ray.t_max,
                 ~0U,
                 0,
                 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(impl_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
}

bool EmbreeReference::occluded(const Ray& ray) const {
    RTCRay query{ray.origin.x,
                 ray.origin.y,
                 ray.origin.z,
                 ray.t_min,
                 ray.direction.x,
                 ray.direction.y,
                 ray.direction.z,
                 0,
                 ray.t_max,
                 ~0U,
                 0,
                 0};
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(impl_->scene, &context, &query);
    return query.tfar < 0;
}

}  // namespace raycache::tracer
