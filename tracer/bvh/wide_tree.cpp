#include "tracer/bvh/wide_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "tracer/bvh/box_area.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

/// How to make the fewest of a subtree. At 0: 1 if a single root should be a leaf. At j - 1, for at most j roots: how
/// many of them its first child gives; 0: as for j - 1 roots. At width - 1: of the children of an inner node.
using Decision = std::array<std::uint8_t, most_children>;

/// What the parent of a subtree asks.
struct Subtree {
    std::array<double, most_children> cost{};  ///< at j - 1: as at most j roots
    std::uint64_t triangles = 0;
};

class Collapse {
public:
    Collapse(const Bvh& bvh, unsigned width, std::uint32_t max_leaf_size, const ArrangeChildren& arrange)
        : bvh_(bvh), width_(width), max_leaf_size_(max_leaf_size), arrange_(arrange) {
        decide();
    }

    WideTree tree() {
        struct Pending {
            std::uint32_t inner, depth;
        };
        tree_.nodes.push_back({0, 0, 0});
        std::vector<Pending> stack{{0, 0}};
        std::vector<WideTree::Child> children;
        while (!stack.empty()) {
            const auto [inner, depth] = stack.back();
            stack.pop_back();
            tree_.depth = std::max(tree_.depth, depth);
            const std::uint32_t node = tree_.nodes[inner].node;
            children.clear();
            if (bvh_.nodes[node].is_leaf()) {  // the whole tree is one
                add_roots(node, 1, children);
            } else {
                const unsigned of_first = decisions_[node][width_ - 1];
                add_roots(node + 1, of_first, children);
                add_roots(bvh_.nodes[node].first, width_ - of_first, children);
            }
            if (arrange_) arrange_(node, children);
            const auto next = static_cast<std::uint32_t>(tree_.nodes.size());
            for (WideTree::Child& child : children) {
                if (child.is_leaf()) continue;
                child.inner = static_cast<std::uint32_t>(tree_.nodes.size());
                tree_.nodes.push_back({child.node, 0, 0});
            }
            for (auto below = static_cast<std::uint32_t>(tree_.nodes.size()); below-- > next;)
                stack.push_back({below, depth + 1});
            tree_.nodes[inner].first = static_cast<std::uint32_t>(tree_.children.size());
            tree_.nodes[inner].count = static_cast<std::uint32_t>(children.size());
            tree_.children.insert(tree_.children.end(), children.begin(), children.end());
        }
        return std::move(tree_);
    }

private:
    /// From the last node to the first: children stand behind their parent, the first child's subtree right behind it.
    void decide() {
        decisions_.resize(bvh_.nodes.size());
        std::vector<Subtree> stack;
        for (std::size_t i = bvh_.nodes.size(); i-- > 0;) {
            const Bvh::Node& node = bvh_.nodes[i];
            Subtree made;
            if (node.is_leaf()) {
                if (node.count > max_leaf_size_)
                    throw Error(fmt::format("a leaf of {} triangles; this BVH layout holds {} in a leaf", node.count,
                                            max_leaf_size_));
                made.triangles = node.count;
                made.cost.fill(half_area(node.box) * node.count);
                decisions_[i] = {1};
            } else {
                const Subtree first = stack.back();
                stack.pop_back();
                made = join(first, stack.back(), half_area(node.box), decisions_[i]);
                stack.pop_back();
            }
            stack.push_back(made);
        }
    }

    Subtree join(const Subtree& first, const Subtree& second, double area, Decision& decision) const {
        Subtree made;
        made.triangles = first.triangles + second.triangles;
        const auto distribute = [&](unsigned roots) {
            std::pair<double, unsigned> best{std::numeric_limits<double>::infinity(), 1};
            for (unsigned k = 1; k < roots; ++k)
                best = std::min(best, {first.cost[k - 1] + second.cost[roots - k - 1], k});
            return best;
        };
        const auto [below, of_first] = distribute(width_);
        decision[width_ - 1] = static_cast<std::uint8_t>(of_first);
        const double inner = below + area;
        const double leaf = made.triangles <= max_leaf_size_ ? area * static_cast<double>(made.triangles)
                                                             : std::numeric_limits<double>::infinity();
        decision[0] = leaf <= inner;
        made.cost[0] = std::min(leaf, inner);
        for (unsigned roots = 2; roots < width_; ++roots) {
            const auto [cost, k] = distribute(roots);
            const double fewer = made.cost[roots - 2];
            decision[roots - 1] = static_cast<std::uint8_t>(cost <= fewer ? k : 0);
            made.cost[roots - 1] = std::min(cost, fewer);
        }
        return made;
    }

    /// The subtree as at most `roots` children.
    void add_roots(std::uint32_t node, unsigned roots, std::vector<WideTree::Child>& children) const {
        const Decision& decision = decisions_[node];
        if (!bvh_.nodes[node].is_leaf()) {
            while (roots > 1 && decision[roots - 1] == 0) --roots;
            if (roots > 1) {
                const unsigned of_first = decision[roots - 1];
                add_roots(node + 1, of_first, children);
                add_roots(bvh_.nodes[node].first, roots - of_first, children);
                return;
            }
        }
        WideTree::Child child{node, 0, 0, 0};
        if (decision[0] != 0) {
            std::uint32_t leaf = node;
            while (!bvh_.nodes[leaf].is_leaf()) ++leaf;  // the first of those below
            child.first = bvh_.nodes[leaf].first;
            child.count = triangles(node);
        }
        children.push_back(child);
    }

    std::uint32_t triangles(std::uint32_t node) const {
        const Bvh::Node& n = bvh_.nodes[node];
        return n.is_leaf() ? n.count : triangles(node + 1) + triangles(n.first);
    }

    const Bvh& bvh_;
    unsigned width_;
    std::uint32_t max_leaf_size_;
    const ArrangeChildren& arrange_;
    std::vector<Decision> decisions_;
    WideTree tree_;
};

}  // namespace

WideTree collapse(const Bvh& bvh, unsigned width, std::uint32_t max_leaf_size, const ArrangeChildren& arrange) {
    return Collapse(bvh, width, max_leaf_size, arrange).tree();
}

}  // namespace raycache::tracer
