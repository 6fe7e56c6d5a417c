// The miss-ratio surface of a level of caches: what it would have hit with LRU and any number of ways, for several
// numbers of sets (or ways to find a set) at once, from one replay.
//
// What a level is asked does not depend on its own size, only on what is above it. So one replay with any ways tells
// all: of each number of sets, StackDistance gives the hits of every associativity, cache by cache (each L1 of each SM
// by itself), and the counts of all caches are added up. Equal, at every size, to a replay with caches of that size.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cachesim/analysis/stack_distance.hpp"
#include "cachesim/cache/geometry.hpp"
#include "cachesim/cache/line_map.hpp"
#include "cachesim/replay/request_sink.hpp"

namespace raycache::cachesim {

/// Whether the level's way to find a set works for that number of sets: "ipoly" and "parity" do only for some.
bool index_fits(const CacheGeometry&, std::uint64_t sets);

/// The same cache with that number of sets in each slice, by its own index if that fits, else by xor_fold.
CacheGeometry with_sets(CacheGeometry, std::uint64_t sets);

/// One set of all its lines.
CacheGeometry fully_associative(CacheGeometry);

/// Of all caches of a level together, by number of ways. From a sample of the lines, estimates: every count but `asked`
/// is of the sample then.
struct WaysCurve {
    std::uint64_t asked = 0;            ///< sectors
    double rate = 1;                    ///< share of lines that were followed
    std::uint64_t followed = 0;         ///< sectors asked for of these; at rate 1: `asked`
    std::uint64_t fills = 0;            ///< sectors fetched where nothing ever hits
    std::vector<std::uint64_t> hits;    ///< sectors asked for and found, of 0, 1, 2 … ways; more ways find no more
    std::vector<std::uint64_t> spared;  ///< of `fills`, those that are not fetched; empty: as `hits`

    std::uint64_t hits_of(std::uint64_t ways) const {
        return asked - std::min(asked, scaled(followed - at(hits, ways)));
    }
    /// Sectors fetched from below, those beside the missing ones (CacheGeometry::fill_bytes) included.
    std::uint64_t fetched_of(std::uint64_t ways) const {
        return scaled(fills - at(spared.empty() ? hits : spared, ways));
    }
    /// No number of ways has more hits than this one, and every smaller one has fewer.
    std::uint64_t most_useful_ways() const {
        return static_cast<std::uint64_t>(std::ceil(static_cast<double>(hits.size() - 1) / rate));
    }
    /// Fewer say nothing: a sample has hardly any line as close as that.
    std::uint64_t least_ways() const { return rate < 1 ? fewest_sampled_lines : 1; }

    static constexpr std::uint64_t fewest_sampled_lines = 2048;

private:
    std::uint64_t at(const std::vector<std::uint64_t>& values, std::uint64_t ways) const {
        const auto of_sample =
            rate < 1 ? static_cast<std::uint64_t>(std::ceil(static_cast<double>(ways) * rate)) : ways;
        return values[std::min<std::uint64_t>(of_sample, values.size() - 1)];
    }
    std::uint64_t scaled(std::uint64_t count) const {
        return rate < 1 ? static_cast<std::uint64_t>(std::llround(static_cast<double>(count) / rate)) : count;
    }
};

class LruSurface final : public RequestSink {
public:
    /// Listens to all caches of Gpu::levels[level]. `rows`: the geometries, whose ways are not asked; lines, sectors
    /// and fill_bytes must be those of the level.
    ///
    /// `rate` below 1: only so large a share of all lines is followed, chosen by a hash of their numbers, and distances
    /// count for 1 / rate; the misses found are scaled to all, so that the hit rate is of all that was asked for
    /// (rate-adjusted SHARDS: Waldspurger, Park, Garthwaite, Ahmad 2015, "Efficient MRC construction with SHARDS"). For
    /// rows of one set alone.
    explicit LruSurface(std::size_t level, std::span<const CacheGeometry> rows, double rate = 1);

    bool wants(std::size_t level, std::uint32_t /*sm*/) const override { return level == level_; }
    /// Throws MemoryError where it takes more than memory_limit().
    void served(std::size_t level, std::span<const ServedRequest>) override;

    /// Of each row, of all look-ups so far.
    std::vector<WaysCurve> curves() const;
    std::uint64_t look_ups() const { return look_ups_; }
    /// That were followed, of all caches.
    std::uint64_t lines() const { return lines_; }
    /// Memory that it takes: about 30 bytes a row and 4 more for each line that a cache was ever asked for, and 4 for
    /// each line of the scene.
    std::size_t bytes() const;

private:
    struct Row {
        LineMap map;
        std::size_t sets;
        std::uint32_t fill_sectors;
        DistanceCounts asked, fetched;  ///< `fetched` only where a miss may fetch more than a sector
    };
    /// One cache of the level, with the lines numbered that it was asked for.
    struct Cache {
        std::vector<std::uint32_t> numbers;  ///< by line; 0: none yet, else 1 more
        std::uint32_t count = 0;
        std::vector<StackDistance> rows;
    };
    void follow(std::span<const ServedRequest>);
    Cache& cache(const ServedRequest&);
    void look_up(Row&, StackDistance&, std::uint32_t number, const ServedRequest&);

    void check_memory() const;
    static constexpr std::uint64_t lines_between_checks = std::uint64_t{1} << 16;

    std::size_t level_;
    std::uint32_t line_bytes_, sectors_;
    std::vector<Row> rows_;
    std::vector<std::vector<std::unique_ptr<Cache>>> caches_;  ///< by SM and number in it
    double rate_;
    std::uint64_t look_ups_ = 0, asked_ = 0, lines_ = 0, next_check_ = lines_between_checks;
    std::vector<ServedRequest> sample_;  ///< of a call
    std::vector<Cache*> of_;             ///< of each look-up of a call: its cache, and the line's number in that
    std::vector<std::uint32_t> numbers_;
};

}  // namespace raycache::cachesim
