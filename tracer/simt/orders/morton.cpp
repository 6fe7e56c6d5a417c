// Morton code of the origin in the scene's bounds, 10 bits an axis: rays that leave from the same place together,
// whatever their direction.
#include "tracer/simt/orders/morton_code.hpp"
#include "tracer/simt/orders/ray_order.hpp"

namespace raycache::tracer {
namespace {

class Morton final : public RayOrder {
public:
    explicit Morton(const Scene& scene) : grid_(scene.bounds(), 1024) {}
    std::uint32_t key(const Ray& ray) const override { return morton_code(grid_(ray.origin)); }
    unsigned key_bits() const override { return 30; }

private:
    CellGrid grid_;
};

}  // namespace

RayOrderEntry morton_order() {
    return {"morton", "Morton code of the origin",
            [](const Scene& scene) -> std::unique_ptr<RayOrder> { return std::make_unique<Morton>(scene); }};
}

}  // namespace raycache::tracer
