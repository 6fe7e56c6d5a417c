// M. Pharr, C. Kolb, R. Gershbein, P. Hanrahan: "Rendering Complex Scenes with Memory-Coherent Ray Tracing", SIGGRAPH
// 1997. Rays wait in the queue of the voxel of a regular grid that they are in; a voxel's queue is worked off as one.
// There, rays walk from voxel to voxel and the scheduler picks the voxel whose geometry is cached. Here a ray walks the
// whole BVH at once, so a ray waits once, in the voxel of its origin; queues are taken in scan order of 16^3 voxels,
// first in, first out.
#include "tracer/simt/orders/morton_code.hpp"
#include "tracer/simt/orders/ray_order.hpp"

namespace raycache::tracer {
namespace {

class Pharr final : public RayOrder {
public:
    explicit Pharr(const Scene& scene) : grid_(scene.bounds(), 16) {}
    std::uint32_t key(const Ray& ray) const override {
        const Cell voxel = grid_(ray.origin);
        return voxel.z << 8 | voxel.y << 4 | voxel.x;
    }
    unsigned key_bits() const override { return 12; }

private:
    CellGrid grid_;
};

}  // namespace

RayOrderEntry pharr_order() {
    return {"pharr", "queues of the voxels where rays start, in scan order (1997)",
            [](const Scene& scene) -> std::unique_ptr<RayOrder> { return std::make_unique<Pharr>(scene); }};
}

}  // namespace raycache::tracer
