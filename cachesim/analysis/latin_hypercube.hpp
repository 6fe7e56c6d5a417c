// Latin hypercube sampling (McKay, Beckman & Conover, "A comparison of three methods for selecting values of input
// variables in the analysis of output from a computer code", Technometrics 21, 1979): n points in d dimensions, of which
// in every dimension exactly one lies in each of n strata of equal size,
//     x_ij = (p_j(i) + u_ij) / n,   p_j a random permutation of 0 … n-1, u_ij uniform in [0, 1)
// so that n points see the whole range of every value, whatever the number of values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"

namespace raycache::cachesim {

/// n points of d coordinates in [0, 1). The same numbers on every machine for a seed.
std::vector<std::vector<double>> latin_hypercube(std::size_t points, std::size_t dimensions, std::uint64_t seed);

/// The value at x in [0, 1) of a range, as a GPU file has it: one of as many equal parts as there are choices, or uniform
/// between the ends, both included; a whole number where both ends are written as such.
std::string value_at(const GpuRange&, double x);

}  // namespace raycache::cachesim
