// 32 rays walk a bvh2 together, as the lanes of a warp do: "while-while" of Aila & Laine 2009. The warp repeats
//   1. while a lane stands at an inner node: all such lanes visit their node (one warp access) and step to the nearer
//   child hit, or
//      pop; lanes that arrive at a leaf wait;
//   2. while a waiting lane has an untested triangle: all such lanes test their next one (one warp access); then they
//   pop.
// Popped entries are not culled by distance: like the kernels this models, the stack holds no distances.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "tracer/bvh/layouts/bvh2.hpp"
#include "tracer/ray.hpp"
#include "tracer/scene/cutout.hpp"
#include "tracer/simt/ray_box.hpp"
#include "tracer/simt/ray_triangle.hpp"
#include "tracer/simt/recorder.hpp"

namespace raycache::tracer {

/// `Recorder` is WarpRecorder to write a trace, NullRecorder to render.
template <class Recorder>
class WarpTraversal {
public:
    static constexpr unsigned lanes = traces::warp_lanes;

    WarpTraversal(const Scene& scene, const Bvh2& bvh, const TexelLayout& texels, Recorder& recorder)
        : scene_(&scene), bvh_(&bvh), texels_(&texels), recorder_(&recorder), stack_(std::size_t{lanes} * stride()) {}

    /// Nearest hit of each lane in `mask`. Texels with alpha below the cutoff are holes.
    void closest(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays, Hit* hits) {
        begin(mask, type, bounce, rays, hits);
        run<false>(hits);
    }

    /// Lanes whose ray meets anything in (t_min, t_max]: a lane stops at its first hit.
    std::uint32_t occluded(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays) {
        Hit hits[lanes];
        begin(mask, type, bounce, rays, hits);
        return run<true>(hits);
    }

    /// The lanes of `mask` each read one texel for shading; lane l reads `elements[l]`.
    void read_texels(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const std::uint32_t* elements) {
        recorder_->kind(type, bounce);
        record_texels(mask, 0, elements);
    }

private:
    /// One entry that is never read, the sentinel, the entries.
    std::size_t stride() const { return bvh_->stack_entries + 2; }

    struct StackEntry {
        std::uint32_t height;  ///< Lane::height below this sibling
        std::uint32_t ref;
    };

    /// One lane's place in the tree. The hot loop touches little else.
    struct alignas(64) Lane {
        BoxRay box;
        StackEntry* top;        ///< the topmost stack entry; popping the sentinel `nothing` ends the lane
        std::uint32_t current;  ///< where the lane stands: a node, a leaf, or nothing
        /// Siblings of the nodes on the way here that have not been visited, hit or not: the height of the stack that
        /// the trace's symbols speak of.
        std::uint32_t height;
        std::uint32_t last_symbol = 0;  ///< its place; set wherever the lane may end
    };

    void begin(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays, Hit* hits) {
        recorder_->kind(type, bounce);
        std::uint32_t symbol = recorder_->start_rays(mask, traces::symbol::sequential);
        node_mask_ = mask;
        leaf_mask_ = 0;
        for (std::uint32_t m = mask; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            lane_[l].box.set(rays[l]);
            lane_[l].top = &stack_[l * stride() + 1];
            *lane_[l].top = {0, ChildRef::nothing};
            lane_[l].current = 0;
            lane_[l].height = 0;
            lane_[l].last_symbol = symbol++;
            sheared_[l].set(rays[l]);
            hits[l] = Hit{};
            hits[l].t = rays[l].t_max;
        }
    }

    template <bool any_hit>
    std::uint32_t run(Hit* hits) {
        std::uint32_t occluded_lanes = 0;
        while ((node_mask_ | leaf_mask_) != 0) {
            while (node_mask_ != 0) visit_nodes();
            if (leaf_mask_ != 0) occluded_lanes |= visit_leaves<any_hit>(hits);
        }
        return occluded_lanes;
    }

    /// All bits of `lane_bit` if `condition`, else 0; compiles to no branch.
    static std::uint32_t bit_if(bool condition, std::uint32_t lane_bit) {
        return lane_bit & (0U - static_cast<std::uint32_t>(condition));
    }

    /// Which way a ray goes is what a branch predictor cannot know, so the body of the loop has none but for a lane's
    /// end.
    void visit_nodes() {
        OpenRecord out = recorder_->open(node_mask_, node_region);
        const Bvh2Node* nodes = bvh_->nodes.data();
        std::uint32_t next_nodes = 0, ended = 0;
        for (std::uint32_t m = node_mask_; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            Lane& lane = lane_[l];
            *out.element++ = lane.current;
            const Bvh2Node& node = nodes[lane.current];
            const BoxHits& hit = test_boxes(node, lane.box);
            const std::uint64_t near_far =
                std::rotr(std::bit_cast<std::uint64_t>(node.child), static_cast<int>(hit.near_shift));
            StackEntry* top = lane.top;
            const std::uint32_t pushed = lane.height + 1;
            // Counts only if both are hit.
            top[1] = std::bit_cast<StackEntry>((near_far & ~std::uint64_t{0xffffffff}) | lane.height);
            top += hit.both;
            const auto near = static_cast<std::uint32_t>(near_far);
            const std::uint32_t ref = near ^ ((near ^ top->ref) & hit.none);
            const std::uint32_t height = pushed ^ ((pushed ^ top->height) & hit.none);
            // The child taken; or, if none is, how far to pop.
            *out.symbol++ = static_cast<std::uint8_t>((hit.near_shift >> 5) + (pushed - height));
            lane.top = top - (hit.none & 1U);
            lane.current = ref;
            lane.height = height;
            next_nodes |= (~ref >> 31) << l;
            if (ref == ChildRef::nothing) [[unlikely]] {
                ended |= 1U << l;
                out.symbol[-1] = traces::symbol::end_of_ray;
                lane.last_symbol = recorder_->place(out.symbol - 1);
            }
        }
        recorder_->close(out);
        leaf_mask_ |= node_mask_ & ~next_nodes & ~ended;
        node_mask_ = next_nodes;
    }

    template <bool any_hit>
    std::uint32_t visit_leaves(Hit* hits) {
        std::uint32_t occluded_lanes = 0;
        std::uint32_t waiting = leaf_mask_;
        for (std::uint32_t k = 0; waiting != 0; ++k) {
            std::uint32_t more = 0, holes = 0;
            OpenRecord out = recorder_->open(waiting, triangle_region);
            std::uint32_t symbol = recorder_->place(out.symbol);
            for (std::uint32_t m = waiting; m != 0; m &= m - 1) {
                const auto l = static_cast<unsigned>(std::countr_zero(m));
                const std::uint32_t bit = m & (0U - m);
                const std::uint32_t leaf = lane_[l].current;
                const std::uint32_t index = ChildRef::first(leaf) + k;
                *out.element++ = index;
                *out.symbol++ = traces::symbol::sequential;
                lane_[l].last_symbol = symbol++;
                more |= bit_if(k + 1 < ChildRef::count(leaf), bit);
                const Bvh2Triangle& triangle = bvh_->triangles[index];
                candidate_[l] = hits[l];
                if (!test_triangle(triangle, sheared_[l], candidate_[l])) continue;
                if (triangle.alpha != 0)
                    holes |= bit;
                else
                    occluded_lanes |= accept(l, hits);
            }
            recorder_->close(out);
            if (holes != 0) occluded_lanes |= test_holes(holes, more, hits);
            waiting = any_hit ? more & ~occluded_lanes : more;
        }
        for (std::uint32_t m = leaf_mask_; m != 0; m &= m - 1) {
            Lane& lane = lane_[std::countr_zero(m)];
            const std::uint32_t bit = m & (0U - m);
            const StackEntry popped =
                any_hit && (occluded_lanes & bit) != 0 ? StackEntry{0, ChildRef::nothing} : *lane.top--;
            const bool end = popped.ref == ChildRef::nothing;
            recorder_->set_symbol(lane.last_symbol, end ? traces::symbol::end_of_ray
                                                        : static_cast<std::uint8_t>(lane.height - popped.height - 1));
            lane.current = popped.ref;
            lane.height = popped.height;
            node_mask_ |= bit_if(!ChildRef::is_leaf(lane.current), bit);
            if (lane.current <= ChildRef::nothing) leaf_mask_ &= ~bit;
        }
        return occluded_lanes;
    }

    /// Makes the lane's candidate its hit; returns the lane's bit.
    std::uint32_t accept(unsigned l, Hit* hits) {
        hits[l] = candidate_[l];
        lane_[l].box.set_t_max(hits[l].t);
        return 1U << l;
    }

    /// Candidates on materials that may have holes: reads their texels, accepts those that are solid. `more`: lanes
    /// whose leaf has another triangle.
    std::uint32_t test_holes(std::uint32_t mask, std::uint32_t more, Hit* hits) {
        std::uint32_t elements[lanes];
        std::uint32_t textured = 0, solid = 0;
        for (std::uint32_t m = mask; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            const Hit& hit = candidate_[l];
            const Cutout cutout = cutout_at(*scene_, *texels_, hit.triangle, hit.u, hit.v);
            elements[l] = cutout.element;
            textured |= bit_if(cutout.textured, 1U << l);
            if (cutout.solid) solid |= accept(l, hits);
        }
        if (textured != 0) record_texels(textured, more, elements);
        return solid;
    }

    /// `more`: lanes that will go on to an element no symbol but a literal leads to.
    void record_texels(std::uint32_t mask, std::uint32_t more, const std::uint32_t* elements) {
        OpenRecord out = recorder_->open(mask, texel_region);
        for (; mask != 0; mask &= mask - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(mask));
            std::uint32_t& last = lane_[l].last_symbol;
            recorder_->set_symbol(last, traces::symbol::literal);
            last = recorder_->place(out.symbol);
            *out.element++ = elements[l];
            *out.symbol++ = (more >> l & 1) != 0 ? traces::symbol::literal : traces::symbol::end_of_ray;
        }
        recorder_->close(out);
    }

    const Scene* scene_;
    const Bvh2* bvh_;
    const TexelLayout* texels_;
    Recorder* recorder_;
    std::vector<StackEntry> stack_;
    std::uint32_t node_mask_ = 0, leaf_mask_ = 0;  ///< lanes at inner nodes; lanes that wait at a leaf
    Lane lane_[lanes];
    ShearedRay sheared_[lanes];
    Hit candidate_[lanes];
};

}  // namespace raycache::tracer
