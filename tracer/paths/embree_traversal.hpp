// Walks the rays of an integrator with Embree, one by one: no SIMT order, nothing recorded.
#pragma once

#include <bit>
#include <cstdint>

#include "tracer/bvh/embree_scene.hpp"
#include "tracer/paths/traversal.hpp"

namespace raycache::tracer {

class EmbreeTraversal final : public Traversal {
public:
    explicit EmbreeTraversal(const EmbreeScene& scene) : scene_(scene) {}

    void closest(std::uint32_t mask, traces::RayType, std::uint8_t, const Ray* rays, Hit* hits) override {
        for (; mask != 0; mask &= mask - 1) {
            const int l = std::countr_zero(mask);
            hits[l] = scene_.intersect(rays[l]);
        }
    }
    std::uint32_t occluded(std::uint32_t mask, traces::RayType, std::uint8_t, const Ray* rays) override {
        std::uint32_t blocked = 0;
        for (; mask != 0; mask &= mask - 1) {
            const int l = std::countr_zero(mask);
            blocked |= std::uint32_t{scene_.occluded(rays[l])} << l;
        }
        return blocked;
    }
    void read_texels(std::uint32_t, traces::RayType, std::uint8_t, const std::uint32_t*) override {}

private:
    const EmbreeScene& scene_;
};

}  // namespace raycache::tracer
