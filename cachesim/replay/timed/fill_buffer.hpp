// Sectors on their way to a cache that allocates on fill: no line of the cache is taken for them until their data are
// there. A cache that allocates on miss (SectorTags alone) gives up a line as soon as it asks for the new one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <tuple>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/timed/sector_tags.hpp"

namespace raycache::cachesim {

class FillBuffer {
public:
    /// Room for sectors of that many lines, 1 to 65535.
    FillBuffer(std::uint32_t lines, std::uint32_t sectors_per_line)
        : lines_(lines), tags_(1, lines, sectors_per_line, true) {}

    std::uint32_t lines() const { return lines_; }

    /// The entry whose sector is on its way, or SectorTags::none.
    std::uint32_t find(std::uint64_t line, std::uint32_t sector) const {
        const std::uint32_t entry = tags_.find(line);
        return entry != SectorTags::none && tags_.present(entry, sector) ? entry : SectorTags::none;
    }
    Cycle arrival(std::uint32_t entry, std::uint32_t sector) const { return tags_.arrival(entry, sector); }

    /// The sector, not yet on its way, sets off; `arrival` may be SectorTags::unknown. Returns its entry, below the
    /// number of lines, or SectorTags::none if there is no room.
    std::uint32_t add(std::uint64_t line, std::uint32_t sector, Cycle arrival, Cycle now) {
        std::uint32_t entry = tags_.find(line);
        if (entry == SectorTags::none) entry = tags_.replace(0, line, now);
        if (entry == SectorTags::none) return entry;
        tags_.add(entry, sector, arrival);
        if (arrival != SectorTags::unknown) arrivals_.emplace(arrival, line, sector);
        return entry;
    }
    /// What was unknown is known now.
    void set_arrival(std::uint32_t entry, std::uint32_t sector, Cycle arrival) {
        tags_.set_arrival(entry, sector, arrival);
        arrivals_.emplace(arrival, tags_.line(entry), sector);
    }

    /// Moves what has arrived by `now` into the cache, in order of arrival. `set_of(line)`: the set a line goes to. All
    /// sectors of `cache` come from here, so there is always a line to evict.
    template <class SetOf>
    void drain(Cycle now, SectorTags& cache, const SetOf& set_of) {
        for (; !arrivals_.empty() && std::get<0>(arrivals_.top()) <= now; arrivals_.pop()) {
            const auto [arrival, line, sector] = arrivals_.top();
            tags_.remove(tags_.find(line), sector);
            std::uint32_t entry = cache.find(line);
            if (entry == SectorTags::none) entry = cache.replace(set_of(line), line, arrival);
            cache.add(entry, sector, arrival);
        }
    }

private:
    using Arrival = std::tuple<Cycle, std::uint64_t, std::uint32_t>;  ///< when, line, sector

    std::uint32_t lines_;
    SectorTags tags_;  ///< one set; a line is evicted when no sector of it is on its way
    std::priority_queue<Arrival, std::vector<Arrival>, std::greater<>> arrivals_;
};

/// One that holds as many lines as the cache has registers for sectors on their way; none if it allocates on miss.
inline std::optional<FillBuffer> make_fill_buffer(const CacheGeometry& cache, std::uint32_t registers) {
    if (cache.allocate == Allocate::on_miss) return std::nullopt;
    return FillBuffer(std::min(registers, 65535u), cache.line_bytes / cache.sector_bytes);
}

}  // namespace raycache::cachesim
