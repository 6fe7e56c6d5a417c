// How a lane steps through a `bvh2`: to the nearer child hit, or back to the sibling it left last. Popped entries are
// not culled by distance: like the kernels this models, the stack holds no distances.
#pragma once

#include <immintrin.h>

#include <bit>
#include <cstdint>

#include "tracer/bvh/layouts/bvh2_node.hpp"
#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/bvh/layouts/leaf_triangle.hpp"
#include "tracer/bvh/ray_box.hpp"

namespace raycache::tracer {

struct Bvh2View {
    const Bvh2Node* nodes;
    const LeafTriangle* triangles;

    const LeafTriangle& triangle(std::uint32_t element) const { return triangles[element]; }

    /// Asks the cache for a node, or for the first triangle of a leaf: the other lanes of the warp come before it is
    /// read.
    void fetch_ahead(std::uint32_t ref) const {
        const std::uintptr_t node = reinterpret_cast<std::uintptr_t>(nodes) + std::uintptr_t{ref} * sizeof(Bvh2Node);
        const std::uintptr_t first =
            reinterpret_cast<std::uintptr_t>(triangles) + std::uintptr_t{ChildRef::first(ref)} * sizeof(LeafTriangle);
        const auto* const at = reinterpret_cast<const char*>(ChildRef::is_leaf(ref) ? first : node);
        _mm_prefetch(at, _MM_HINT_T0);
        _mm_prefetch(at + sizeof(LeafTriangle) - 1, _MM_HINT_T0);  // it may lie across two lines
    }
};

/// See WalkableBvh. The hot loop of a capture touches little else.
class Bvh2Lane {
public:
    struct StackEntry {
        std::uint32_t height;  ///< height_ below this sibling
        std::uint32_t ref;
    };
    /// Beside the siblings: one entry that is never read, and the sentinel.
    static constexpr std::size_t more_stack_entries = 2;

    void start(const Ray& ray, StackEntry* stack) {
        box_.set(ray);
        top_ = stack + 1;
        *top_ = {0, ChildRef::nothing};
        current_ = 0;
        height_ = 0;
    }
    void shorten(float t) { box_.set_t_max(t); }

    std::uint32_t node() const { return current_; }

    /// Which way a ray goes is what a branch predictor cannot know: there is no branch.
    LaneStep visit_node(const Bvh2View& view) {
        const Bvh2Node& node = view.nodes[current_];
        const BoxHits& hit = test_boxes(node, box_);
        const std::uint64_t near_far =
            std::rotr(std::bit_cast<std::uint64_t>(node.child), static_cast<int>(hit.near_shift));
        StackEntry* top = top_;
        const std::uint32_t pushed = height_ + 1;
        // Counts only if both are hit.
        top[1] = std::bit_cast<StackEntry>((near_far & ~std::uint64_t{0xffffffff}) | height_);
        top += hit.both;
        const auto near = static_cast<std::uint32_t>(near_far);
        const std::uint32_t ref = near ^ ((near ^ top->ref) & hit.none);
        const std::uint32_t height = pushed ^ ((pushed ^ top->height) & hit.none);
        top_ = top - (hit.none & 1U);
        current_ = ref;
        height_ = height;
        view.fetch_ahead(ref);
        // The child taken; or, if none is, how far to pop.
        return {(hit.near_shift >> 5) + (pushed - height), ~ref >> 31, ref == ChildRef::nothing};
    }

    std::uint32_t take_triangle() {
        const std::uint32_t element = ChildRef::first(current_);
        current_ += ChildRef::next_triangle;
        return element;
    }
    bool more_triangles() const { return ChildRef::count(current_) != 0; }

    LaneStep leave_triangles() {
        const StackEntry popped = *top_--;
        const std::uint32_t symbol = height_ - popped.height - 1;
        current_ = popped.ref;
        height_ = popped.height;
        return {symbol, ~popped.ref >> 31, popped.ref == ChildRef::nothing};
    }

    LaneStep end() {
        current_ = ChildRef::nothing;
        return {0, 0, true};
    }

private:
    BoxRay box_;
    StackEntry* top_;        ///< the topmost stack entry; popping the sentinel `nothing` ends the lane
    std::uint32_t current_;  ///< where the lane stands: a node, what is left of a leaf, or nothing
    /// Siblings of the nodes on the way here that have not been visited, hit or not: the height of the stack that the
    /// trace's symbols speak of.
    std::uint32_t height_;
};

}  // namespace raycache::tracer
