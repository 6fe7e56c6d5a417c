// Ray against the two boxes of a bvh2 node: the slab test of Kay & Kajiya with the margin of T. Ize, "Robust BVH Ray
// Traversal", JCGT 2013, so that rounding never loses a box the exact ray enters.
//
// One SSE register per axis holds {near 0, near 1, far 0, far 1} after a shuffle by the sign of the direction. Far
// distances are kept negated, so that one max serves both ends. A NaN (origin on a plane, direction 0 along that axis)
// stands in the first operand of max and is thereby ignored: the ray counts as inside that slab.
#pragma once

#include <immintrin.h>

#include <cmath>
#include <cstdint>

#include "tracer/bvh/layouts/bvh2.hpp"
#include "tracer/ray.hpp"

namespace raycache::tracer {

/// 1 + 2 ulp: covers the three roundings of (plane - origin) * (1 / direction) on either side.
inline constexpr float box_margin = 1.00000024F;

/// A ray prepared for box tests.
struct BoxRay {
    __m128 origin[3];
    __m128 inverse[3];   ///< {i, i, -i, -i}, i = 1 / direction
    __m128i shuffle[3];  ///< {lower 0, lower 1, upper 0, upper 1} -> {near 0, near 1, far 0, far 1}
    __m128 limits;       ///< {t_min, t_min, -t_max, -t_max}

    void set(const Ray& ray) {
        for (int axis = 0; axis < 3; ++axis) {
            const float i = 1.0F / ray.direction[axis];
            origin[axis] = _mm_set1_ps(ray.origin[axis]);
            inverse[axis] = _mm_setr_ps(i, i, -i, -i);
            shuffle[axis] = std::signbit(i) ? _mm_setr_epi8(8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7)
                                            : _mm_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
        }
        limits = _mm_setr_ps(ray.t_min, ray.t_min, -ray.t_max, -ray.t_max);
    }
    void set_t_max(float t) { limits = _mm_setr_ps(_mm_cvtss_f32(limits), _mm_cvtss_f32(limits), -t, -t); }
};

struct BoxHits {
    std::uint32_t mask;  ///< bit c: child c is hit
    std::uint32_t near;  ///< which child is entered first; child 0 on a tie
};

inline BoxHits test_boxes(const Bvh2Node& node, const BoxRay& ray) {
    const auto slab = [&](const float* planes, int axis) {
        const __m128 p = _mm_castsi128_ps(
            _mm_shuffle_epi8(_mm_load_si128(reinterpret_cast<const __m128i*>(planes)), ray.shuffle[axis]));
        return _mm_mul_ps(_mm_sub_ps(p, ray.origin[axis]), ray.inverse[axis]);
    };
    __m128 t = _mm_max_ps(slab(node.x, 0), ray.limits);
    t = _mm_max_ps(slab(node.y, 1), t);
    t = _mm_max_ps(slab(node.z, 2), t);
    t = _mm_mul_ps(t, _mm_setr_ps(1.0F, 1.0F, box_margin, box_margin));
    const __m128 far = _mm_xor_ps(_mm_movehl_ps(t, t), _mm_set1_ps(-0.0F));
    const auto mask = static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmple_ps(t, far))) & 3U;
    const auto second_nearer =
        static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmplt_ss(_mm_shuffle_ps(t, t, 1), t)));
    return {mask, (mask >> 1) & ((mask ^ 1U) | second_nearer) & 1U};
}

}  // namespace raycache::tracer
