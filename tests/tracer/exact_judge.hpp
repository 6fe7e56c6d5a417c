// Which answers to a ray query are right within rounding? Decided in double arithmetic from the float triangles,
// without the code under test but for the boxes of its tree, widened. Two watertight intersectors may disagree about a
// ray that passes an edge closer than their rounding error, or about which of two surfaces at the same distance is in
// front. So the judge says for each triangle whether the ray crosses it for sure, perhaps, or not, with stated bounds,
// and an answer is justified if
//   a hit:    its triangle is crossed perhaps, its t is right within the bound, and nothing sure lies in front beyond
//   the bounds; a miss:   nothing is crossed for sure between t_min and t_max.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "test_rays.hpp"
#include "tracer/bvh/layouts/bvh2.hpp"
#include "tracer/ray.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer::test {

/// Bound of the error across the ray: `lateral_ulps` * 2^-24 * the distance from the origin to the triangle's farthest
/// vertex. Both intersectors first subtract the origin, so their errors grow with that distance and not with the
/// coordinates. Woop's shear rounds five times per coordinate, sqrt(2) * 5 < 8.
inline constexpr double lateral_ulps = 8;
/// Bound of the error along the ray: `depth_ulps` * 2^-24 * the same distance, plus what the lateral error does to the
/// barycentric weights of a tilted triangle, times the triangle's extent in depth. A weight is the cross product of two
/// vectors a and b from the ray to vertices, so it is wrong by (|a| + |b|) * lateral error, the three together by at
/// most 4 * the longest edge * that; divided by the area: 4 * lateral error / smallest height; rounding the products
/// adds less than 0.5. Depth is the distance along the ray, or, where a method shears the triangle along the main axis
/// of the direction, along that axis: the longer of the two.
inline constexpr double depth_ulps = 8, weight_factor = 4.5;
inline constexpr double ulp = 0x1p-24;

struct Crossing {
    std::uint32_t triangle = no_triangle;
    double t = 0;        ///< of the plane; of the nearest vertex for a triangle seen edge-on
    double t_error = 0;  ///< bound
    double inside = 0;   ///< distance across the ray from the point to the nearest edge: > 0 inside, < 0 outside
    double inside_error = 0;
    bool perhaps() const { return inside >= -inside_error; }
    bool sure() const { return inside > inside_error; }
};

class ExactRay {
public:
    explicit ExactRay(const Ray& ray) : ray_(ray) {
        for (int i = 0; i < 3; ++i) {
            origin_[i] = ray.origin[i];
            direction_[i] = ray.direction[i];
        }
        length_ = std::sqrt(dot(direction_, direction_));
        for (int i = 1; i < 3; ++i)
            if (std::fabs(direction_[i]) > std::fabs(direction_[main_axis_])) main_axis_ = i;
        const D3 d = scaled(direction_, 1 / length_);
        const D3 axis = std::fabs(d[0]) < 0.5 ? D3{1, 0, 0} : D3{0, 1, 0};
        side_[0] = cross(d, axis);
        side_[0] = scaled(side_[0], 1 / std::sqrt(dot(side_[0], side_[0])));
        side_[1] = cross(d, side_[0]);
        side_[2] = d;
    }

    Crossing crossing(const Scene& scene, std::uint32_t triangle) const {
        D3 p[3];  // vertices in the ray's frame: across, across, along
        double reach = 0, z_low = 1e300, z_high = -1e300, axis_low = 1e300, axis_high = -1e300;
        for (std::uint32_t c = 0; c < 3; ++c) {
            const Vec3 v = corner(scene, triangle, c);
            const D3 way{v.x - origin_[0], v.y - origin_[1], v.z - origin_[2]};
            reach = std::max(reach, std::sqrt(dot(way, way)));
            for (int i = 0; i < 3; ++i) p[c][i] = dot(way, side_[i]);
            z_low = std::min(z_low, p[c][2]);
            z_high = std::max(z_high, p[c][2]);
            axis_low = std::min(axis_low, way[main_axis_]);
            axis_high = std::max(axis_high, way[main_axis_]);
        }
        Crossing out;
        out.triangle = triangle;
        out.inside_error = lateral_ulps * ulp * reach;
        double weight[3], edge[3], area = 0;
        for (int i = 0; i < 3; ++i) {
            const D3 &a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
            weight[i] = a[0] * b[1] - a[1] * b[0];
            edge[i] = std::hypot(b[0] - a[0], b[1] - a[1]);
            area += weight[i];
        }
        const double sign = area < 0 ? -1 : 1, longest = std::max({edge[0], edge[1], edge[2]});
        const double height = longest > 0 ? std::fabs(area) / longest : 0;  // the smallest, seen along the ray
        out.inside = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 3; ++i)
            out.inside = std::min(out.inside, edge[i] > 0 ? sign * weight[i] / edge[i]
                                                          : -std::hypot(p[(i + 1) % 3][0], p[(i + 1) % 3][1]));
        if (out.inside < 0) out.inside = -outside(p);
        double z = z_low,
               move = std::max(z_high - z_low, (axis_high - axis_low) * length_ / std::fabs(direction_[main_axis_]));
        if (height > 0) {
            z = (weight[0] * p[0][2] + weight[1] * p[1][2] + weight[2] * p[2][2]) / area;
            z = std::clamp(z, z_low, z_high);
            const double share = weight_factor * out.inside_error / height;
            move *= share < 0.5 ? share / (1 - share) : 1;  // the area that divides is as wrong as the weights
        }
        out.t = z / length_;
        out.t_error = (depth_ulps * ulp * reach + move) / length_;
        return out;
    }

    const Ray& ray() const { return ray_; }

    /// Whether the ray's line comes near the box: 2^-16 of the distances involved is far more than any rounding.
    bool near(const Box& box) const {
        double low = -std::numeric_limits<double>::infinity(), high = -low;
        double reach = 0;
        for (int i = 0; i < 3; ++i)
            reach = std::max({reach, std::fabs(box.lower[i] - origin_[i]), std::fabs(box.upper[i] - origin_[i])});
        const double margin = reach * 0x1p-16;
        for (int i = 0; i < 3; ++i) {
            double a = box.lower[i] - margin - origin_[i], b = box.upper[i] + margin - origin_[i];
            if (direction_[i] == 0) {
                if (a > 0 || b < 0) return false;
                continue;
            }
            a /= direction_[i];
            b /= direction_[i];
            low = std::max(low, std::min(a, b));
            high = std::min(high, std::max(a, b));
        }
        const double slack = margin / length_;
        return low <= high && high >= ray_.t_min - slack && low <= double{ray_.t_max} + slack;
    }

private:
    using D3 = std::array<double, 3>;
    static double dot(const D3& a, const D3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
    static D3 cross(const D3& a, const D3& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    static D3 scaled(const D3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }

    /// Distance across the ray to the nearest point of the triangle's outline.
    static double outside(const D3 (&p)[3]) {
        double nearest = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 3; ++i) {
            const D3 &a = p[i], &b = p[(i + 1) % 3];
            const double ex = b[0] - a[0], ey = b[1] - a[1], square = ex * ex + ey * ey;
            const double s = square > 0 ? std::clamp(-(a[0] * ex + a[1] * ey) / square, 0.0, 1.0) : 0;
            nearest = std::min(nearest, std::hypot(a[0] + s * ex, a[1] + s * ey));
        }
        return nearest;
    }

    Ray ray_;
    D3 origin_, direction_, side_[3];
    double length_;
    int main_axis_ = 0;  ///< along which the direction is largest
};

/// Every triangle that the ray perhaps crosses between t_min and t_max.
inline std::vector<Crossing> crossings(const PreparedScene& scene, const Ray& ray) {
    const ExactRay exact(ray);
    const auto& bvh = dynamic_cast<const Bvh2&>(scene.bvh());
    std::vector<Crossing> found;
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
        const Bvh2Node& node = bvh.nodes[stack.back()];
        stack.pop_back();
        for (int c = 0; c < 2; ++c) {
            const std::uint32_t ref = node.child[c];
            if (!exact.near({{node.x[c], node.y[c], node.z[c]}, {node.x[c + 2], node.y[c + 2], node.z[c + 2]}}))
                continue;
            if (!ChildRef::is_leaf(ref))
                stack.push_back(ref);
            else
                for (std::uint32_t k = 0; k < ChildRef::count(ref); ++k) {
                    const Crossing made =
                        exact.crossing(scene.scene(), bvh.triangles[ChildRef::first(ref) + k].triangle);
                    if (made.perhaps() && made.t + made.t_error >= ray.t_min && made.t - made.t_error <= ray.t_max)
                        found.push_back(made);
                }
        }
    }
    return found;
}

/// The nearest distance by which something is hit for sure; infinity if nothing is.
inline double sure_distance(std::span<const Crossing> crossings, const Ray& ray) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Crossing& c : crossings)
        if (c.sure() && c.t - c.t_error > ray.t_min && c.t + c.t_error < ray.t_max)
            nearest = std::min(nearest, c.t + c.t_error);
    return nearest;
}

inline bool justified(std::span<const Crossing> crossings, const Ray& ray, const Hit& hit) {
    const double sure = sure_distance(crossings, ray);
    if (!hit.found()) return sure == std::numeric_limits<double>::infinity();
    return std::any_of(crossings.begin(), crossings.end(), [&](const Crossing& c) {
        return c.triangle == hit.triangle && std::fabs(hit.t - c.t) <= c.t_error && c.t - c.t_error <= sure;
    });
}

inline bool justified(std::span<const Crossing> crossings, const Ray& ray, bool occluded) {
    return occluded ? !crossings.empty() : sure_distance(crossings, ray) == std::numeric_limits<double>::infinity();
}

}  // namespace raycache::tracer::test
