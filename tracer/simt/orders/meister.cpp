// The interleaved key of D. Meister, J. Boksansky, M. Guthe, J. Bittner: "On Ray Reordering Techniques for Faster GPU
// Ray Tracing", I3D 2020. 30 bits, in triples of one bit an axis from the top: three levels of the origin's cell, then
// levels of direction and origin in turn, the direction first: O O O D O D O D O D. So the origin has 6 bits an axis,
// the direction 4.
#include "tracer/simt/orders/morton_code.hpp"
#include "tracer/simt/orders/ray_order.hpp"

namespace raycache::tracer {
namespace {

class Meister final : public RayOrder {
public:
    explicit Meister(const Scene& scene) : grid_(scene.bounds(), 64) {}
    std::uint32_t key(const Ray& ray) const override {
        const std::uint32_t origin = morton_code(grid_(ray.origin));                     // 6 triples
        const std::uint32_t direction = morton_code(direction_cell(ray.direction, 16));  // 4 triples
        std::uint32_t key = origin >> 9;
        for (int level = 3; level >= 0; --level) {
            key = key << 3 | (direction >> (3 * level) & 7);
            if (level > 0) key = key << 3 | (origin >> (3 * (level - 1)) & 7);
        }
        return key;
    }
    unsigned key_bits() const override { return 30; }

private:
    CellGrid grid_;
};

}  // namespace

RayOrderEntry meister_order() {
    return {"meister", "three levels of the origin, then direction and origin interleaved (2020)",
            [](const Scene& scene) -> std::unique_ptr<RayOrder> { return std::make_unique<Meister>(scene); }};
}

}  // namespace raycache::tracer
