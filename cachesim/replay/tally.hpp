// Whom a request is charged to, and the sums: one group of counters per (ray type, bounce, object kind) that occurs.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/cache/request.hpp"
#include "cachesim/frontend/load_counter.hpp"
#include "cachesim/replay/statistics.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

/// What the members of a group have in common.
struct GroupKey {
    traces::RayType ray{};
    std::uint8_t bounce = 0;
    traces::ObjectKind kind{};
};

class Tally {
public:
    Tally() { first_group_.fill(absent); }

    /// The group of a record's ray for objects of this kind. The record's ray type must be known.
    std::uint16_t group(const traces::Record& record, traces::ObjectKind kind) {
        std::uint16_t& first =
            first_group_[static_cast<unsigned>(record.ray) * (traces::max_bounce + 1) + record.bounce];
        if (first == absent) [[unlikely]] {
            first = static_cast<std::uint16_t>(sums_.size());
            sums_.resize(sums_.size() + traces::object_kinds);
            for (unsigned k = 0; k < traces::object_kinds; ++k)
                keys_.push_back({record.ray, record.bounce, static_cast<traces::ObjectKind>(k)});
        }
        return static_cast<std::uint16_t>(first + static_cast<unsigned>(kind));
    }

    GroupKey key(std::uint16_t group) const { return keys_[group]; }

    /// A ray-start record.
    void add_rays(const traces::Record& record) { sums_[group(record, traces::ObjectKind{})].rays += record.lanes(); }

    /// A warp access of `lanes` lanes and what the front end made of it.
    void add_access(std::uint16_t group, unsigned lanes, unsigned sectors, LoadCount loads) {
        Sums& sums = sums_[group];
        sums.lane_accesses += lanes;
        sums.warp_accesses += 1;
        sums.loads += loads.loads;
        sums.requests += loads.requests;
        sums.sectors += sectors;
    }

    /// What level number `level`, from 0, fetches from below.
    void add_fetched(std::size_t level, std::span<const Request> fetched) {
        for (const Request& r : fetched) add_fetched(level, r.group, r.sectors);
    }
    void add_fetched(std::size_t level, std::uint16_t group, std::uint32_t sectors) {
        sums_[group].fetched[level] += static_cast<unsigned>(std::popcount(sectors));
    }

    /// Sectors that pass every level down to number `level`, from 0, on their way to DRAM.
    void add_passing(std::size_t level, std::uint16_t group, unsigned sectors) {
        for (std::size_t l = 0; l <= level; ++l) sums_[group].fetched[l] += sectors;
    }

    /// Of what a level fetched for requests of these sectors, that which nobody had asked for.
    void add_unasked(std::size_t level, std::span<const Request> fetched, std::span<const std::uint32_t> asked) {
        for (std::size_t i = 0; i < fetched.size(); ++i)
            sums_[fetched[i].group].unasked[level] +=
                static_cast<unsigned>(std::popcount(fetched[i].sectors & ~asked[i]));
    }

    /// The groups in order of ray type and bounce. `levels`: how many there are above DRAM.
    std::vector<RayGroup> groups(std::size_t levels) const;

private:
    static constexpr std::size_t most_levels = 3;
    /// Counters, as far as they do not follow from others.
    struct Sums {
        std::uint64_t rays = 0, lane_accesses = 0, warp_accesses = 0, loads = 0, requests = 0, sectors = 0;
        std::array<std::uint64_t, most_levels> fetched{}, unasked{};  ///< sectors, by level
    };
    Counters counters(const Sums&, traces::ObjectKind, std::size_t levels) const;

    static constexpr std::uint16_t absent = 0xffff;
    std::array<std::uint16_t, traces::ray_types*(traces::max_bounce + 1)> first_group_{};
    std::vector<Sums> sums_;      ///< object_kinds per (ray type, bounce); rays stand in the first of them
    std::vector<GroupKey> keys_;  ///< of each of them
};

}  // namespace raycache::cachesim
