#include "tracer/bvh/layouts/node_order.hpp"

namespace raycache::tracer {

std::vector<std::uint32_t> depth_first(const Bvh& bvh) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i)  // that is how a Bvh is stored
        if (!bvh.nodes[i].is_leaf()) order.push_back(i);
    return order;
}

std::vector<std::uint32_t> breadth_first(const Bvh& bvh) {
    std::vector<std::uint32_t> order;
    if (!bvh.nodes.front().is_leaf()) order.push_back(0);
    for (std::size_t next = 0; next < order.size(); ++next)
        for (const std::uint32_t child : {order[next] + 1, bvh.nodes[order[next]].first})
            if (!bvh.nodes[child].is_leaf()) order.push_back(child);
    return order;
}

}  // namespace raycache::tracer
