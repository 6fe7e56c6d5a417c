// Pseudo-LRU by a binary tree of bits (Handy, The Cache Memory Book, 1993): each inner node of a tree over the ways
// says which of its halves to evict from.
//
// The tree, for any number of ways: a node over n >= 2 ways has the first ceil(n / 2) of them on its left and the other
// floor(n / 2) on its right. All bits say left at first. A use of a way makes every node on the path to it say the
// other half. The victim is found by going from the root where the bits say. So among 3 ways, way 2 is evicted as often
// as ways 0 and 1 together. An empty way is taken before any is evicted, in ascending order.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/cache/level.hpp"
#include "cachesim/cache/policies/victim_order.hpp"
#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

class TreePlruOrder {
public:
    TreePlruOrder(std::uint64_t sets, std::uint64_t ways) : ways_(ways), right_(sets * (ways - 1)) {}

    void use(std::uint64_t set, std::uint64_t way) {
        walk(set, [&](std::uint64_t node, std::uint64_t middle) {
            const bool goes_right = way >= middle;
            right_[node] = !goes_right;
            return goes_right;
        });
    }

    std::uint64_t victim(std::uint64_t set) {
        return walk(set, [&](std::uint64_t node, std::uint64_t) { return right_[node]; });
    }

private:
    /// From the root to a way. `goes_right` gets a node and the first way of its right half. Nodes are numbered in
    /// preorder: below a node over n ways stand n - 2 others, those of its left half first.
    template <class GoesRight>
    std::uint64_t walk(std::uint64_t set, GoesRight goes_right) {
        std::uint64_t node = set * (ways_ - 1), first = 0, n = ways_;
        while (n > 1) {
            const std::uint64_t left = (n + 1) / 2;
            if (goes_right(node, first + left)) {
                node += left;
                first += left;
                n -= left;
            } else {
                node += 1;
                n = left;
            }
        }
        return first;
    }

    std::uint64_t ways_;
    std::vector<bool> right_;  ///< of each inner node of each set: evict from the right half
};

std::unique_ptr<Level> make_tree_plru(const CacheGeometry&, CacheRange caches, std::uint64_t lines, InstructionSet);
std::unique_ptr<VictimOrder> order_tree_plru(const CacheGeometry&, unsigned cache);

}  // namespace raycache::cachesim
