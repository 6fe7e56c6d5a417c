#include "tracer/sampling/sample_set.hpp"

#include <fmt/format.h>

#include "traces/error.hpp"

namespace raycache::tracer {

void check_spp(std::uint64_t spp) {
    constexpr std::uint64_t most = std::uint64_t{1} << 32;
    if (spp >= 1 && spp <= most) return;
    throw UsageError(fmt::format(
        "sampling: the number of samples per pixel N must be 1 to {}, found {}: give an N in that range", most, spp));
}

}  // namespace raycache::tracer
