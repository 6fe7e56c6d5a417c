// Watertight ray–triangle intersection: S. Woop, C. Benthin, I. Wald, JCGT 2013. Shear the triangle so that the ray
// runs along one axis, then decide by the signs of three 2-D edge functions; where one is exactly zero, decide in
// double. Vectors hold one number per vertex: each is computed in the order of the formula, so that the result does not
// depend on them. Two triangles that share an edge compute the same number for it, so no ray slips between them.
// Distances that are small for the triangle are computed again, in double (near_plane.hpp).
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "tracer/bvh/layouts/leaf_triangle.hpp"
#include "tracer/bvh/near_plane.hpp"
#include "tracer/ray.hpp"

namespace raycache::tracer {

/// A ray prepared for triangle tests: axes renamed so that z is the one along which the direction is largest.
struct ShearedRay {
    float x, y, z;     ///< origin
    float sx, sy, sz;  ///< shear constants
    float t_min;
    std::uint8_t row_x, row_y, row_z;  ///< where LeafTriangle has these axes, in bytes

    void set(const Ray& ray) {
        const Vec3 size{std::fabs(ray.direction.x), std::fabs(ray.direction.y), std::fabs(ray.direction.z)};
        const int kz = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        int kx = (kz + 1) % 3;
        int ky = (kx + 1) % 3;
        if (ray.direction[kz] < 0) std::swap(kx, ky);
        x = ray.origin[kx];
        y = ray.origin[ky];
        z = ray.origin[kz];
        sz = 1.0F / ray.direction[kz];
        sx = ray.direction[kx] * sz;
        sy = ray.direction[ky] * sz;
        t_min = ray.t_min;
        row_x = static_cast<std::uint8_t>(16 * kx);
        row_y = static_cast<std::uint8_t>(16 * ky);
        row_z = static_cast<std::uint8_t>(16 * kz);
    }
};

/// To the plane of the triangle, computed in double.
inline float exact_distance(const LeafTriangle& triangle, const ShearedRay& ray) {
    const auto row = [&](std::uint8_t at) {
        return reinterpret_cast<const float*>(reinterpret_cast<const char*>(&triangle) + at);
    };
    const float* const x = row(ray.row_x);
    const float* const y = row(ray.row_y);
    const float* const z = row(ray.row_z);
    const auto vertex = [&](int i) { return Vec3d(x[i], y[i], z[i]); };
    return static_cast<float>(plane_distance(vertex(0), vertex(1), vertex(2), {ray.x, ray.y, ray.z},
                                             Vec3d(ray.sx, ray.sy, 1) * (1 / double{ray.sz})));
}

/// Writes t, u, v and returns true if the ray meets the triangle at t in (t_min, best], where `best` is `hit` as it
/// was: equal distances go to the lower triangle index, whatever the order of the visits. Leaves `hit` alone otherwise.
/// Both sides count.
inline bool test_triangle(const LeafTriangle& triangle, const ShearedRay& ray, Hit& hit) {
    const auto row = [&](std::uint8_t at) {
        return _mm_load_ps(reinterpret_cast<const float*>(reinterpret_cast<const char*>(&triangle) + at));
    };
    const auto all = [](float v) { return _mm_set1_ps(v); };
    // {of vertex a, of b, of c, anything}
    const __m128 z = _mm_sub_ps(row(ray.row_z), all(ray.z));
    const __m128 x = _mm_sub_ps(_mm_sub_ps(row(ray.row_x), all(ray.x)), _mm_mul_ps(all(ray.sx), z));
    const __m128 y = _mm_sub_ps(_mm_sub_ps(row(ray.row_y), all(ray.y)), _mm_mul_ps(all(ray.sy), z));
    const auto before = [](__m128 v) { return _mm_shuffle_ps(v, v, _MM_SHUFFLE(2, 1, 0, 2)); };  // c, a, b
    const auto behind = [](__m128 v) { return _mm_shuffle_ps(v, v, _MM_SHUFFLE(0, 0, 2, 1)); };  // b, c, a
    // Weights of a, b, c.
    __m128 e = _mm_sub_ps(_mm_mul_ps(before(x), behind(y)), _mm_mul_ps(before(y), behind(x)));
    const int negative = _mm_movemask_ps(e) & 7;
    const int zero = _mm_movemask_ps(_mm_cmpeq_ps(e, _mm_setzero_ps())) & 7;
    // NaN goes either way and fails below.
    if (zero == 0 && negative != 0 && negative != 7) return false;
    if (zero != 0) [[unlikely]] {
        alignas(16) float ax[4], ay[4];
        _mm_store_ps(ax, x);
        _mm_store_ps(ay, y);
        const auto exact = [&](int p, int q) {
            return static_cast<float>(double{ax[p]} * double{ay[q]} - double{ay[p]} * double{ax[q]});
        };
        const float e0 = exact(2, 1), e1 = exact(0, 2), e2 = exact(1, 0);
        if ((e0 < 0 || e1 < 0 || e2 < 0) && (e0 > 0 || e1 > 0 || e2 > 0)) return false;
        e = _mm_setr_ps(e0, e1, e2, 0);
    }
    alignas(16) float w[4], wz[4];
    _mm_store_ps(w, e);
    _mm_store_ps(wz, _mm_mul_ps(e, _mm_mul_ps(all(ray.sz), z)));
    const float determinant = w[0] + w[1] + w[2];
    if (determinant == 0) return false;
    float t = (wz[0] + wz[1] + wz[2]) / determinant;
    if (!(t > ray.t_min && t <= hit.t)) return false;
    alignas(16) float depth[4];
    _mm_store_ps(depth, z);
    const float reach = std::max({std::fabs(depth[0]), std::fabs(depth[1]), std::fabs(depth[2])});
    if (t < near_share * reach * std::fabs(ray.sz)) [[unlikely]] {
        t = exact_distance(triangle, ray);
        if (!(t > ray.t_min && t <= hit.t)) return false;
    }
    if (t == hit.t && triangle.triangle >= hit.triangle) return false;
    hit = {t, w[1] / determinant, w[2] / determinant, triangle.triangle};
    return true;
}

}  // namespace raycache::tracer
