// Whom a warp access is charged to, and the sums: one group of counters per (ray type, bounce, region) that occurs.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cachesim/frontend/load_counter.hpp"
#include "cachesim/replay/statistics.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

class Tally {
public:
    explicit Tally(const std::vector<traces::Region>& regions) {
        for (const traces::Region& r : regions) kinds_.push_back(r.kind);
        first_group_.fill(absent);
    }

    /// The group of a record, an access. Its ray type and its region must be known.
    std::uint32_t group(const traces::Record& record) { return first_group(record) + record.region; }

    /// The ray type and the bounce of a group.
    struct RayOf {
        traces::RayType ray{};
        std::uint8_t bounce = 0;
    };
    RayOf ray_of(std::uint32_t group) const { return rays_[group / (kinds_.size() + 1)]; }

    /// A ray-start record.
    void add_rays(const traces::Record& record) { sums_[first_group(record) + kinds_.size()].rays += record.lanes(); }

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

    /// The groups in order of ray type and bounce. `levels`: how many there are above DRAM.
    std::vector<RayGroup> groups(std::size_t levels, const LoadCounter&) const;

private:
    static constexpr std::size_t most_levels = 3;
    /// Counters, as far as they do not follow from others.
    struct Sums {
        std::uint64_t rays = 0, lane_accesses = 0, warp_accesses = 0, requests = 0, sectors = 0, first = 0;
        std::array<std::uint64_t, most_levels> fetched{}, unasked{};  ///< sectors, by level
    };
    Counters counters(const Sums&, std::size_t region, std::size_t levels, const LoadCounter&) const;

    /// Of the record's ray type and bounce: one group for each region, and one for their rays.
    std::uint32_t first_group(const traces::Record& record) {
        std::uint32_t& first =
            first_group_[static_cast<unsigned>(record.ray) * (traces::max_bounce + 1) + record.bounce];
        if (first == absent) [[unlikely]] {
            first = static_cast<std::uint32_t>(sums_.size());
            sums_.resize(sums_.size() + kinds_.size() + 1);
            rays_.push_back({record.ray, record.bounce});
        }
        return first;
    }

    static constexpr std::uint32_t absent = ~std::uint32_t{0};
    std::vector<traces::ObjectKind> kinds_;  ///< by region
    std::array<std::uint32_t, traces::ray_types*(traces::max_bounce + 1)> first_group_{};
    std::vector<Sums> sums_;
    std::vector<RayOf> rays_;  ///< of each kinds_.size() + 1 of them
};

}  // namespace raycache::cachesim
