// Ray against four boxes at once, for nodes of more than two children: the slab test of ray_box.hpp, with its margin.
#pragma once

#include <immintrin.h>

#include <cmath>

#include "tracer/bvh/ray_box.hpp"
#include "tracer/ray.hpp"

namespace raycache::tracer {

/// A ray prepared for it.
struct WideBoxRay {
    __m128 origin[3], inverse[3];  ///< in all four places
    __m128 t_min, t_max;
    bool negative[3];  ///< direction: the upper plane comes first

    void set(const Ray& ray) {
        for (int axis = 0; axis < 3; ++axis) {
            const float i = 1.0F / ray.direction[axis];
            origin[axis] = _mm_set1_ps(ray.origin[axis]);
            inverse[axis] = _mm_set1_ps(i);
            negative[axis] = std::signbit(i);
        }
        t_min = _mm_set1_ps(ray.t_min);
        set_t_max(ray.t_max);
    }
    void set_t_max(float t) { t_max = _mm_set1_ps(t); }
};

/// Boxes hit, a bit each; writes where they are entered. A NaN stands in the first operand of min and max and is
/// thereby ignored.
inline unsigned test_four_boxes(const __m128 (&lower)[3], const __m128 (&upper)[3], const WideBoxRay& ray,
                                __m128& entry) {
    __m128 near = ray.t_min, far = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const auto t = [&](__m128 planes) {
            return _mm_mul_ps(_mm_sub_ps(planes, ray.origin[axis]), ray.inverse[axis]);
        };
        near = _mm_max_ps(t(ray.negative[axis] ? upper[axis] : lower[axis]), near);
        far = _mm_min_ps(t(ray.negative[axis] ? lower[axis] : upper[axis]), far);
    }
    entry = near;
    return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(near, _mm_mul_ps(far, _mm_set1_ps(box_margin)))));
}

}  // namespace raycache::tracer
