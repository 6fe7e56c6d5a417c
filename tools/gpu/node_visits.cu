// What a visit to a node costs a GPU: one kernel for each BVH layout, which makes VISITS visits one after the other.
// Nothing here is run; tools/gpu/visit_instructions compiles each kernel with different VISITS and compares how long
// the machine code is. A visit does what the layout's lane does (tracer/bvh/layouts/): it loads the node, tests the
// boxes against the ray, and works out where to go and what to push, without a branch, as compilers make it of such
// code. Loads are counted by the front end of the model and left out of the figures.
#include <cstdint>

struct Ray {
    float ox, oy, oz, ix, iy, iz, t_min, t_max;  // origin, 1 / direction
};

struct Lane {
    Ray ray;
    std::uint32_t current, top, group, bits;
};

__device__ inline void push(std::uint32_t* stack, Lane& lane, std::uint32_t ref, bool wanted) {
    if (wanted) stack[lane.top] = ref;
    lane.top += wanted ? 1 : 0;
}

/// Slab test; planes a and b of each axis.
__device__ inline bool slab(const Ray& r, float ax, float bx, float ay, float by, float az, float bz, float& entry) {
    const float x0 = fmaf(ax, r.ix, -r.ox), x1 = fmaf(bx, r.ix, -r.ox), y0 = fmaf(ay, r.iy, -r.oy),
                y1 = fmaf(by, r.iy, -r.oy), z0 = fmaf(az, r.iz, -r.oz), z1 = fmaf(bz, r.iz, -r.oz);
    entry = fmaxf(fmaxf(fminf(x0, x1), fminf(y0, y1)), fmaxf(fminf(z0, z1), r.t_min));
    const float exit = fminf(fminf(fmaxf(x0, x1), fmaxf(y0, y1)), fminf(fmaxf(z0, z1), r.t_max));
    return entry <= exit;
}

/// The same of planes known to be near and far, without their minimum and maximum; origin negated.
__device__ inline bool ordered_slab(const Ray& r, float nx, float fx, float ny, float fy, float nz, float fz) {
    const float entry = fmaxf(fmaxf(fmaf(nx, r.ix, r.ox), fmaf(ny, r.iy, r.oy)), fmaxf(fmaf(nz, r.iz, r.oz), r.t_min));
    const float exit = fminf(fminf(fmaf(fx, r.ix, r.ox), fmaf(fy, r.iy, r.oy)), fminf(fmaf(fz, r.iz, r.oz), r.t_max));
    return entry <= exit;
}

__device__ inline void visit_bvh2(const float4* nodes, std::uint32_t* stack, Lane& lane) {
    const float4* node = nodes + 4 * std::size_t{lane.current};
    const float4 x = __ldg(node), y = __ldg(node + 1), z = __ldg(node + 2), c = __ldg(node + 3);
    float t0, t1;
    const bool h0 = slab(lane.ray, x.x, x.z, y.x, y.z, z.x, z.z, t0),
               h1 = slab(lane.ray, x.y, x.w, y.y, y.w, z.y, z.w, t1);
    const std::uint32_t a = __float_as_uint(c.x), b = __float_as_uint(c.y);
    const bool second_first = h1 && (!h0 || t1 < t0);
    push(stack, lane, second_first ? a : b, h0 && h1);
    const bool none = !h0 && !h1;
    if (none) --lane.top;
    lane.current = none ? stack[lane.top] : second_first ? b : a;
}

__device__ inline void order(float& ta, float& tb, std::uint32_t& a, std::uint32_t& b) {
    const bool swap = tb > ta;  // the farthest first
    const float t = swap ? ta : tb;
    const std::uint32_t r = swap ? a : b;
    ta = swap ? tb : ta;
    a = swap ? b : a;
    tb = t;
    b = r;
}

__device__ inline void visit_bvh4(const float4* nodes, std::uint32_t* stack, Lane& lane) {
    const float4* node = nodes + 8 * std::size_t{lane.current};
    const float4 lx = __ldg(node), ly = __ldg(node + 1), lz = __ldg(node + 2), ux = __ldg(node + 3),
                 uy = __ldg(node + 4), uz = __ldg(node + 5), c = __ldg(node + 6);
    float t[4];
    std::uint32_t ref[4] = {__float_as_uint(c.x), __float_as_uint(c.y), __float_as_uint(c.z), __float_as_uint(c.w)};
    const bool h0 = slab(lane.ray, lx.x, ux.x, ly.x, uy.x, lz.x, uz.x, t[0]),
               h1 = slab(lane.ray, lx.y, ux.y, ly.y, uy.y, lz.y, uz.y, t[1]),
               h2 = slab(lane.ray, lx.z, ux.z, ly.z, uy.z, lz.z, uz.z, t[2]),
               h3 = slab(lane.ray, lx.w, ux.w, ly.w, uy.w, lz.w, uz.w, t[3]);
    // Missed ones last: nearer than all that are hit.
    t[0] = h0 ? t[0] : -1;
    t[1] = h1 ? t[1] : -1;
    t[2] = h2 ? t[2] : -1;
    t[3] = h3 ? t[3] : -1;
    const unsigned count = h0 + h1 + h2 + h3;
    order(t[0], t[1], ref[0], ref[1]);
    order(t[2], t[3], ref[2], ref[3]);
    order(t[0], t[2], ref[0], ref[2]);
    order(t[1], t[3], ref[1], ref[3]);
    order(t[1], t[2], ref[1], ref[2]);
    push(stack, lane, ref[0], count > 1);
    push(stack, lane, ref[1], count > 2);
    push(stack, lane, ref[2], count > 3);
    const std::uint32_t nearest = count == 4 ? ref[3] : count == 3 ? ref[2] : count == 2 ? ref[1] : ref[0];
    if (count == 0) --lane.top;
    lane.current = count == 0 ? stack[lane.top] : nearest;
}

__device__ inline float byte_of(std::uint32_t four, int i) { return static_cast<float>((four >> (8 * i)) & 0xff); }

__device__ inline void visit_cwbvh8(const float4* nodes, std::uint64_t* stack, Lane& lane, std::uint32_t octant,
                                    std::uint32_t& triangles) {
    const float4* node = nodes + 5 * std::size_t{lane.current};
    const float4 n0 = __ldg(node), n1 = __ldg(node + 1), n2 = __ldg(node + 2), n3 = __ldg(node + 3),
                 n4 = __ldg(node + 4);
    const std::uint32_t e = __float_as_uint(n0.w);
    // The ray in steps of the node's grid, and by the signs of its direction which planes are near, as in Ylitie et al.
    // 2017.
    Ray r = lane.ray;
    r.ox = (n0.x - lane.ray.ox) * lane.ray.ix;
    r.oy = (n0.y - lane.ray.oy) * lane.ray.iy;
    r.oz = (n0.z - lane.ray.oz) * lane.ray.iz;
    r.ix *= __uint_as_float((e & 0xff) << 23);
    r.iy *= __uint_as_float(((e >> 8) & 0xff) << 23);
    r.iz *= __uint_as_float(((e >> 16) & 0xff) << 23);
    const bool sx = lane.ray.ix < 0, sy = lane.ray.iy < 0, sz = lane.ray.iz < 0;
    std::uint32_t hits = 0;
#pragma unroll
    for (int half = 0; half < 2; ++half) {
        const std::uint32_t meta = __float_as_uint(half == 0 ? n1.z : n1.w);
        const std::uint32_t lx = __float_as_uint(half == 0 ? n2.x : n2.y),
                            ly = __float_as_uint(half == 0 ? n2.z : n2.w),
                            lz = __float_as_uint(half == 0 ? n3.x : n3.y),
                            ux = __float_as_uint(half == 0 ? n3.z : n3.w),
                            uy = __float_as_uint(half == 0 ? n4.x : n4.y),
                            uz = __float_as_uint(half == 0 ? n4.z : n4.w);
        const std::uint32_t nx = sx ? ux : lx, fx = sx ? lx : ux, ny = sy ? uy : ly, fy = sy ? ly : uy,
                            nz = sz ? uz : lz, fz = sz ? lz : uz;
        // Of all four: which are nodes, and where the bits of each go.
        const std::uint32_t is_node = (meta & (meta << 1)) & 0x10101010;
        const std::uint32_t node_mask = __byte_perm(is_node << 3, 0, 0xba98);
        const std::uint32_t place = (meta ^ (octant & node_mask)) & 0x1f1f1f1f;
        const std::uint32_t bits = (meta >> 5) & 0x07070707;
#pragma unroll
        for (int i = 0; i < 4; ++i) {
            if (ordered_slab(r, byte_of(nx, i), byte_of(fx, i), byte_of(ny, i), byte_of(fy, i), byte_of(nz, i),
                             byte_of(fz, i)))
                hits |= ((bits >> (8 * i)) & 0xff) << ((place >> (8 * i)) & 0xff);
        }
    }
    triangles = hits & 0x00ffffff;
    lane.group = __float_as_uint(n1.x);
    lane.bits = (hits & 0xff000000) | (e >> 24);
    // To the next node: of this group, or of the one on the stack.
    if (lane.bits <= 0x00ffffff) {
        const std::uint64_t popped = stack[--lane.top];
        lane.group = static_cast<std::uint32_t>(popped);
        lane.bits = static_cast<std::uint32_t>(popped >> 32);
    }
    const int highest = 31 - __clz(static_cast<int>(lane.bits));
    const std::uint32_t slot = static_cast<std::uint32_t>(highest - 24) ^ (octant & 7);
    lane.current = lane.group + static_cast<std::uint32_t>(__popc(lane.bits & ~(0xffffffffU << slot)));
    lane.bits &= ~(1U << highest);
    if (lane.bits > 0x00ffffff) stack[lane.top++] = std::uint64_t{lane.bits} << 32 | lane.group;
}

extern "C" __global__ void visits(const float4* nodes, Lane* lanes, std::uint32_t* result) {
    const unsigned id = blockIdx.x * blockDim.x + threadIdx.x;
    Lane lane = lanes[id];
#if LAYOUT == 8
    std::uint64_t stack[32];
    const std::uint32_t octant = lanes[id].bits;
    std::uint32_t all = 0, triangles = 0;
#pragma unroll
    for (int i = 0; i < VISITS; ++i) {
        visit_cwbvh8(nodes, stack, lane, octant, triangles);
        all ^= triangles;
    }
    result[id] = lane.current ^ all;
#else
    std::uint32_t stack[64];
#pragma unroll
    for (int i = 0; i < VISITS; ++i)
#if LAYOUT == 4
        visit_bvh4(nodes, stack, lane);
#else
        visit_bvh2(nodes, stack, lane);
#endif
    result[id] = lane.current + lane.top;
#endif
}
