// Vectors of double, where float is not enough.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "tracer/vec.hpp"

namespace raycache::tracer {

struct Vec3d {
    double x = 0, y = 0, z = 0;

    Vec3d() = default;
    Vec3d(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
    Vec3d(Vec3 v) : x(v.x), y(v.y), z(v.z) {}  // NOLINT(google-explicit-constructor): loses nothing
    double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    bool operator==(const Vec3d&) const = default;
    Vec3 rounded() const { return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}; }
};

inline Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// Functions that Vec3 has too take no braces and no Vec3, which stay floats.
template <std::same_as<Vec3d> V>
V operator*(V a, double s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <std::same_as<Vec3d> V>
double dot(V a, V b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <std::same_as<Vec3d> V>
V cross(V a, V b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <std::same_as<Vec3d> V>
double length(V a) {
    return std::sqrt(dot(a, a));
}
inline double max_abs(Vec3d a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

}  // namespace raycache::tracer
