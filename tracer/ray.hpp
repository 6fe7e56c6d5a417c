// A ray and where it ends.
#pragma once

#include <cstdint>
#include <limits>

#include "tracer/vec.hpp"

namespace raycache::tracer {

struct Ray {
    Vec3 origin;
    Vec3 direction;  ///< any length but zero; t is in units of it
    float t_min = 0;
    float t_max = std::numeric_limits<float>::infinity();
};

inline constexpr std::uint32_t no_triangle = 0xffffffffU;

struct Hit {
    float t = std::numeric_limits<float>::infinity();
    float u = 0, v = 0;                    ///< barycentric weights of the second and third vertex
    std::uint32_t triangle = no_triangle;  ///< scene triangle

    bool found() const { return triangle != no_triangle; }
};

}  // namespace raycache::tracer
