#include "tracer/bvh/embree_scene.hpp"

#include "tracer/bvh/embree_parts.hpp"

namespace raycache::tracer {

EmbreeScene::EmbreeScene(const Scene& scene) : parts_(std::make_unique<EmbreeParts>(scene, nullptr)) {}
EmbreeScene::EmbreeScene(const Scene& scene, const TexelLayout& texels)
    : parts_(std::make_unique<EmbreeParts>(scene, &texels)) {}
EmbreeScene::~EmbreeScene() = default;

Hit EmbreeScene::intersect(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit found;
    if (!parts_->closest(ray, context, found)) return {};
    return {found.ray.tfar, found.hit.u, found.hit.v, parts_->triangle(found.hit.geomID, found.hit.primID)};
}

bool EmbreeScene::occluded(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    return parts_->occluded(ray, context);
}

}  // namespace raycache::tracer
