// Lays the warp traversal's answers beside Embree's robust ones and has the judge look at every difference.
#pragma once

#include <cmath>
#include <string>

#include "exact_judge.hpp"
#include "test_rays.hpp"
#include "tracer/bvh/embree_scene.hpp"

namespace raycache::tracer::test {

struct Comparison {
    std::uint64_t rays = 0;
    std::uint64_t ties = 0;          ///< another triangle at the same distance, within 4 ulp or the error bounds
    std::uint64_t depths = 0;        ///< the same triangle, t more than 4 ulp apart, each justified within rounding
    std::uint64_t excused = 0;       ///< another triangle or a miss: an edge, t_min or t_max is within the error bounds
    std::uint64_t ours_wrong = 0;    ///< ours is not justified
    std::uint64_t embree_wrong = 0;  ///< ours is, Embree's is not
    std::string first_wrong;         ///< in words

    void operator+=(const Comparison& other) {
        rays += other.rays;
        ties += other.ties;
        depths += other.depths;
        excused += other.excused;
        ours_wrong += other.ours_wrong;
        embree_wrong += other.embree_wrong;
        if (first_wrong.empty()) first_wrong = other.first_wrong;
    }
    std::string text() const {
        return std::to_string(rays) + " rays, " + std::to_string(ties) + " ties, " + std::to_string(depths) +
               " depths, " + std::to_string(excused) + " excused, " + std::to_string(ours_wrong) + " ours wrong, " +
               std::to_string(embree_wrong) + " Embree wrong " + first_wrong;
    }
};

inline std::string describe(const Ray& r, const Hit& ours, const Hit& embree) {
    char text[512];
    std::snprintf(text, sizeof text, "o %a %a %a d %a %a %a t %g..%g ours %d t=%.9g embree %d t=%.9g",
                  double{r.origin.x}, double{r.origin.y}, double{r.origin.z}, double{r.direction.x},
                  double{r.direction.y}, double{r.direction.z}, double{r.t_min}, double{r.t_max},
                  static_cast<int>(ours.triangle), double{ours.t}, static_cast<int>(embree.triangle), double{embree.t});
    return text;
}

/// `judge`: the same scene in layout bvh2, which the judge looks for candidates in.
inline Comparison compare_closest(const PreparedScene& scene, const EmbreeScene& embree, std::span<const Ray> rays,
                                  const PreparedScene& judge) {
    const std::vector<Hit> ours = closest_hits(scene, rays);
    Comparison out;
    out.rays = rays.size();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Hit theirs = embree.intersect(rays[i]);
        if (!ours[i].found() && !theirs.found()) continue;
        const bool same_distance =
            ours[i].found() && theirs.found() && std::fabs(ours[i].t - theirs.t) <= 4 * 0x1p-23F * std::fabs(theirs.t);
        if (same_distance) {
            out.ties += ours[i].triangle != theirs.triangle;
            continue;
        }
        // Both on one triangle: only t is in question.
        const auto candidates = ours[i].triangle == theirs.triangle
                                    ? std::vector{ExactRay(rays[i]).crossing(scene.scene(), theirs.triangle)}
                                    : crossings(judge, rays[i]);
        const bool right = justified(candidates, rays[i], ours[i]), other = justified(candidates, rays[i], theirs);
        out.ours_wrong += !right;
        out.embree_wrong += right && !other;
        const auto inside = [&](const Hit& hit) {
            return hit.found() && std::any_of(candidates.begin(), candidates.end(), [&](const Crossing& c) {
                       return c.triangle == hit.triangle && c.sure();
                   });
        };
        if (right && other)
            ++(ours[i].triangle == theirs.triangle ? out.depths
               : inside(ours[i]) && inside(theirs) ? out.ties
                                                   : out.excused);
        if (!(right && other) && out.first_wrong.empty()) out.first_wrong = describe(rays[i], ours[i], theirs);
    }
    return out;
}

inline Comparison compare_closest(const PreparedScene& scene, const EmbreeScene& embree, std::span<const Ray> rays) {
    return compare_closest(scene, embree, rays, scene);
}

inline Comparison compare_any(const PreparedScene& scene, const EmbreeScene& embree, std::span<const Ray> rays,
                              const PreparedScene& judge) {
    const std::vector<bool> ours = any_hits(scene, rays);
    Comparison out;
    out.rays = rays.size();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool theirs = embree.occluded(rays[i]);
        if (ours[i] == theirs) continue;
        const auto candidates = crossings(judge, rays[i]);
        const bool right = justified(candidates, rays[i], bool{ours[i]}),
                   other = justified(candidates, rays[i], theirs);
        out.ours_wrong += !right;
        out.embree_wrong += right && !other;
        out.excused += right && other;
        if (!(right && other) && out.first_wrong.empty())
            out.first_wrong = (ours[i] ? "occluded " : "free ") + describe(rays[i], {}, embree.intersect(rays[i]));
    }
    return out;
}

inline Comparison compare_any(const PreparedScene& scene, const EmbreeScene& embree, std::span<const Ray> rays) {
    return compare_any(scene, embree, rays, scene);
}

}  // namespace raycache::tracer::test
