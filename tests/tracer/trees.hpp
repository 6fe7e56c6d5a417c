// What the tests of trees share: the form that every one has, comparison, and triangles that spatial splits cut.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>

#include "test_meshes.hpp"
#include "tracer/bvh/bvh.hpp"

namespace raycache::tracer::test {

inline bool contains(const Box& outer, const Box& inner) {
    return min(outer.lower, inner.lower) == outer.lower && max(outer.upper, inner.upper) == outer.upper;
}

struct Walk {
    const Bvh& bvh;
    std::uint32_t next = 0, depth = 0;
    bool good = true;

    /// Visits the subtree at `node` and expects its nodes one after another.
    void visit(std::uint32_t node, std::uint32_t level) {
        good = good && node == next++ && node < bvh.nodes.size();
        if (!good) return;
        depth = std::max(depth, level);
        const Bvh::Node& n = bvh.nodes[node];
        if (n.is_leaf()) return;
        for (const std::uint32_t child : {node + 1, n.first}) {
            visit(child, level + 1);
            if (!good) return;
            good = contains(n.box, bvh.nodes[child].box);
        }
    }
};

inline void check_shape(const Bvh& bvh, std::uint32_t max_leaf_size) {
    Walk walk{bvh};
    walk.visit(0, 0);
    CHECK(walk.good);
    CHECK(walk.next == bvh.nodes.size());
    CHECK(walk.depth == bvh.depth);
    std::uint32_t covered = 0;
    bool leaves_good = true;
    for (const Bvh::Node& node : bvh.nodes) {
        if (!node.is_leaf()) continue;
        leaves_good = leaves_good && node.first == covered && node.count <= max_leaf_size;
        covered += node.count;
    }
    CHECK(leaves_good);
    CHECK(covered == bvh.triangles.size());
}

inline bool equal(const Bvh& a, const Bvh& b) {
    return a.triangles == b.triangles && a.depth == b.depth &&
           std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), [](const auto& x, const auto& y) {
               return x.box == y.box && x.first == y.first && x.count == y.count;
           });
}

/// Long thin triangles across the box, among small ones: they overlap whatever the tree.
inline Scene sticks() {
    Random random(3);
    Scene scene = soup(5000, 0.05F, 3);
    for (int i = 0; i < 200; ++i) {
        const Vec3 a = random.in({{-1, -1, -1}, {1, 1, 1}}), b = a + random.direction() * 1.5F;
        append(scene, mesh({a, b, b + random.direction() * 0.1F}, {0, 1, 2}));
    }
    return scene;
}

/// A chain: each inner node has a leaf of triangle 0 and the rest, the last one triangle 1. All boxes are the scene's.
inline Bvh chain(const Scene& scene, std::uint32_t levels) {
    Bvh deep;
    for (std::uint32_t i = 0; i < levels; ++i) {
        deep.nodes.push_back({scene.bounds(), 2 * i + 2, 0});
        deep.nodes.push_back({scene.bounds(), i, 1});
        deep.triangles.push_back(0);
    }
    deep.nodes.push_back({scene.bounds(), levels, 1});
    deep.triangles.push_back(1);
    deep.depth = levels;
    return deep;
}

}  // namespace raycache::tracer::test
