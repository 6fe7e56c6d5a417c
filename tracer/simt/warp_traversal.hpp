// 32 rays walk a BVH together, as the lanes of a warp do: "while-while" of Aila & Laine 2009. The warp repeats
//   1. while a lane stands at a node: all such lanes visit their node and step; lanes that arrive at triangles wait;
//   2. while a waiting lane has an untested triangle: all such lanes test their next one; then they step.
// What a visit reads and where a step leads is the layout's (tracer/bvh/layouts/layout.hpp).
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/bvh/ray_triangle.hpp"
#include "tracer/paths/traversal.hpp"
#include "tracer/ray.hpp"
#include "tracer/scene/cutout.hpp"
#include "tracer/simt/recorder.hpp"

namespace raycache::tracer {

/// `Recorder` is WarpRecorder to write a trace, NullRecorder to walk alone, HoleRecorder to hear of holes.
template <WalkableBvh Tree, class Recorder>
class WarpTraversal final : public Traversal {
public:
    static constexpr unsigned lanes = traces::warp_lanes;
    /// Of textures: behind those of the layout.
    static constexpr std::uint8_t texel_region = Tree::region_count;

    /// `own_regions`: index of the first region of the integrator's own.
    WarpTraversal(const Scene& scene, const Tree& tree, const TexelLayout& texels, Recorder& recorder,
                  std::uint8_t own_regions = 0)
        : own_regions_(own_regions),
          scene_(&scene),
          tree_(&tree),
          texels_(&texels),
          recorder_(&recorder),
          stack_(std::size_t{lanes} * tree.stack_entries()) {}

    void closest(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays, Hit* hits) override {
        begin(mask, type, bounce, rays, hits);
        run<false>(hits);
    }

    /// A lane stops at its first hit.
    std::uint32_t occluded(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays) override {
        Hit hits[lanes];
        begin(mask, type, bounce, rays, hits);
        return run<true>(hits);
    }

    void read_texels(std::uint32_t mask, traces::RayType type, std::uint8_t bounce,
                     const std::uint32_t* elements) override {
        recorder_->kind(type, bounce);
        record(mask, texel_region, 0, elements);
    }

    void start(std::uint32_t mask, traces::RayType type, std::uint8_t bounce) override {
        recorder_->kind(type, bounce);
        std::uint32_t symbol = recorder_->start_rays(mask, traces::symbol::end_of_ray);
        for (; mask != 0; mask &= mask - 1) lane_[std::countr_zero(mask)].last_symbol = symbol++;
    }

    void read_region(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, std::uint8_t region,
                     const std::uint32_t* elements) override {
        recorder_->kind(type, bounce);
        record(mask, static_cast<std::uint8_t>(own_regions_ + region), 0, elements);
    }

private:
    /// One lane's place in the tree. The hot loop touches little else.
    struct alignas(64) Lane : Tree::Lane {
        std::uint32_t last_symbol = 0;  ///< its place; set wherever the lane may end
    };

    void begin(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays, Hit* hits) {
        recorder_->kind(type, bounce);
        std::uint32_t symbol = recorder_->start_rays(mask, traces::symbol::sequential);
        node_mask_ = mask;
        leaf_mask_ = 0;
        for (std::uint32_t m = mask; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            lane_[l].start(rays[l], &stack_[l * tree_->stack_entries()]);
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

    /// The accesses of a visit behind its first, to the same elements.
    template <std::size_t n>
    void read_more(std::uint32_t mask, const std::array<std::uint8_t, n>& regions) {
        for (std::size_t i = 1; i < n; ++i) recorder_->repeat(mask, regions[i]);
    }

    /// Which way a ray goes is what a branch predictor cannot know, so the body of the loop has none but for a lane's
    /// end.
    void visit_nodes() {
        OpenRecord out = recorder_->open(node_mask_, Tree::node_reads[0]);
        const typename Tree::View view = tree_->view();
        std::uint32_t next_nodes = 0, ended = 0;
        for (std::uint32_t m = node_mask_; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            Lane& lane = lane_[l];
            *out.element++ = lane.node();
            const LaneStep step = lane.visit_node(view);
            *out.symbol++ = static_cast<std::uint8_t>(step.symbol);
            next_nodes |= step.at_node << l;
            if (step.ended) [[unlikely]] {
                ended |= 1U << l;
                out.symbol[-1] = traces::symbol::end_of_ray;
                lane.last_symbol = recorder_->place(out.symbol - 1);
            }
        }
        recorder_->close(out);
        read_more(node_mask_, Tree::node_reads);
        leaf_mask_ |= node_mask_ & ~next_nodes & ~ended;
        node_mask_ = next_nodes;
    }

    template <bool any_hit>
    std::uint32_t visit_leaves(Hit* hits) {
        std::uint32_t occluded_lanes = 0;
        std::uint32_t waiting = leaf_mask_;
        while (waiting != 0) {
            std::uint32_t more = 0, holes = 0;
            OpenRecord out = recorder_->open(waiting, Tree::triangle_reads[0]);
            std::uint32_t symbol = recorder_->place(out.symbol);
            const typename Tree::View view = tree_->view();
            for (std::uint32_t m = waiting; m != 0; m &= m - 1) {
                const auto l = static_cast<unsigned>(std::countr_zero(m));
                const std::uint32_t bit = m & (0U - m);
                const std::uint32_t index = lane_[l].take_triangle();
                *out.element++ = index;
                *out.symbol++ = traces::symbol::sequential;
                lane_[l].last_symbol = symbol++;
                more |= bit_if(lane_[l].more_triangles(), bit);
                const auto& triangle = view.triangle(index);
                candidate_[l] = hits[l];
                if (!test_triangle(triangle, sheared_[l], candidate_[l])) continue;
                if (triangle.alpha != 0)
                    holes |= bit;
                else
                    occluded_lanes |= accept(l, hits);
            }
            recorder_->close(out);
            read_more(waiting, Tree::triangle_reads);
            if (holes != 0) occluded_lanes |= test_holes(holes, more, hits);
            waiting = any_hit ? more & ~occluded_lanes : more;
        }
        for (std::uint32_t m = leaf_mask_; m != 0; m &= m - 1) {
            Lane& lane = lane_[std::countr_zero(m)];
            const std::uint32_t bit = m & (0U - m);
            const LaneStep step = any_hit && (occluded_lanes & bit) != 0 ? lane.end() : lane.leave_triangles();
            recorder_->set_symbol(lane.last_symbol,
                                  step.ended ? traces::symbol::end_of_ray : static_cast<std::uint8_t>(step.symbol));
            node_mask_ |= bit_if(step.at_node != 0, bit);
            if (step.at_node != 0 || step.ended) leaf_mask_ &= ~bit;
        }
        return occluded_lanes;
    }

    /// Makes the lane's candidate its hit; returns the lane's bit.
    std::uint32_t accept(unsigned l, Hit* hits) {
        hits[l] = candidate_[l];
        lane_[l].shorten(hits[l].t);
        return 1U << l;
    }

    /// Candidates on materials that may have holes: reads their texels, accepts those that are solid. `more`: lanes
    /// that have another triangle to test.
    std::uint32_t test_holes(std::uint32_t mask, std::uint32_t more, Hit* hits) {
        std::uint32_t elements[lanes];
        std::uint32_t textured = 0, solid = 0;
        for (std::uint32_t m = mask; m != 0; m &= m - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(m));
            const Hit& hit = candidate_[l];
            const Cutout cutout = cutout_at(*scene_, *texels_, hit.triangle, hit.u, hit.v);
            elements[l] = cutout.element;
            textured |= bit_if(cutout.textured, 1U << l);
            if (cutout.solid)
                solid |= accept(l, hits);
            else if constexpr (requires { recorder_->passed(l, hit.triangle); })
                recorder_->passed(l, hit.triangle);
        }
        if (textured != 0) record(textured, texel_region, more, elements);
        return solid;
    }

    /// `more`: lanes that will go on to an element no symbol but a literal leads to.
    void record(std::uint32_t mask, std::uint8_t region, std::uint32_t more, const std::uint32_t* elements) {
        OpenRecord out = recorder_->open(mask, region);
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

    std::uint8_t own_regions_;
    const Scene* scene_;
    const Tree* tree_;
    const TexelLayout* texels_;
    Recorder* recorder_;
    std::vector<typename Tree::Lane::StackEntry> stack_;
    std::uint32_t node_mask_ = 0, leaf_mask_ = 0;  ///< lanes at nodes; lanes that wait at triangles
    Lane lane_[lanes];
    ShearedRay sheared_[lanes];
    Hit candidate_[lanes];
};

}  // namespace raycache::tracer
