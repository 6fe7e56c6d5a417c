#include "tracer/scene/builtin/modelling/shapes.hpp"

#include <array>

#include "tracer/scene/builtin/modelling/random.hpp"

namespace raycache::tracer::modelling {

void flat(MeshBuilder& b, Vec3 a, Vec3 right, Vec3 c, Vec3 d, float uv_per_metre) {
    const Vec3 along = normalize(right - a), up = cross(normalize(cross(right - a, d - a)), along);
    const auto corner = [&](Vec3 p) {
        const Vec3 q = (p - a) * uv_per_metre;
        return b.vertex(p, {}, {dot(q, along), dot(q, up)});
    };
    const std::uint32_t first = corner(a);
    corner(right), corner(c), corner(d);
    b.quad(first, first + 1, first + 2, first + 3);
}

void box(MeshBuilder& b, Vec3 lower, Vec3 upper) {
    const auto first = static_cast<std::uint32_t>(b.vertices());
    for (int i = 0; i < 8; ++i) {
        b.vertex({i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z});
    }
    constexpr std::array<std::array<std::uint32_t, 4>, 6> faces{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    for (const auto& f : faces) b.quad(first + f[0], first + f[1], first + f[2], first + f[3]);
}

void textured_box(MeshBuilder& b, Vec3 l, Vec3 u, float uv) {
    flat(b, {l.x, l.y, u.z}, {u.x, l.y, u.z}, {u.x, u.y, u.z}, {l.x, u.y, u.z}, uv);
    flat(b, {u.x, l.y, l.z}, {l.x, l.y, l.z}, {l.x, u.y, l.z}, {u.x, u.y, l.z}, uv);
    flat(b, {u.x, l.y, u.z}, {u.x, l.y, l.z}, {u.x, u.y, l.z}, {u.x, u.y, u.z}, uv);
    flat(b, {l.x, l.y, l.z}, {l.x, l.y, u.z}, {l.x, u.y, u.z}, {l.x, u.y, l.z}, uv);
    flat(b, {l.x, u.y, u.z}, {u.x, u.y, u.z}, {u.x, u.y, l.z}, {l.x, u.y, l.z}, uv);
    flat(b, {l.x, l.y, l.z}, {u.x, l.y, l.z}, {u.x, l.y, u.z}, {l.x, l.y, u.z}, uv);
}

void bar(MeshBuilder& b, Vec3 from, Vec3 to, Vec3 up, float width, float height, int rounding, float radius) {
    const Vec3 along = normalize(to - from), side = normalize(cross(along, up)), top = cross(side, along);
    const auto first = static_cast<std::uint32_t>(b.vertices());
    const float r = rounding > 0 ? std::min(radius, 0.45F * std::min(width, height)) : 0;
    const int per_corner = rounding + 1;
    const auto around = static_cast<std::uint32_t>(4 * per_corner);
    for (const Vec3 end : {from, to}) {
        for (int corner = 0; corner < 4; ++corner) {
            for (int i = 0; i < per_corner; ++i) {
                const double angle = 0.25 * corner + (rounding > 0 ? 0.25 * i / rounding : 0.125);
                const auto [c, s] = cos_sin(angle);
                const float sx = corner == 0 || corner == 3 ? 1.F : -1.F, sy = corner < 2 ? 1.F : -1.F;
                const Vec3 n = side * c + top * s;
                b.vertex(end + side * (sx * (width / 2 - r) + c * r) + top * (sy * (height / 2 - r) + s * r),
                         rounding > 0 ? n : Vec3{});
            }
        }
    }
    for (std::uint32_t i = 0; i < around; ++i) {
        const std::uint32_t next = (i + 1) % around;
        // side, top, along are left-handed in this order, so going round runs clockwise seen from `to`.
        b.quad(first + i, first + around + i, first + around + next, first + next);
    }
    for (const bool far : {false, true}) {
        std::uint32_t cap = first + (far ? around : 0);
        if (rounding > 0) {  // a flat end needs vertices without the sides' normals
            cap = static_cast<std::uint32_t>(b.vertices());
            for (int corner = 0; corner < 4; ++corner) {
                for (int i = 0; i < per_corner; ++i) {
                    const auto [c, s] = cos_sin(0.25 * corner + 0.25 * i / rounding);
                    const float sx = corner == 0 || corner == 3 ? 1.F : -1.F, sy = corner < 2 ? 1.F : -1.F;
                    b.vertex((far ? to : from) + side * (sx * (width / 2 - r) + c * r) +
                             top * (sy * (height / 2 - r) + s * r));
                }
            }
        }
        for (std::uint32_t i = 1; i + 1 < around; ++i) {
            if (far)
                b.triangle(cap, cap + i + 1, cap + i);
            else
                b.triangle(cap, cap + i, cap + i + 1);
        }
    }
}

std::vector<Turning> curve(std::span<const Turning> points, int steps) {
    std::vector<Turning> out;
    const auto slope = [&](std::size_t i, bool forward) -> Vec2 {
        const bool end = i == 0 || i + 1 == points.size() || points[i].sharp;
        const std::size_t a = end && forward ? i : i - 1, c = end && !forward ? i : i + 1;
        const float scale = end ? 1.F : 0.5F;
        return {(points[c].radius - points[a].radius) * scale, (points[c].y - points[a].y) * scale};
    };
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Turning p = points[i], q = points[i + 1];
        out.push_back(p);
        const bool straight = (i == 0 || p.sharp) && (i + 2 == points.size() || q.sharp);
        if (straight) continue;
        const Vec2 m = slope(i, true), n = slope(i + 1, false);
        for (int k = 1; k < steps; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(steps), t2 = t * t, t3 = t2 * t;
            const float a = 2 * t3 - 3 * t2 + 1, c = t3 - 2 * t2 + t, d = -2 * t3 + 3 * t2, e = t3 - t2;
            out.push_back({std::max(0.F, a * p.radius + c * m.x + d * q.radius + e * n.x),
                           a * p.y + c * m.y + d * q.y + e * n.y, false});
        }
    }
    out.push_back(points.back());
    return out;
}

std::vector<Turning> every_other(std::span<const Turning> points) {
    std::vector<Turning> out;
    for (std::size_t i = 0; i + 1 < points.size(); i += 2) out.push_back(points[i]);
    out.push_back(points.back());
    return out;
}

void lathe(MeshBuilder& b, std::span<const Turning> profile, int sides) {
    const auto n = static_cast<std::uint32_t>(sides);
    const auto put_ring = [&](const Turning& p, Vec2 normal) {
        const auto first = static_cast<std::uint32_t>(b.vertices());
        if (p.radius <= 0) {
            b.vertex({0, p.y, 0}, {0, normal.y < 0 ? -1.F : 1.F, 0});
            return first;
        }
        for (std::uint32_t i = 0; i < n; ++i) {
            const auto [c, s] = cos_sin(static_cast<double>(i) / n);
            b.vertex({p.radius * c, p.y, -p.radius * s}, {normal.x * c, normal.y, -normal.x * s});
        }
        return first;
    };
    const auto facing = [&](std::size_t i) {  // outward normal of piece i
        const Vec3 d = normalize(Vec3{profile[i + 1].y - profile[i].y, profile[i].radius - profile[i + 1].radius, 0});
        return Vec2{d.x, d.y};
    };
    const auto between = [](Vec2 p, Vec2 q) {
        const Vec3 d = normalize(Vec3{p.x + q.x, p.y + q.y, 0});
        return d == Vec3{} ? p : Vec2{d.x, d.y};
    };
    std::uint32_t lower = put_ring(profile[0], facing(0));
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const Turning &p = profile[i], &q = profile[i + 1];
        const bool last = i + 2 == profile.size();
        const Vec2 here = facing(i), next = last ? here : facing(i + 1);
        const bool split = q.sharp && !last;
        const std::uint32_t upper = put_ring(q, split || last ? here : between(here, next));
        for (std::uint32_t k = 0; k < n; ++k) {
            const std::uint32_t k1 = (k + 1) % n;
            if (p.radius <= 0 && q.radius <= 0) break;
            if (p.radius <= 0)
                b.triangle(lower, upper + k1, upper + k);
            else if (q.radius <= 0)
                b.triangle(lower + k, lower + k1, upper);
            else
                b.quad(lower + k, lower + k1, upper + k1, upper + k);
        }
        lower = split ? put_ring(q, next) : upper;
    }
}

void ball(MeshBuilder& b, Vec3 centre, float radius, int sides) {
    const int rows = std::max(2, sides / 2);
    std::vector<Turning> profile;
    for (int i = 0; i <= rows; ++i) {
        const auto [c, s] = cos_sin(0.5 * i / rows);
        profile.push_back({i == 0 || i == rows ? 0 : radius * s, -radius * c, false});
    }
    const Transform outer = b.frame();
    b.frame(outer * moved(centre));
    lathe(b, profile, sides);
    b.frame(outer);
}

void disc(MeshBuilder& b, Vec3 centre, float radius, int sides) {
    const auto first = b.vertex(centre);
    const auto n = static_cast<std::uint32_t>(sides);
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto [c, s] = cos_sin(static_cast<double>(i) / n);
        b.vertex(centre + Vec3{radius * c, 0, -radius * s});
    }
    for (std::uint32_t i = 0; i < n; ++i) b.triangle(first, first + 1 + i, first + 1 + (i + 1) % n);
}

void tube(MeshBuilder& b, std::span<const Vec3> path, std::span<const float> radii, int sides) {
    const std::size_t points = path.size();
    const auto n = static_cast<std::uint32_t>(sides);
    if (b.counting()) return b.count((points + 2) * n, 2 * n * (points - 1) + 2 * (n - 2));
    const auto first = static_cast<std::uint32_t>(b.vertices());
    Vec3 side;
    std::vector<Vec3> rim;  // of both ends
    for (std::size_t i = 0; i < points; ++i) {
        const Vec3 along = normalize(path[std::min(i + 1, points - 1)] - path[i > 0 ? i - 1 : 0]);
        if (i == 0) side = cross(along, std::abs(along.y) < 0.9F ? Vec3{0, 1, 0} : Vec3{1, 0, 0});
        side = normalize(side - along * dot(side, along));  // carried along without twist
        const Vec3 other = cross(along, side);
        for (std::uint32_t k = 0; k < n; ++k) {
            const auto [c, s] = cos_sin(static_cast<double>(k) / n);
            const Vec3 normal = side * c + other * s;
            const Vec3 p = path[i] + normal * radii[i];
            b.vertex(p, normal);
            if (i == 0 || i + 1 == points) rim.push_back(p);
        }
    }
    const auto last = first + static_cast<std::uint32_t>(points - 1) * n;
    for (std::uint32_t row = first; row < last; row += n) {
        for (std::uint32_t k = 0; k < n; ++k) {
            const std::uint32_t k1 = (k + 1) % n;
            b.quad(row + k, row + k1, row + n + k1, row + n + k);
        }
    }
    for (const bool far : {false, true}) {  // flat ends, with vertices of their own
        const auto cap = static_cast<std::uint32_t>(b.vertices());
        for (std::uint32_t k = 0; k < n; ++k) b.vertex(rim[far ? n + k : k]);
        for (std::uint32_t k = 1; k + 1 < n; ++k) {
            if (far)
                b.triangle(cap, cap + k, cap + k + 1);
            else
                b.triangle(cap, cap + k + 1, cap + k);
        }
    }
}

void tube(MeshBuilder& b, std::span<const Vec3> path, float radius, int sides) {
    const std::vector<float> radii(path.size(), radius);
    tube(b, path, radii, sides);
}

void ring(MeshBuilder& b, Vec3 centre, float radius, float wire, int around, int sides) {
    const auto n = static_cast<std::uint32_t>(around), m = static_cast<std::uint32_t>(sides);
    const auto first = static_cast<std::uint32_t>(b.vertices());
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto [c, s] = cos_sin(static_cast<double>(i) / n);
        for (std::uint32_t k = 0; k < m; ++k) {
            const auto [p, q] = cos_sin(static_cast<double>(k) / m);
            const Vec3 normal{c * p, q, -s * p};
            b.vertex(centre + Vec3{c * radius, 0, -s * radius} + normal * wire, normal);
        }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t k = 0; k < m; ++k) {
            const std::uint32_t i1 = (i + 1) % n, k1 = (k + 1) % m;
            b.quad(first + i * m + k, first + i1 * m + k, first + i1 * m + k1, first + i * m + k1);
        }
    }
}

}  // namespace raycache::tracer::modelling
