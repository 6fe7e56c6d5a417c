// The list of ray orders. To add one: write a file in this folder that defines `RayOrderEntry NAME_order()` in
// namespace raycache::tracer, and add X(NAME) below.
#include "tracer/simt/orders/ray_order.hpp"

#define RAYCACHE_RAY_ORDERS(X) \
    X(no)                      \
    X(morton)                  \
    X(octant_morton)           \
    X(garanzha_loop)           \
    X(meister)                 \
    X(meister_two_point)       \
    X(pharr)                   \
    X(moon)

namespace raycache::tracer {

#define X(name) RayOrderEntry name##_order();
RAYCACHE_RAY_ORDERS(X)
#undef X

RayOrderEntry no_order() {
    return {"none", "as the paths of the bounce before were shaded",
            [](const Scene&) -> std::unique_ptr<RayOrder> { return nullptr; }};
}

const std::vector<RayOrderEntry>& ray_orders() {
#define X(name) name##_order(),
    static const std::vector<RayOrderEntry> all{RAYCACHE_RAY_ORDERS(X)};
#undef X
    return all;
}

}  // namespace raycache::tracer
