// The octant of the direction in the top 3 bits, the Morton code of the origin, 9 bits an axis, below: rays that agree
// on which child of a node is the nearer one come first together. The combination is a common baseline of papers on
// ray reordering, such as Meister et al. 2020.
#include "tracer/simt/orders/morton_code.hpp"
#include "tracer/simt/orders/ray_order.hpp"

namespace raycache::tracer {
namespace {

class OctantMorton final : public RayOrder {
public:
    explicit OctantMorton(const Scene& scene) : grid_(scene.bounds(), 512) {}
    std::uint32_t key(const Ray& ray) const override {
        return octant(ray.direction) << 27 | morton_code(grid_(ray.origin));
    }
    unsigned key_bits() const override { return 30; }

private:
    CellGrid grid_;
};

}  // namespace

RayOrderEntry octant_morton_order() {
    return {"octant-morton", "octant of the direction, then Morton code of the origin",
            [](const Scene& scene) -> std::unique_ptr<RayOrder> { return std::make_unique<OctantMorton>(scene); }};
}

}  // namespace raycache::tracer
