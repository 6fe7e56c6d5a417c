// The surface of a box: how likely a ray that meets what is around it meets the box.
#pragma once

#include "tracer/vec.hpp"

namespace raycache::tracer {

/// Half of it. In double: edges of 1e18 would overflow a float.
inline double half_area(const Box& box) {
    const double x = double{box.upper.x} - box.lower.x, y = double{box.upper.y} - box.lower.y,
                 z = double{box.upper.z} - box.lower.z;
    return x * y + y * z + z * x;
}

}  // namespace raycache::tracer
