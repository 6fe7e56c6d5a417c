// A node of layout `bvh4`, and how a lane steps through such nodes: to the nearest child hit, or back to the nearest
// sibling left on its way. Popped entries are not culled by distance.
#pragma once

#include <cstdint>

#include "tracer/bvh/layouts/bvh2_node.hpp"
#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/bvh/layouts/leaf_triangle.hpp"
#include "tracer/bvh/ray_boxes4.hpp"

namespace raycache::tracer {

/// 128 bytes: planes of four boxes by axis, and what lies in them. An absent child has lower > upper.
struct alignas(64) Bvh4Node {
    float lower[3][4], upper[3][4];
    std::uint32_t child[4];  ///< ChildRef
    std::uint32_t unused[4];
};
static_assert(sizeof(Bvh4Node) == 128);

struct Bvh4View {
    const Bvh4Node* nodes;
    const LeafTriangle* triangles;

    const LeafTriangle& triangle(std::uint32_t element) const { return triangles[element]; }
};

/// See WalkableBvh.
class Bvh4Lane {
public:
    using StackEntry = std::uint32_t;  ///< ChildRef

    void start(const Ray& ray, StackEntry* stack) {
        ray_.set(ray);
        top_ = stack;
        *top_ = ChildRef::nothing;
        current_ = 0;
    }
    void shorten(float t) { ray_.set_t_max(t); }

    std::uint32_t node() const { return current_; }

    LaneStep visit_node(const Bvh4View& view) {
        const Bvh4Node& node = view.nodes[current_];
        __m128 lower[3], upper[3], entry;
        for (int axis = 0; axis < 3; ++axis) {
            lower[axis] = _mm_load_ps(node.lower[axis]);
            upper[axis] = _mm_load_ps(node.upper[axis]);
        }
        unsigned hit = test_four_boxes(lower, upper, ray_, entry);
        if (hit == 0) return pop();
        alignas(16) float distance[4];
        _mm_store_ps(distance, entry);
        // By distance, the farthest first; of equal ones the last child first.
        unsigned order[4];
        unsigned count = 0;
        for (; hit != 0; hit &= hit - 1) {
            const auto child = static_cast<unsigned>(__builtin_ctz(hit));
            unsigned place = count++;
            for (; place > 0 && distance[order[place - 1]] <= distance[child]; --place) order[place] = order[place - 1];
            order[place] = child;
        }
        for (unsigned i = 0; i + 1 < count; ++i) *++top_ = node.child[order[i]];
        return go_to(node.child[order[count - 1]]);
    }

    std::uint32_t take_triangle() {
        const std::uint32_t element = ChildRef::first(current_);
        current_ += ChildRef::next_triangle;
        return element;
    }
    bool more_triangles() const { return ChildRef::count(current_) != 0; }
    LaneStep leave_triangles() { return pop(); }
    LaneStep end() { return go_to(ChildRef::nothing); }

private:
    LaneStep pop() { return go_to(*top_--); }
    LaneStep go_to(std::uint32_t ref) {
        current_ = ref;
        return {0, ~ref >> 31, ref == ChildRef::nothing};
    }

    WideBoxRay ray_;
    StackEntry* top_;        ///< the topmost entry; popping the sentinel `nothing` ends the lane
    std::uint32_t current_;  ///< where the lane stands: a node, what is left of a leaf, or nothing
};

}  // namespace raycache::tracer
