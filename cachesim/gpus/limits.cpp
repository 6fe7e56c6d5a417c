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

bool has_polynomial(std::uint64_t count) { return count == 16 || count == 32 || count == 64; }

/// What the hashes of a level ask of its other keys.
std::optional<GpuProblem> find_hash_problem(const CacheGeometry& cache, const std::string& level) {
    if (cache.index == SetIndex::ipoly && !has_polynomial(cache.sets))
        return GpuProblem{level + ".index", fmt::format("expected 16, 32 or 64 sets for \"ipoly\", found {}; choose "
                                                        "another index",
                                                        cache.sets)};
    if (cache.index == SetIndex::parity &&
        (cache.index_masks.size() >= 32 || std::uint64_t{1} << cache.index_masks.size() != cache.sets))
        return GpuProblem{level + ".index_masks", fmt::format("expected log2(sets) masks for \"parity\" and {} sets, "
                                                              "found {}; give one address mask for each bit of the set",
                                                              cache.sets, cache.index_masks.size())};
    if (cache.slices == 1) return std::nullopt;
    if (cache.slice_hash != SliceHash::ipoly) {
        if (auto p = not_a_power_of_two(level + ".interleave_bytes", cache.interleave_bytes)) return p;
        return not_in(level + ".interleave_bytes", cache.interleave_bytes, cache.line_bytes, 1u << 30);
    }
    if (!has_polynomial(cache.slices))
        return GpuProblem{level + ".slice_hash", fmt::format("expected 16, 32 or 64 slices for \"ipoly\", found {}; "
                                                             "choose \"modulo\" or \"xor_fold\"",
                                                             cache.slices)};
    if (std::uint64_t{1} << std::min<std::size_t>(63, cache.slice_bits.size()) != cache.slices)
        return GpuProblem{level + ".slice_bits", fmt::format("expected log2({}) address bits, found {}", cache.slices,
                                                             cache.slice_bits.size())};
    const auto line_shift = static_cast<std::uint32_t>(std::countr_zero(cache.line_bytes));
    for (std::size_t i = 0; i < cache.slice_bits.size(); ++i) {
        if (auto p = not_in(level + ".slice_bits", cache.slice_bits[i], line_shift, 62)) return p;
        if (std::count(cache.slice_bits.begin(), cache.slice_bits.end(), cache.slice_bits[i]) > 1)
            return GpuProblem{level + ".slice_bits",
                              fmt::format("expected different address bits, found {} twice", cache.slice_bits[i])};
        if (cache.slice_bits[i] >= cache.slice_hash_from)
            return GpuProblem{level + ".slice_hash_from", fmt::format("expected a bit above all slice_bits, found {}; "
                                                                      "the highest slice bit is {}",
                                                                      cache.slice_hash_from, cache.slice_bits[i])};
    }
    return not_in(level + ".slice_hash_from", cache.slice_hash_from, 1, 63);
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
    if (auto p = not_in(level + ".slices", cache.slices, 1, 4096)) return p;
    if (cache.sets > most_bytes / cache.line_bytes / cache.ways / cache.slices)
        return GpuProblem{level + ".sets",
                          fmt::format("expected slices x sets x ways x line of at most 2^40 bytes, found "
                                      "{} x {} x {} x {}; check the unit",
                                      cache.slices, cache.sets, cache.ways, cache.line_bytes)};
    if (cache.slices * cache.sets * cache.ways > most_lines / caches)
        return GpuProblem{level + ".sets",
                          fmt::format("expected at most 2^26 lines in all {0} cache{1} together, found {2} x {3} x {4} "
                                      "in each; make the cache smaller",
                                      caches, caches == 1 ? "" : "s", cache.slices, cache.sets, cache.ways)};
    if (cache.fill_bytes) {
        if (auto p = not_a_power_of_two(level + ".fill_bytes", cache.fill_bytes)) return p;
        if (auto p = not_in(level + ".fill_bytes", cache.fill_bytes, cache.sector_bytes, cache.line_bytes)) return p;
    }
    if (auto p = find_hash_problem(cache, level)) return p;
    const auto policies = cache_policies();
    if (std::find(policies.begin(), policies.end(), cache.policy) == policies.end())
        return GpuProblem{level + ".policy",
                          fmt::format("expected one of: {}; found \"{}\"", fmt::join(policies, ", "), cache.policy)};
    return std::nullopt;
}

std::optional<GpuProblem> find_problem(const FrontEnd& front_end) {
    if (auto p = not_a_power_of_two("front_end.load_bytes", front_end.load_bytes)) return p;
    if (auto p = not_in("front_end.load_bytes", front_end.load_bytes, 4, 16)) return p;
    for (const auto& [key, lanes] : {std::pair{"front_end.lanes_per_request_16", front_end.lanes_per_request_16},
                                     std::pair{"front_end.lanes_per_request_8", front_end.lanes_per_request_8},
                                     std::pair{"front_end.lanes_per_request_4", front_end.lanes_per_request_4}}) {
        if (auto p = not_a_power_of_two(key, lanes)) return p;
        if (auto p = not_in(key, lanes, 1, 32)) return p;
    }
    return std::nullopt;
}

/// Open rows of DRAM.
std::optional<GpuProblem> find_row_problem(const Timing& t) {
    const bool rows = !t.dram_bank_bits.empty();
    if (t.dram_bank_bits.size() > 10)
        return GpuProblem{"timing.dram_bank_bits",
                          fmt::format("expected at most 10 address bits, found {}", t.dram_bank_bits.size())};
    for (const std::uint32_t bit : t.dram_bank_bits)
        if (auto p = not_in("timing.dram_bank_bits", bit, 0, 63)) return p;
    if (auto p = not_in("timing.dram_row_bit", t.dram_row_bit, 0, 63)) return p;
    for (const auto& [key, cycles] : {std::pair{"timing.dram_rcd", t.dram_rcd}, std::pair{"timing.dram_rp", t.dram_rp},
                                      std::pair{"timing.dram_ras", t.dram_ras}, std::pair{"timing.dram_rc", t.dram_rc},
                                      std::pair{"timing.dram_rrd", t.dram_rrd}}) {
        if (auto p = not_in(key, cycles, 0, 100'000)) return p;
        if (cycles && !rows)
            return GpuProblem{key,
                              "expected with the bits of a bank only; give dram_bank_bits, dram_row_bit and "
                              "dram_mhz, too"};
    }
    if (rows != (t.dram_mhz > 0))
        return GpuProblem{"timing.dram_mhz", "expected together with dram_bank_bits, found one of both"};
    if (rows && (t.dram_mhz < 1 || t.dram_mhz > 1e5))
        return GpuProblem{"timing.dram_mhz", fmt::format("expected 1 to 100000 MHz, found {}", t.dram_mhz)};
    return std::nullopt;
}

std::optional<GpuProblem> find_problem(const Timing& t, const Gpu& gpu) {
    const std::uint32_t sector = gpu.l1().sector_bytes;
    // Slower, one sector would take longer than all that is worth waiting for.
    const double slowest = sector / 1e6;
    for (const auto& [key, rate] : {std::pair{"timing.l1_bytes_per_cycle", t.l1_bytes_per_cycle},
                                    std::pair{"timing.l2_bytes_per_cycle", t.l2_bytes_per_cycle},
                                    std::pair{"timing.l3_bytes_per_cycle", t.l3_bytes_per_cycle},
                                    std::pair{"timing.crossbar_bytes_per_cycle", t.crossbar_bytes_per_cycle}})
        if (rate < slowest)
            return GpuProblem{key, fmt::format("expected at least {} bytes a cycle (10^6 cycles for a sector of {} "
                                               "bytes), found {}",
                                               slowest, sector, rate)};
    if (t.clock_mhz > 1e5)
        return GpuProblem{"timing.clock_mhz", fmt::format("expected at most 100000 MHz, found {}", t.clock_mhz)};
    if (const double rate = t.dram_gb_s * 1e3 / t.clock_mhz / t.dram_channels; rate < slowest)
        return GpuProblem{"timing.dram_gb_s",
                          fmt::format("expected at least {} bytes a cycle of each of {} channels, found {}; give more "
                                      "GB/s or fewer channels",
                                      slowest, t.dram_channels, rate)};
    if (auto p = find_row_problem(t)) return p;
    if (auto p = not_in("timing.schedulers", t.schedulers, 1, 64)) return p;
    if (auto p = not_in("timing.operand_collectors", t.operand_collectors, 0, 32)) return p;
    if (t.operand_collectors > 0 && t.l1_latency < 4)
        return GpuProblem{"timing.l1_latency", fmt::format("expected at least the 4 cycles from issue to the port "
                                                           "with operand_collectors, found {}",
                                                           t.l1_latency)};
    if (auto p = not_in("timing.instruction_interval", t.instruction_interval, 1, 1000)) return p;
    if (auto p = not_in("timing.accesses_in_flight", t.accesses_in_flight, 1, 64)) return p;
    for (const auto& [key, count] :
         {std::pair{"timing.load_queue", t.load_queue}, std::pair{"timing.l1_mshrs", t.l1_mshrs},
          std::pair{"timing.l1_mshr_merges", t.l1_mshr_merges}, std::pair{"timing.l2_mshrs", t.l2_mshrs},
          std::pair{"timing.l2_mshr_merges", t.l2_mshr_merges}})
        if (auto p = not_in(key, count, 1, 65535)) return p;
    if (auto p = not_in("timing.dependent_chains", t.dependent_chains, 1, 64)) return p;
    if (auto p = not_a_power_of_two("timing.l1_banks", t.l1_banks)) return p;
    if (auto p = not_in("timing.l1_banks", t.l1_banks, 1, 32)) return p;
    if (auto p = not_in("timing.tags_per_cycle", t.tags_per_cycle, 1, 64)) return p;
    if (auto p = not_in("timing.empty_request_cycles", t.empty_request_cycles, 0, 1000)) return p;
    for (const auto& [key, cycles] :
         {std::pair{"timing.launch_cycles", t.launch_cycles}, std::pair{"timing.l1_latency", t.l1_latency},
          std::pair{"timing.l2_latency", t.l2_latency}, std::pair{"timing.l2_far_latency", t.l2_far_latency},
          std::pair{"timing.l3_latency", t.l3_latency}, std::pair{"timing.dram_latency", t.dram_latency},
          std::pair{"timing.instruction_latency", t.instruction_latency},
          std::pair{"timing.node_instructions", t.node_instructions},
          std::pair{"timing.triangle_instructions", t.triangle_instructions},
          std::pair{"timing.texel_instructions", t.texel_instructions},
          std::pair{"timing.leaf_instructions", t.leaf_instructions},
          std::pair{"timing.shading_instructions", t.shading_instructions}})
        if (auto p = not_in(key, cycles, 0, 100'000)) return p;
    const bool three = gpu.levels.size() == 3;
    if (three && (t.l3_mshrs == 0 || t.l3_mshr_merges == 0))
        return GpuProblem{"timing.l3_mshrs",
                          "expected registers for the misses of L3, found none; give l3_latency, "
                          "l3_mshrs, l3_mshr_merges and l3_bytes_per_cycle"};
    const std::uint32_t last = three ? t.l3_latency : t.l2_latency;
    if (t.l2_latency < t.l1_latency || last < t.l2_latency || t.l2_far_latency < t.l2_latency || t.dram_latency < last)
        return GpuProblem{"timing.l2_latency",
                          fmt::format("expected l1_latency <= l2_latency <= l2_far_latency, l2_latency <= l3_latency "
                                      "where there is one, and none above dram_latency, found {}, {}, {}, {} and {}; "
                                      "each contains those above it",
                                      t.l1_latency, t.l2_latency, t.l2_far_latency, t.l3_latency, t.dram_latency)};
    if (!three && (t.l2_partitions == 1) != (t.l2_far_latency == t.l2_latency))
        return GpuProblem{
            "timing.l2_far_latency",
            fmt::format("expected another than l2_latency, {}, where there are several l2_partitions, and "
                        "the same where there is one; found {} and {}",
                        t.l2_latency, t.l2_far_latency, t.l2_partitions)};
    // dram_latency is the average over the partitions, so what the far ones add on average is part of it.
    if (const double near = t.dram_latency - static_cast<double>(t.l2_far_latency - t.l2_latency) *
                                                 (t.l2_partitions - 1) / t.l2_partitions;
        !three && near < t.l2_latency)
        return GpuProblem{"timing.dram_latency",
                          fmt::format("expected at least l2_latency and what far partitions add to it on average, "
                                      "found {}",
                                      t.dram_latency)};
    if (three && t.l2_partitions != 1)
        return GpuProblem{"timing.l2_partitions",
                          fmt::format("expected 1 where there is an L3, found {}", t.l2_partitions)};
    if (auto p = not_in("timing.l2_partitions", t.l2_partitions, 1, gpu.levels.back().slices)) return p;
    return not_in("timing.dram_channels", t.dram_channels, 1, 4096);
}

}  // namespace

std::optional<GpuProblem> find_problem(const Gpu& gpu) {
    if (auto p = not_in("sms", gpu.sms, 1, 4096)) return p;
    if (auto p = not_in("warps_per_sm", gpu.warps_per_sm, 1, 1024)) return p;
    if (gpu.max_warps_per_sm && gpu.warps_per_sm > gpu.max_warps_per_sm)
        return GpuProblem{"warps_per_sm", fmt::format("expected at most the {} that an SM holds (max_warps_per_sm), "
                                                      "found {}; make fewer resident",
                                                      gpu.max_warps_per_sm, gpu.warps_per_sm)};
    if (auto p = not_in("warps_per_cta", gpu.warps_per_cta, 1, 64)) return p;
    if (auto p = not_in("l1_per_sm", gpu.l1_per_sm, 1, 8)) return p;
    if (gpu.simd_width != 1 && gpu.simd_width != 2 && gpu.simd_width != 4 && gpu.simd_width != 8 &&
        gpu.simd_width != 16 && gpu.simd_width != 32)
        return GpuProblem{"simd_width", fmt::format("expected 1, 2, 4, 8, 16 or 32, found {}", gpu.simd_width)};
    if (auto p = find_problem(gpu.front_end)) return p;
    if (auto p = not_in("levels", gpu.levels.size(), 2, 3)) return p;
    const CacheGeometry& first = gpu.levels.front();
    for (std::size_t i = 0; i < gpu.levels.size(); ++i) {
        const CacheGeometry& cache = gpu.levels[i];
        const std::string level = fmt::format("l{}", i + 1);
        const bool last = i + 1 == gpu.levels.size();
        const std::uint64_t caches = last ? 1 : i == 0 ? std::uint64_t{gpu.sms} * gpu.l1_per_sm : gpu.sms;
        if (auto p = find_problem(cache, level, caches)) return p;
        if (cache.line_bytes != first.line_bytes)
            return GpuProblem{level + ".line_bytes",
                              fmt::format("expected the line size of L1, {}, found {}; levels of unequal "
                                          "lines are not modelled",
                                          first.line_bytes, cache.line_bytes)};
        if (cache.sector_bytes != first.sector_bytes)
            return GpuProblem{level + ".sector_bytes",
                              fmt::format("expected the sector size of L1, {}, found {}; levels of "
                                          "unequal sectors are not modelled",
                                          first.sector_bytes, cache.sector_bytes)};
    }
    if (gpu.timing) return find_problem(*gpu.timing, gpu);
    return std::nullopt;
}

}  // namespace raycache::cachesim
