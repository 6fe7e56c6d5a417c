// Ray against two boxes at once: the slab test of Kay & Kajiya with the margin of T. Ize, "Robust BVH Ray
// Traversal", JCGT 2013, made larger, so that rounding never loses a box the exact ray enters.
//
// One SSE register per axis holds {near 0, near 1, far 0, far 1} after a shuffle by the sign of the direction. Far
// distances are kept negated, so that one max serves both ends. A NaN (origin on a plane, direction 0 along that axis)
// stands in the first operand of max and is thereby ignored: the ray counts as inside that slab.
#pragma once

#include <immintrin.h>

#include <cmath>
#include <cstdint>

#include "tracer/ray.hpp"

namespace raycache::tracer {

/// 1 + 4 ulp: (plane - origin) * (1 / direction) is rounded three times, by half an ulp each, on the near and on the
/// far side; then this product is. Ize's 2 ulp lose a box now and then: tests/tracer/ray_box.cpp has three.
inline constexpr float box_margin = 1.00000048F;

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

/// What follows for the traversal, looked up rather than computed: the hot loop is bound by its instructions.
struct BoxHits {
    std::uint32_t near_shift;  ///< 32 * (which child is entered first); 0 on a tie
    std::uint32_t both;        ///< 1 if both children are hit
    std::uint32_t none;        ///< all bits if no child is hit

    bool child(unsigned c) const { return both != 0 || (none == 0 && near_shift == 32 * c); }
};

/// Index: bit 0: child 0 is hit, bit 1: child 1 is hit, bit 2: child 0 is entered no later than child 1.
inline constexpr BoxHits box_hits[8] = {{0, 0, ~0U}, {0, 0, 0}, {32, 0, 0}, {32, 1, 0},
                                        {0, 0, ~0U}, {0, 0, 0}, {32, 0, 0}, {0, 1, 0}};

/// `Boxes` has arrays x, y, z of four floats, aligned to 16 bytes: per axis lower plane of box 0, of box 1, upper plane
/// of box 0, of box 1.
template <class Boxes>
const BoxHits& test_boxes(const Boxes& boxes, const BoxRay& ray) {
    const auto slab = [&](const float* planes, int axis) {
        const __m128 p = _mm_castsi128_ps(
            _mm_shuffle_epi8(_mm_load_si128(reinterpret_cast<const __m128i*>(planes)), ray.shuffle[axis]));
        return _mm_mul_ps(_mm_sub_ps(p, ray.origin[axis]), ray.inverse[axis]);
    };
    __m128 t = _mm_max_ps(slab(boxes.x, 0), ray.limits);
    t = _mm_max_ps(slab(boxes.y, 1), t);
    t = _mm_max_ps(slab(boxes.z, 2), t);
    // {near 0, near 1, far 0, far 1}
    t = _mm_mul_ps(t, _mm_setr_ps(1.0F, 1.0F, -box_margin, -box_margin));
    const __m128 left = _mm_shuffle_ps(t, t, _MM_SHUFFLE(0, 0, 1, 0));
    const __m128 right = _mm_shuffle_ps(t, t, _MM_SHUFFLE(1, 1, 3, 2));
    return box_hits[_mm_movemask_ps(_mm_cmple_ps(left, right)) & 7];
}

}  // namespace raycache::tracer
