// Sums, one for each group of GroupNumbers. Whole numbers: whoever adds them up, in whichever order, gets the same.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cachesim/frontend/load_counter.hpp"
#include "cachesim/replay/group_numbers.hpp"
#include "cachesim/replay/statistics.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

class Tally {
public:
    /// `per_ray`: GroupNumbers::per_ray().
    explicit Tally(std::size_t per_ray) : per_ray_(per_ray) {}

    /// Groups below this number can be added to from now on: GroupNumbers::size(), after whose groups were asked for.
    void make_room(std::size_t groups) {
        if (groups > sums_.size()) [[unlikely]]
            sums_.resize(groups);
    }

    /// A ray-start record, whose group there need be no room for.
    void add_rays(const traces::Record& record, BatchGroups& groups) {
        const std::size_t group = groups.first(record) + per_ray_ - 1;
        make_room(group + 1);
        sums_[group].rays += record.lanes();
    }

    /// A warp access of `lanes` lanes and distinct sectors.
    void add_access(std::uint32_t group, unsigned lanes, unsigned sectors) {
        Sums& sums = sums_[group];
        sums.lane_accesses += lanes;
        sums.warp_accesses += 1;
        sums.sectors += sectors;
    }
    /// What its loads ask for, where that does not follow from its sectors (LoadCounter).
    void add_requests(std::uint32_t group, std::uint32_t requests) { sums_[group].requests += requests; }

    /// What level number `level`, from 0, fetches from below.
    void add_fetched(std::size_t level, std::uint32_t group, std::uint32_t sectors) {
        sums_[group].fetched[level] += static_cast<unsigned>(std::popcount(sectors));
    }

    /// Sectors that pass every level down to number `level`, from 0, on their way to DRAM.
    void add_passing(std::size_t level, std::uint32_t group, unsigned sectors) {
        for (std::size_t l = 0; l <= level; ++l) sums_[group].fetched[l] += sectors;
    }

    /// Of what comes from DRAM, sectors that no cache of the GPU had held before.
    void add_first(std::uint32_t group, std::uint32_t sectors) {
        sums_[group].first += static_cast<unsigned>(std::popcount(sectors));
    }

    /// Of what a level fetched, that which nobody had asked for.
    void add_unasked(std::size_t level, std::uint32_t group, std::uint32_t sectors) {
        sums_[group].unasked[level] += static_cast<unsigned>(std::popcount(sectors));
    }

    Tally& operator+=(const Tally&);

    /// The groups of these batches together, in order of ray type and bounce. `kinds`: by region; `levels`: how many
    /// there are above DRAM.
    std::vector<RayGroup> groups(const std::vector<const BatchGroups*>& batches,
                                 const std::vector<traces::ObjectKind>& kinds, std::size_t levels,
                                 const LoadCounter&) const;

private:
    /// Counters, as far as they do not follow from others.
    struct Sums {
        std::uint64_t rays = 0, lane_accesses = 0, warp_accesses = 0, requests = 0, sectors = 0, first = 0;
        std::array<std::uint64_t, most_levels> fetched{}, unasked{};  ///< sectors, by level

        Sums& operator+=(const Sums&);
    };
    static Counters counters(const Sums&, traces::ObjectKind, std::size_t region, std::size_t levels,
                             const LoadCounter&);

    std::size_t per_ray_;
    std::vector<Sums> sums_;  ///< by group
};

}  // namespace raycache::cachesim
