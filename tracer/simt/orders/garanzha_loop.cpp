// K. Garanzha, C. Loop: "Fast Ray Sorting and Breadth-First Packet Traversal for GPU Ray Tracing", Eurographics 2010.
// A hash of the origin's cell in a grid over the scene and of the direction's cell, compared as a number. Neighbours
// with equal hashes are compressed to one run before the sort and expanded after it, so that coherent rays cost less.
// The paper leaves the sizes of the grids open; here 2^5 cells an axis for origins, 2^3 for directions.
#include "tracer/simt/orders/morton_code.hpp"
#include "tracer/simt/orders/ray_order.hpp"

namespace raycache::tracer {
namespace {

class GaranzhaLoop final : public RayOrder {
public:
    explicit GaranzhaLoop(const Scene& scene) : grid_(scene.bounds(), 32) {}
    std::uint32_t key(const Ray& ray) const override {
        return morton_code(grid_(ray.origin)) << 9 | morton_code(direction_cell(ray.direction, 8));
    }
    unsigned key_bits() const override { return 24; }
    bool compresses_runs() const override { return true; }

private:
    CellGrid grid_;
};

}  // namespace

RayOrderEntry garanzha_loop_order() {
    return {"garanzha-loop", "hash of origin and direction cells; runs of equal hashes are sorted as one (2010)",
            [](const Scene& scene) -> std::unique_ptr<RayOrder> { return std::make_unique<GaranzhaLoop>(scene); }};
}

}  // namespace raycache::tracer
