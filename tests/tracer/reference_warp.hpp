// The while-while traversal once more, as plainly as possible: each ray walks alone by recursion, then a scheduler lays
// the lanes' walks side by side by the lock-step rule. Shares the box and the triangle test with the code under test,
// nothing else.
#pragma once

#include <bit>
#include <vector>

#include "test_rays.hpp"
#include "tracer/bvh/ray_box.hpp"
#include "tracer/bvh/ray_triangle.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::tracer::test {

struct Visit {
    std::uint8_t region;
    std::uint32_t element;
    bool last_of_leaf = false;  ///< of a triangle or texel: the lane then leaves the leaf
};

class LoneRay {
public:
    LoneRay(const PreparedScene& scene, const Ray& ray, bool any_hit) : scene_(scene), any_hit_(any_hit) {
        box_.set(ray);
        sheared_.set(ray);
        hit.t = ray.t_max;
        walk(0);
    }
    std::vector<Visit> visits;
    Hit hit;

private:
    void walk(std::uint32_t ref) {
        if (done_) return;
        if (ChildRef::is_leaf(ref)) return walk_leaf(ref);
        visits.push_back({Bvh2::node_region, ref});
        const Bvh2Node& node = bvh2_of(scene_).nodes[ref];
        const BoxHits& boxes = test_boxes(node, box_);
        const bool hit0 = boxes.child(0), hit1 = boxes.child(1);
        const unsigned near = boxes.near_shift / 32;
        if (hit0 && hit1) {
            walk(node.child[near]);
            walk(node.child[1 - near]);
        } else if (hit0 || hit1) {
            walk(node.child[hit0 ? 0 : 1]);
        }
    }
    void walk_leaf(std::uint32_t ref) {
        for (std::uint32_t k = 0; k < ChildRef::count(ref) && !done_; ++k) {
            const std::uint32_t index = ChildRef::first(ref) + k;
            visits.push_back({Bvh2::triangle_region, index});
            Hit candidate = hit;
            const LeafTriangle& triangle = bvh2_of(scene_).triangles[index];
            if (test_triangle(triangle, sheared_, candidate) && solid(candidate)) {
                hit = candidate;
                box_.set_t_max(hit.t);
                done_ = any_hit_;
            }
        }
        visits.back().last_of_leaf = true;
    }
    bool solid(const Hit& candidate) {
        const Scene& scene = scene_.scene();
        const Material& material = scene.materials[scene.material_of[candidate.triangle]];
        if (!material.alpha_mask) return true;
        float alpha = material.alpha;
        if (material.base_color_texture >= 0) {
            const auto texel = scene_.texels().fetch(material.base_color_texture,
                                                     texcoord_at(scene, candidate.triangle, candidate.u, candidate.v));
            visits.push_back({Bvh2::region_count, texel.element});
            alpha *= texel.alpha;
        }
        return alpha >= material.alpha_cutoff;
    }

    const PreparedScene& scene_;
    bool any_hit_, done_ = false;
    BoxRay box_;
    ShearedRay sheared_;
};

/// The records that the lanes' walks make together.
inline traces::WarpTrace lock_step(const std::vector<LoneRay>& lanes, std::uint32_t mask, traces::RayType type,
                                   std::uint8_t bounce) {
    traces::WarpTrace trace;
    trace.records.push_back({mask, traces::ray_start, type, bounce, 0});
    std::vector<std::size_t> at(32, 0);
    const auto standing_at = [&](std::uint32_t among, std::uint8_t region) {
        std::uint32_t found = 0;
        for (unsigned l = 0; l < 32; ++l)
            if (((among >> l) & 1U) != 0 && at[l] < lanes[l].visits.size() && lanes[l].visits[at[l]].region == region)
                found |= 1U << l;
        return found;
    };
    const auto step = [&](std::uint32_t who, std::uint8_t region) {  // returns the lanes that stay in their leaf
        std::uint32_t stay = 0;
        trace.records.push_back({who, region, type, bounce, 0});
        for (unsigned l = 0; l < 32; ++l)
            if (((who >> l) & 1U) != 0) {
                const Visit& visit = lanes[l].visits[at[l]++];
                trace.elements.push_back(visit.element);
                stay |= std::uint32_t{!visit.last_of_leaf} << l;
            }
        return stay;
    };
    for (;;) {
        while (const std::uint32_t at_nodes = standing_at(mask, Bvh2::node_region)) step(at_nodes, Bvh2::node_region);
        std::uint32_t in_leaf = standing_at(mask, Bvh2::triangle_region);
        if (in_leaf == 0) return trace;
        while (in_leaf != 0) {
            std::uint32_t stay = step(in_leaf, Bvh2::triangle_region);
            const std::uint32_t at_texels = standing_at(stay, Bvh2::region_count);
            if (at_texels != 0) stay = (stay & ~at_texels) | step(at_texels, Bvh2::region_count);
            in_leaf = stay;
        }
    }
}

}  // namespace raycache::tracer::test
