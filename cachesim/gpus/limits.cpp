#include "cachesim/gpus/limits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>

#include "cachesim/gpus/key_tables.hpp"
#include "cachesim/gpus/value_check.hpp"
#include "traces/did_you_mean.hpp"

namespace raycache::cachesim {

namespace {

constexpr std::uint64_t most_cache_bytes = std::uint64_t{1} << 40;  // of a cache
constexpr std::uint64_t most_lines = std::uint64_t{1} << 26;

std::optional<GpuProblem> not_in(const std::string& key, std::uint64_t value, std::uint64_t low, std::uint64_t high) {
    if (value >= low && value <= high) return std::nullopt;
    return GpuProblem{key, fmt::format("expected {} to {}, found {}", low, high, value)};
}

/// Whether a member has a value that its row allows.
template <class Struct>
struct Check {
    const std::string key;
    const Struct& of;
    bool may_be_initial;  ///< as the member is where a file lacks the key

    std::optional<GpuProblem> whole(std::uint64_t found, const WholeRange& range) const {
        if (!range.power_of_two || std::has_single_bit(found)) return not_in(key, found, range.low, range.high);
        const bool few = range.high <= 32;
        return GpuProblem{key, few ? fmt::format("expected {}, found {}", range_text(range), found)
                                   : fmt::format("expected a power of two, found {}; nearest below: {}", found,
                                                 std::bit_floor(found))};
    }
    template <class Integer>
    std::optional<GpuProblem> operator()(const WholeValue<Struct, Integer>& v) const {
        if (is_initial(v.member)) return std::nullopt;
        return whole(of.*v.member, v.range);
    }
    std::optional<GpuProblem> operator()(const RealValue<Struct>& v) const {
        const double found = of.*v.member;
        if (is_initial(v.member) || (found >= v.low && found <= v.high)) return std::nullopt;
        return GpuProblem{key, v.low > 0 ? fmt::format("expected {} to {}, found {}", v.low, v.high, found)
                                         : fmt::format("expected at most {}, found {}", v.high, found)};
    }
    std::optional<GpuProblem> operator()(const TextValue<Struct>&) const { return std::nullopt; }
    std::optional<GpuProblem> operator()(const NameValue<Struct>& v) const {
        const auto names = v.names();
        if (std::find(names.begin(), names.end(), of.*v.member) != names.end()) return std::nullopt;
        return GpuProblem{key, fmt::format("expected one of: {}; found \"{}\"{}", fmt::join(names, ", "), of.*v.member,
                                           did_you_mean(of.*v.member, names))};
    }
    template <class Integer>
    std::optional<GpuProblem> operator()(const ListValue<Struct, Integer>& v) const {
        const auto& found = of.*v.member;
        if (found.size() > v.most)
            return GpuProblem{key, fmt::format("expected at most {} {}, found {}", v.most, v.what, found.size())};
        for (const Integer number : found)
            if (auto p = whole(number, v.each)) return p;
        return std::nullopt;
    }
    std::optional<GpuProblem> operator()(const ChoiceValue<Struct>&) const { return std::nullopt; }

private:
    template <class Member>
    bool is_initial(Member member) const {
        static const Struct initial;
        return may_be_initial && of.*member == initial.*member;
    }
};

}  // namespace

template <class Struct>
std::optional<GpuProblem> find_value_problem(const Key<Struct>& key, const Struct& of, const std::string& section) {
    return std::visit(Check<Struct>{section + key.name, of, !key.absent.refused}, key.value);
}
template std::optional<GpuProblem> find_value_problem(const Key<Gpu>&, const Gpu&, const std::string&);
template std::optional<GpuProblem> find_value_problem(const Key<Registers>&, const Registers&, const std::string&);
template std::optional<GpuProblem> find_value_problem(const Key<FrontEnd>&, const FrontEnd&, const std::string&);
template std::optional<GpuProblem> find_value_problem(const Key<CacheGeometry>&, const CacheGeometry&,
                                                      const std::string&);
template std::optional<GpuProblem> find_value_problem(const Key<Timing>&, const Timing&, const std::string&);
template std::optional<GpuProblem> find_value_problem(const Key<RtUnitTiming>&, const RtUnitTiming&,
                                                      const std::string&);

namespace {

/// The first value that its row does not allow.
template <class Struct>
std::optional<GpuProblem> find_value_problem(std::span<const Key<Struct>> keys, const Struct& of,
                                             const std::string& section) {
    for (const Key<Struct>& key : keys)
        if (auto p = find_value_problem(key, of, section)) return p;
    return std::nullopt;
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
    if (cache.slice_hash != SliceHash::ipoly)
        return not_in(level + ".interleave_bytes", cache.interleave_bytes, cache.line_bytes, 1u << 30);
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
    if (auto p = find_value_problem(level_keys(), cache, level + ".")) return p;
    if (cache.sector_bytes > cache.line_bytes)
        return GpuProblem{level + ".sector_bytes", fmt::format("expected at most the line's {} bytes, found {}",
                                                               cache.line_bytes, cache.sector_bytes)};
    if (cache.line_bytes / cache.sector_bytes > 32)
        return GpuProblem{level + ".sector_bytes",
                          fmt::format("expected at most 32 sectors per line, found {} ({} bytes / {} bytes); make "
                                      "sectors larger or lines smaller",
                                      cache.line_bytes / cache.sector_bytes, cache.line_bytes, cache.sector_bytes)};
    if (cache.sets > most_cache_bytes / cache.line_bytes / cache.ways / cache.slices)
        return GpuProblem{level + ".sets",
                          fmt::format("expected slices x sets x ways x line of at most 2^40 bytes, found "
                                      "{} x {} x {} x {}; check the unit",
                                      cache.slices, cache.sets, cache.ways, cache.line_bytes)};
    if (cache.lines() > most_lines / caches)
        return GpuProblem{level + ".sets",
                          fmt::format("expected at most 2^26 lines in all {0} cache{1} together, found {2} x {3} x {4} "
                                      "in each; make the cache smaller",
                                      caches, caches == 1 ? "" : "s", cache.slices, cache.sets, cache.ways)};
    if (cache.fill_bytes)
        if (auto p = not_in(level + ".fill_bytes", cache.fill_bytes, cache.sector_bytes, cache.line_bytes)) return p;
    return find_hash_problem(cache, level);
}

/// Open rows of DRAM.
std::optional<GpuProblem> find_row_problem(const Timing& t) {
    const bool rows = !t.dram_bank_bits.empty();
    for (const auto& [key, cycles] : {std::pair{"timing.dram_rcd", t.dram_rcd}, std::pair{"timing.dram_rp", t.dram_rp},
                                      std::pair{"timing.dram_ras", t.dram_ras}, std::pair{"timing.dram_rc", t.dram_rc},
                                      std::pair{"timing.dram_rrd", t.dram_rrd}}) {
        if (cycles && !rows)
            return GpuProblem{key,
                              "expected with the bits of a bank only; give dram_bank_bits, dram_row_bit and "
                              "dram_mhz, too"};
    }
    if (rows != (t.dram_mhz > 0))
        return GpuProblem{"timing.dram_mhz", "expected together with dram_bank_bits, found one of both"};
    return std::nullopt;
}

std::optional<GpuProblem> find_problem(const Timing& t, const Gpu& gpu) {
    if (auto p = find_value_problem(timing_keys(), t, "timing.")) return p;
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
    if (const double rate = t.dram_gb_s * 1e3 / t.clock_mhz / t.dram_channels; rate < slowest)
        return GpuProblem{"timing.dram_gb_s",
                          fmt::format("expected at least {} bytes a cycle of each of {} channels, found {}; give more "
                                      "GB/s or fewer channels",
                                      slowest, t.dram_channels, rate)};
    if (auto p = find_row_problem(t)) return p;
    if (t.operand_collectors > 0 && t.l1_latency < 4)
        return GpuProblem{"timing.l1_latency", fmt::format("expected at least the 4 cycles from issue to the port "
                                                           "with operand_collectors, found {}",
                                                           t.l1_latency)};
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
    return not_in("timing.l2_partitions", t.l2_partitions, 1, gpu.levels.back().slices);
}

/// What an RT unit asks of the other keys.
std::optional<GpuProblem> find_traversal_problem(const Gpu& gpu) {
    if (gpu.rt_unit)
        if (auto p = find_value_problem(rt_unit_keys(), *gpu.rt_unit, "rt_unit.")) return p;
    if (gpu.traversal == Traversal::software) return std::nullopt;
    if (!gpu.rt_unit)
        return GpuProblem{"traversal",
                          "expected a table [rt_unit] for \"rt_unit\", found none; add one, or let software traverse"};
    if (gpu.timing && (gpu.timing->operand_collectors > 0 || gpu.timing->accesses_in_flight > 1))
        return GpuProblem{"traversal",
                          fmt::format("expected \"software\" with operand_collectors or several accesses_in_flight, "
                                      "found \"rt_unit\" with {} and {}; an RT unit is not modelled with them",
                                      gpu.timing->operand_collectors, gpu.timing->accesses_in_flight)};
    return std::nullopt;
}

}  // namespace

std::optional<GpuProblem> find_problem(const Gpu& gpu) {
    if (auto p = find_value_problem(chip_keys(), gpu, "")) return p;
    if (gpu.max_warps_per_sm && gpu.warps_per_sm > gpu.max_warps_per_sm)
        return GpuProblem{"warps_per_sm", fmt::format("expected at most the {} that an SM holds (max_warps_per_sm), "
                                                      "found {}; make fewer resident",
                                                      gpu.max_warps_per_sm, gpu.warps_per_sm)};
    if (auto p = find_value_problem(front_end_keys(), gpu.front_end, "front_end.")) return p;
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
    if (gpu.timing)
        if (auto p = find_problem(*gpu.timing, gpu)) return p;
    return find_traversal_problem(gpu);
}

}  // namespace raycache::cachesim
