#include "tracer/bvh/embree_scene.hpp"

#include "tracer/bvh/embree_parts.hpp"

namespace raycache::tracer {

struct EmbreeScene::Impl : EmbreeParts {
    using EmbreeParts::EmbreeParts;
};

EmbreeScene::EmbreeScene(const Scene& scene) : impl_(std::make_unique<Impl>(scene, nullptr)) {}
EmbreeScene::EmbreeScene(const Scene& scene, const TexelLayout& texels)
    : impl_(std::make_unique<Impl>(scene, &texels)) {}
EmbreeScene::~EmbreeScene() = default;

Hit EmbreeScene::intersect(const Ray& ray) const {
    if (!EmbreeParts::takes(ray)) return {};
    RTCRayHit query;
    query.ray = EmbreeParts::query(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(impl_->handle(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {query.ray.tfar, query.hit.u, query.hit.v, impl_->triangle(query.hit.geomID, query.hit.primID)};
}

bool EmbreeScene::occluded(const Ray& ray) const {
    if (!EmbreeParts::takes(ray)) return false;
    RTCRay query = EmbreeParts::query(ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(impl_->handle(), &context, &query);
    return query.tfar < 0;
}

}  // namespace raycache::tracer
