// How a lane steps through a `cwbvh8`: groups of children instead of single ones. A visit yields the nodes hit, a bit
// each in the order of the ray's octant, and the triangles of the leaves hit. Triangles are tested first; then the lane
// goes to the first node of the group, and the rest of the group goes onto the stack as one entry of 8 bytes. Entries
// hold no distances.
//
// Two things differ from the kernel of Ylitie et al. 2017. Lanes do not put triangles on the stack when few have any:
// the warp tests them all before it goes on, as with every layout (warp_traversal.hpp). And planes are decoded before
// they are compared, instead of scaling the ray, so that a decoded box is never missed.
#pragma once

#include <immintrin.h>

#include <bit>
#include <cstdint>
#include <cstring>

#include "tracer/bvh/layouts/cwbvh8_node.hpp"
#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/bvh/layouts/leaf_triangle.hpp"
#include "tracer/bvh/ray_boxes4.hpp"

namespace raycache::tracer {

struct Cwbvh8View {
    const Cwbvh8Node* nodes;
    const LeafTriangle* triangles;

    const LeafTriangle& triangle(std::uint32_t element) const { return triangles[element]; }
};

/// See WalkableBvh.
class Cwbvh8Lane {
public:
    /// Nodes still to be visited, of one parent.
    struct StackEntry {
        std::uint32_t first_node;
        std::uint32_t bits;  ///< 31 … 24: hit, in the order of visits; 7 … 0: slots of the parent that hold nodes
    };

    void start(const Ray& ray, StackEntry* stack) {
        ray_.set(ray);
        octant_ = 7U ^ ((ray_.negative[0] ? 4U : 0U) | (ray_.negative[1] ? 2U : 0U) | (ray_.negative[2] ? 1U : 0U));
        bottom_ = top_ = stack;
        nodes_ = {};
        triangles_ = 0;
        node_ = 0;
    }
    void shorten(float t) { ray_.set_t_max(t); }

    std::uint32_t node() const { return node_; }

    LaneStep visit_node(const Cwbvh8View& view) {
        const Cwbvh8Node& node = view.nodes[node_];
        std::uint32_t bits = 0;
        for (unsigned hit = hit_slots(node); hit != 0; hit &= hit - 1) {
            const unsigned meta = node.meta[std::countr_zero(hit)];
            unsigned place = meta & 31;
            if (place >= Cwbvh8Node::first_inner) place ^= octant_;
            bits |= (meta >> 5) << place;
        }
        nodes_ = {node.first_node, (bits & 0xff000000U) | node.inner};
        triangles_ = bits & 0x00ffffffU;
        first_triangle_ = node.first_triangle;
        return triangles_ != 0 ? LaneStep{0, 0, false} : next_node();
    }

    std::uint32_t take_triangle() {
        const std::uint32_t element = first_triangle_ + static_cast<std::uint32_t>(std::countr_zero(triangles_));
        triangles_ &= triangles_ - 1;
        return element;
    }
    bool more_triangles() const { return triangles_ != 0; }
    LaneStep leave_triangles() { return next_node(); }
    LaneStep end() {
        triangles_ = 0;
        return {0, 0, true};
    }

private:
    /// A bit for each slot whose decoded box the ray meets.
    unsigned hit_slots(const Cwbvh8Node& node) const {
        unsigned hit = 0;
        for (unsigned half = 0; half < 8; half += 4) {
            __m128 lower[3], upper[3], entry;
            for (int axis = 0; axis < 3; ++axis) {
                const __m128 origin = _mm_set1_ps(node.origin[axis]), scale = _mm_set1_ps(node.scale(axis));
                const auto planes = [&](const std::uint8_t* steps) {
                    std::uint32_t four;
                    std::memcpy(&four, steps + half, sizeof four);
                    const __m128i wide = _mm_cvtepu8_epi32(_mm_cvtsi32_si128(static_cast<int>(four)));
                    return _mm_add_ps(origin, _mm_mul_ps(_mm_cvtepi32_ps(wide), scale));
                };
                lower[axis] = planes(node.lower[axis]);
                upper[axis] = planes(node.upper[axis]);
            }
            hit |= test_four_boxes(lower, upper, ray_, entry) << half;
        }
        return hit;
    }

    LaneStep next_node() {
        if ((nodes_.bits >> 24) == 0) {
            if (top_ == bottom_) return end();
            nodes_ = *--top_;
        }
        const auto highest = 31U - static_cast<unsigned>(std::countl_zero(nodes_.bits));
        const unsigned slot = (highest - Cwbvh8Node::first_inner) ^ octant_;
        node_ = nodes_.first_node + static_cast<std::uint32_t>(std::popcount(nodes_.bits & ((1U << slot) - 1)));
        nodes_.bits &= ~(1U << highest);
        if ((nodes_.bits >> 24) != 0) *top_++ = nodes_;
        return {0, 1, false};
    }

    WideBoxRay ray_;
    unsigned octant_;  ///< exclusive or of a slot and its place in the order of visits
    StackEntry *bottom_, *top_;
    StackEntry nodes_;         ///< hit by the last visit
    std::uint32_t triangles_;  ///< a bit each, of those to be tested
    std::uint32_t first_triangle_ = 0;
    std::uint32_t node_;  ///< where the lane stands, unless at triangles
};

}  // namespace raycache::tracer
