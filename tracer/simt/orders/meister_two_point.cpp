// The two-point key discussed by D. Meister, J. Boksansky, M. Guthe, J. Bittner: "On Ray Reordering Techniques for
// Faster GPU Ray Tracing", I3D 2020: the cell where the ray starts and the cell where it is expected to end, 5 bits an
// axis each, interleaved triple by triple, the origin first. Where a ray ends is not known before it is traced. Here it
// is a guess without memory: a quarter of the scene's largest extent along the ray, clamped to the scene's bounds. The
// paper's own estimators, which learn from earlier rays, are not built.
#include <algorithm>

#include "tracer/simt/orders/morton_code.hpp"
#include "tracer/simt/orders/ray_order.hpp"

namespace raycache::tracer {
namespace {

class MeisterTwoPoint final : public RayOrder {
public:
    explicit MeisterTwoPoint(const Scene& scene) : grid_(scene.bounds(), 32) {
        const Box bounds = scene.bounds();
        length_ = 0.25F * max_component(bounds.upper - bounds.lower);
    }
    std::uint32_t key(const Ray& ray) const override {
        const float t = std::min(length_, ray.t_max * length(ray.direction));
        const std::uint32_t first = morton_code(grid_(ray.origin));
        const std::uint32_t last = morton_code(grid_(ray.origin + normalize(ray.direction) * t));
        std::uint32_t key = 0;
        for (int level = 4; level >= 0; --level)
            key = key << 6 | (first >> (3 * level) & 7) << 3 | (last >> (3 * level) & 7);
        return key;
    }
    unsigned key_bits() const override { return 30; }

private:
    CellGrid grid_;
    float length_ = 0;  ///< expected of every ray
};

}  // namespace

RayOrderEntry meister_two_point_order() {
    return {"meister-two-point", "origin and expected end of the ray interleaved (2020)",
            [](const Scene& scene) -> std::unique_ptr<RayOrder> { return std::make_unique<MeisterTwoPoint>(scene); }};
}

}  // namespace raycache::tracer
