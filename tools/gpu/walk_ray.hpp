// A ray and its tests against boxes and triangles, as tracer/bvh/ray_box.hpp, ray_boxes4.hpp and ray_triangle.hpp have
// them: the same numbers in the same order, one ray at a time. Where the compiler contracts no multiplication and
// addition (nvcc -fmad=false), every result is bit for bit the tracer's.
#pragma once

#include "tools/gpu/device_code.hpp"

namespace raycache::gpu {

/// As a package has it: two loads of 16 bytes.
struct alignas(16) PackedRay {
    float origin[3], t_min;
    float direction[3], t_max;
};
static_assert(sizeof(PackedRay) == 32, "two loads");

inline constexpr std::uint32_t no_triangle = 0xffffffffU;

/// Where a ray ends. Of a shadow ray: t is 0 where anything is in the way, else infinite, and there is no triangle.
struct Hit {
    float t;
    std::uint32_t triangle;  ///< of the scene
};

/// 1 + 4 ulp, as in tracer/bvh/ray_box.hpp.
inline constexpr float box_margin = 1.00000048F;
/// As in tracer/bvh/near_plane.hpp.
inline constexpr float near_share = 0x1p-8F;

RAYCACHE_BOTH PackedRay load_ray(const PackedRay* from) {
    const Words a = load16(from), b = load16(reinterpret_cast<const char*>(from) + 16);
    return {{as_float(a.x), as_float(a.y), as_float(a.z)},
            as_float(a.w),
            {as_float(b.x), as_float(b.y), as_float(b.z)},
            as_float(b.w)};
}

/// Prepared for boxes.
struct BoxRay {
    float origin[3], inverse[3];  ///< 1 / direction
    bool negative[3];             ///< sign of it: the upper plane comes first
    float t_min, t_max;

    RAYCACHE_BOTH void set(const PackedRay& ray) {
        for (int axis = 0; axis < 3; ++axis) {
            origin[axis] = ray.origin[axis];
            inverse[axis] = 1.0F / ray.direction[axis];
            negative[axis] = as_bits(inverse[axis]) >> 31 != 0;
        }
        t_min = ray.t_min;
        t_max = ray.t_max;
    }
    /// Narrows [entry, exit] to the slab between two planes.
    RAYCACHE_BOTH void clip(int axis, float lower, float upper, float& entry, float& exit) const {
        const float near = negative[axis] ? upper : lower, far = negative[axis] ? lower : upper;
        entry = larger((near - origin[axis]) * inverse[axis], entry);
        exit = smaller((far - origin[axis]) * inverse[axis], exit);
    }
    RAYCACHE_BOTH static bool meets(float entry, float exit) { return entry <= exit * box_margin; }
};

/// Prepared for triangles: axes renamed so that the direction is largest along z (Woop, Benthin & Wald 2013).
struct ShearedRay {
    float x, y, z, sx, sy, sz, t_min;
    int kx, ky, kz;

    RAYCACHE_BOTH static float of(const float (&v)[3], int k) { return k == 0 ? v[0] : k == 1 ? v[1] : v[2]; }
    RAYCACHE_BOTH void set(const PackedRay& ray) {
        const float dx = size_of(ray.direction[0]), dy = size_of(ray.direction[1]), dz = size_of(ray.direction[2]);
        kz = dx > dy ? (dx > dz ? 0 : 2) : (dy > dz ? 1 : 2);
        kx = kz == 2 ? 0 : kz + 1;
        ky = kx == 2 ? 0 : kx + 1;
        if (of(ray.direction, kz) < 0) {
            const int k = kx;
            kx = ky;
            ky = k;
        }
        x = of(ray.origin, kx);
        y = of(ray.origin, ky);
        z = of(ray.origin, kz);
        sz = 1.0F / of(ray.direction, kz);
        sx = of(ray.direction, kx) * sz;
        sy = of(ray.direction, ky) * sz;
        t_min = ray.t_min;
    }
};

/// A triangle of 48 bytes, three loads: x of its vertices and its number in the scene; y, and whether it may have
/// holes; z.
struct Triangle {
    float rows[3][3];
    std::uint32_t number;
    bool holes;
};

RAYCACHE_BOTH Triangle load_triangle(const void* triangles, std::uint32_t element) {
    const char* const at = static_cast<const char*>(triangles) + std::size_t{element} * 48;
    const Words x = load16(at), y = load16(at + 16), z = load16(at + 32);
    return {{{as_float(x.x), as_float(x.y), as_float(x.z)},
             {as_float(y.x), as_float(y.y), as_float(y.z)},
             {as_float(z.x), as_float(z.y), as_float(z.z)}},
            x.w,
            y.w != 0};
}

/// Of the triangle's vertices, along the axis k.
RAYCACHE_BOTH float vertex(const Triangle& t, int k, int i) {
    return k == 0 ? t.rows[0][i] : k == 1 ? t.rows[1][i] : t.rows[2][i];
}

/// Along the ray to the triangle's plane, in double; NaN where it has none.
RAYCACHE_BOTH float exact_distance(const Triangle& t, const ShearedRay& r) {
    double a[3], ab[3], ac[3];
    const int axes[3] = {r.kx, r.ky, r.kz};
    for (int i = 0; i < 3; ++i) {
        a[i] = vertex(t, axes[i], 0);
        ab[i] = double{vertex(t, axes[i], 1)} - a[i];
        ac[i] = double{vertex(t, axes[i], 2)} - a[i];
    }
    const double normal[3] = {ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2],
                              ab[0] * ac[1] - ab[1] * ac[0]};
    const double scale = 1 / double{r.sz};
    const double direction[3] = {double{r.sx} * scale, double{r.sy} * scale, 1 * scale};
    const double start[3] = {a[0] - double{r.x}, a[1] - double{r.y}, a[2] - double{r.z}};
    const double above = normal[0] * start[0] + normal[1] * start[1] + normal[2] * start[2];
    const double along = normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2];
    return static_cast<float>(above / along);
}

/// True if the ray meets the triangle at t in (t_min, best.t]; of equal distances the lower triangle is the hit. Writes
/// `met` then, and nothing else.
RAYCACHE_BOTH bool test_triangle(const Triangle& tri, const ShearedRay& r, const Hit& best, Hit& met) {
    float x[3], y[3], z[3];
    for (int i = 0; i < 3; ++i) {
        z[i] = vertex(tri, r.kz, i) - r.z;
        x[i] = vertex(tri, r.kx, i) - r.x - r.sx * z[i];
        y[i] = vertex(tri, r.ky, i) - r.y - r.sy * z[i];
    }
    float e[3] = {x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]};
    if (e[0] == 0 || e[1] == 0 || e[2] == 0) {
        e[0] = static_cast<float>(double{x[2]} * double{y[1]} - double{y[2]} * double{x[1]});
        e[1] = static_cast<float>(double{x[0]} * double{y[2]} - double{y[0]} * double{x[2]});
        e[2] = static_cast<float>(double{x[1]} * double{y[0]} - double{y[1]} * double{x[0]});
        if ((e[0] < 0 || e[1] < 0 || e[2] < 0) && (e[0] > 0 || e[1] > 0 || e[2] > 0)) return false;
    } else {
        const std::uint32_t negative = (as_bits(e[0]) >> 31) + (as_bits(e[1]) >> 31) + (as_bits(e[2]) >> 31);
        if (negative != 0 && negative != 3) return false;
    }
    const float determinant = e[0] + e[1] + e[2];
    if (determinant == 0) return false;
    float t = (e[0] * (r.sz * z[0]) + e[1] * (r.sz * z[1]) + e[2] * (r.sz * z[2])) / determinant;
    if (!(t > r.t_min && t <= best.t)) return false;
    const float reach = larger(larger(size_of(z[0]), size_of(z[1])), size_of(z[2]));
    if (t < near_share * reach * size_of(r.sz)) {
        t = exact_distance(tri, r);
        if (!(t > r.t_min && t <= best.t)) return false;
    }
    if (t == best.t && tri.number >= best.triangle) return false;
    met = {t, tri.number};
    return true;
}

}  // namespace raycache::gpu
