// Integrands with known means, to measure what a sampling strategy costs in image quality without rendering. Each is a
// picture of 64x64 pixels: every pixel has an integral over [0,1)^2 or [0,1)^4 of its own, which changes a little from
// pixel to pixel as in a rendered picture, and the exact value of each is known.
//
// Half-spaces {a.u < c} have the volume (inclusion and exclusion of the corners, d dimensions, all a_i > 0)
//     V = 1 / (d! prod a_i) * sum over subsets S of (-1)^|S| max(0, c - sum of a_i in S)^d
// (D. L. Barrow, P. W. Smith, "Spline notation applied to a volume problem", Amer. Math. Monthly 86, 1979).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace raycache::tracer {

inline constexpr std::uint32_t test_picture_side = 64;
inline constexpr unsigned test_dimensions = 4;

struct TestIntegrand {
    std::string name;  ///< "edge 27 degrees"
    bool edges;        ///< has a jump; smooth otherwise
    unsigned dimensions;
    /// At a point of [0,1)^4; those of two dimensions use the first two numbers. (px, py): the pixel's place, 0 … 1.
    double (*value)(const std::array<double, test_dimensions>& u, double px, double py);
    double (*mean)(double px, double py);  ///< exact
};

/// Twelve: 2-D edges at four angles, two discs, 2-D smooth, 4-D edges at three orientations, 4-D smooth.
const std::vector<TestIntegrand>& test_integrands();

/// Volume of {a.u < c} in the unit cube, 1 to 4 dimensions, any signs of a_i but none 0.
double half_space_volume(std::vector<double> a, double c);

}  // namespace raycache::tracer
