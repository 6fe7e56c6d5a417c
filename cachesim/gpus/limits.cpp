#include "cachesim/gpus/limits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>

#include "cachesim/cache/registry.hpp"

namespace raycache::cachesim {

namespace {

constexpr std::uint64_t most_bytes = std::uint64_t{1} << 40;
constexpr std::uint64_t most_lines = std::uint64_t{1} << 26;

std::optional<GpuProblem> not_in(const std::string& key, std::uint64_t value, std::uint64_t low, std::uint64_t high) {
    if (value >= low && value <= high) return std::nullopt;
    return GpuProblem{key, fmt::format("expected {} to {}, found {}", low, high, value)};
}

std::optional<GpuProblem> not_a_power_of_two(const std::string& key, std::uint64_t value) {
    if (std::has_single_bit(value)) return std::nullopt;
    return GpuProblem{
        key, fmt::format("expected a power of two, found {}; nearest below: {}", value, std::bit_floor(value))};
}

/// One level: `caches` caches of this geometry.
std::optional<GpuProblem> find_problem(const CacheGeometry& cache, const std::string& level, std::uint64_t caches) {
    if (auto p = not_in(level + ".line_bytes", cache.line_bytes, 16, 4096)) return p;
    if (auto p = not_in(level + ".sector_bytes", cache.sector_bytes, 4, 4096)) return p;
    if (cache.sector_bytes > cache.line_bytes)
        return GpuProblem{level + ".sector_bytes", fmt::format("expected at most the line's {} bytes, found {}",
                                                               cache.line_bytes, cache.sector_bytes)};
    if (cache.line_bytes % cache.sector_bytes)
        return GpuProblem{level + ".line_bytes", fmt::format("expected a multiple of the sector's {} bytes, found {}",
                                                             cache.sector_bytes, cache.line_bytes)};
    if (auto p = not_a_power_of_two(level + ".line_bytes", cache.line_bytes)) return p;
    if (auto p = not_a_power_of_two(level + ".sector_bytes", cache.sector_bytes)) return p;
    if (cache.line_bytes / cache.sector_bytes > 32)
        return GpuProblem{level + ".sector_bytes",
                          fmt::format("expected at most 32 sectors per line, found {} ({} bytes / {} bytes); make "
                                      "sectors larger or lines smaller",
                                      cache.line_bytes / cache.sector_bytes, cache.line_bytes, cache.sector_bytes)};
    if (auto p = not_in(level + ".sets", cache.sets, 1, most_bytes)) return p;
    if (auto p = not_in(level + ".ways", cache.ways, 1, most_bytes)) return p;
    if (cache.sets > most_bytes / cache.line_bytes / cache.ways)
        return GpuProblem{level + ".sets", fmt::format("expected sets x ways x line of at most 2^40 bytes, found "
                                                       "{} x {} x {}; check the unit",
                                                       cache.sets, cache.ways, cache.line_bytes)};
    if (cache.sets * cache.ways > most_lines / caches)
        return GpuProblem{level + ".sets",
                          fmt::format("expected at most 2^26 lines in all {0} cache{1} together, found {2} x {3} in "
                                      "each; make the cache smaller",
                                      caches, caches == 1 ? "" : "s", cache.sets, cache.ways)};
    const auto policies = cache_policies();
    if (std::find(policies.begin(), policies.end(), cache.policy) == policies.end())
        return GpuProblem{level + ".policy",
                          fmt::format("expected one of: {}; found \"{}\"", fmt::join(policies, ", "), cache.policy)};
    return std::nullopt;
}

}  // namespace

std::optional<GpuProblem> find_problem(const Gpu& gpu) {
    if (auto p = not_in("sms", gpu.sms, 1, 4096)) return p;
    if (auto p = not_in("warps_per_sm", gpu.warps_per_sm, 1, 1024)) return p;
    if (auto p = not_in("warps_per_cta", gpu.warps_per_cta, 1, 64)) return p;
    if (auto p = not_in("l1_per_sm", gpu.l1_per_sm, 1, 8)) return p;
    if (auto p = find_problem(gpu.l1, "l1", std::uint64_t{gpu.sms} * gpu.l1_per_sm)) return p;
    if (auto p = find_problem(gpu.l2, "l2", 1)) return p;
    if (gpu.l2.line_bytes != gpu.l1.line_bytes)
        return GpuProblem{"l2.line_bytes", fmt::format("expected the line size of L1, {}, found {}; levels of unequal "
                                                       "lines are not modelled",
                                                       gpu.l1.line_bytes, gpu.l2.line_bytes)};
    if (gpu.l2.sector_bytes != gpu.l1.sector_bytes)
        return GpuProblem{"l2.sector_bytes", fmt::format("expected the sector size of L1, {}, found {}; levels of "
                                                         "unequal sectors are not modelled",
                                                         gpu.l1.sector_bytes, gpu.l2.sector_bytes)};
    return std::nullopt;
}

}  // namespace raycache::cachesim
