// Where a line goes, as the head of cachesim/cache/line_map.hpp says it: bit strings and long division, no table.
#pragma once

#include <cstdint>
#include <string>

#include "cachesim/gpus/gpu.hpp"

namespace raycache::cachesim::test {

struct NaivePlace {
    std::uint64_t slice, set;
};
NaivePlace naive_place(const CacheGeometry&, std::uint64_t line);

/// slice * sets + set.
std::uint64_t naive_set(const CacheGeometry&, std::uint64_t line);

/// The remainder of a string of '0' and '1', highest power first, modulo another one, as a number.
std::uint64_t naive_remainder(std::string dividend, const std::string& divisor);

}  // namespace raycache::cachesim::test
