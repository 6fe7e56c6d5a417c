#include "tracer/bvh/layouts/node_order.hpp"

#include <algorithm>
#include <queue>
#include <utility>

#include "tracer/bvh/box_area.hpp"

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

namespace {

template <class Visit>
void visit_inner_children(const Bvh& bvh, std::uint32_t node, const Visit& visit) {
    for (const std::uint32_t child : {node + 1, bvh.nodes[node].first})
        if (!bvh.nodes[child].is_leaf()) visit(child);
}

/// Levels of inner nodes below and including each node.
std::vector<std::uint8_t> heights(const Bvh& bvh) {
    std::vector<std::uint8_t> height(bvh.nodes.size(), 0);
    for (auto i = static_cast<std::uint32_t>(bvh.nodes.size()); i-- > 0;) {  // children stand behind their parent
        if (bvh.nodes[i].is_leaf()) continue;
        height[i] = static_cast<std::uint8_t>(1 + std::max(height[i + 1], height[bvh.nodes[i].first]));
    }
    return height;
}

/// Appends the uppermost `levels` levels of the subtree; the nodes right below go to `below`, from left to right.
void append_top(const Bvh& bvh, const std::vector<std::uint8_t>& height, std::uint32_t node, unsigned levels,
                std::vector<std::uint32_t>& order, std::vector<std::uint32_t>& below) {
    if (levels == 1) {
        order.push_back(node);
        visit_inner_children(bvh, node, [&](std::uint32_t child) { below.push_back(child); });
        return;
    }
    const unsigned upper = levels / 2;
    std::vector<std::uint32_t> middle;
    append_top(bvh, height, node, upper, order, middle);
    for (const std::uint32_t root : middle)
        append_top(bvh, height, root, std::min<unsigned>(levels - upper, height[root]), order, below);
}

}  // namespace

std::vector<std::uint32_t> van_emde_boas(const Bvh& bvh) {
    std::vector<std::uint32_t> order, below;
    const auto height = heights(bvh);
    if (height.front() != 0) append_top(bvh, height, 0, height.front(), order, below);
    return order;
}

std::vector<std::uint32_t> treelets(const Bvh& bvh) {
    constexpr unsigned most_nodes = 2048 / 64;
    // By surface; of equal ones the first in the tree.
    using Candidate = std::pair<double, std::int64_t>;
    std::vector<std::uint32_t> order;
    std::priority_queue<Candidate> roots, fringe;
    const auto add = [&](std::priority_queue<Candidate>& to, std::uint32_t node) {
        to.emplace(half_area(bvh.nodes[node].box), -std::int64_t{node});
    };
    if (!bvh.nodes.front().is_leaf()) add(roots, 0);
    while (!roots.empty()) {
        fringe.push(roots.top());
        roots.pop();
        for (unsigned count = 0; count < most_nodes && !fringe.empty(); ++count) {
            const auto node = static_cast<std::uint32_t>(-fringe.top().second);
            fringe.pop();
            order.push_back(node);
            visit_inner_children(bvh, node, [&](std::uint32_t child) { add(fringe, child); });
        }
        for (; !fringe.empty(); fringe.pop()) roots.push(fringe.top());
    }
    return order;
}

}  // namespace raycache::tracer
