// Whom a request is charged to, and the sums: one group of counters per (ray type, bounce, object kind) that occurs.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/cache/request.hpp"
#include "cachesim/frontend/coalesce.hpp"
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
            first = static_cast<std::uint16_t>(counters_.size());
            counters_.resize(counters_.size() + traces::object_kinds);
            for (unsigned k = 0; k < traces::object_kinds; ++k)
                keys_.push_back({record.ray, record.bounce, static_cast<traces::ObjectKind>(k)});
        }
        return static_cast<std::uint16_t>(first + static_cast<unsigned>(kind));
    }

    GroupKey key(std::uint16_t group) const { return keys_[group]; }

    /// A ray-start record.
    void add_rays(const traces::Record& record) {
        counters_[group(record, traces::ObjectKind{})].rays += record.lanes();
    }

    /// A warp access of `lanes` lanes and what the front end made of it.
    void add_access(std::uint16_t group, unsigned lanes, unsigned sectors) {
        Counters& counters = counters_[group];
        counters.lane_accesses += lanes;
        counters.warp_accesses += 1;
        counters.sectors += sectors;
    }

    void add_l2(std::span<const Request> asked) {
        for (const Request& r : asked) counters_[r.group].l2_sectors += static_cast<unsigned>(std::popcount(r.sectors));
    }

    void add_dram(std::span<const Request> asked) {
        for (const Request& r : asked)
            counters_[r.group].dram_sectors += static_cast<unsigned>(std::popcount(r.sectors));
    }

    /// The groups in order of ray type and bounce, with steps and hits filled in.
    std::vector<RayGroup> groups() const;

private:
    static constexpr std::uint16_t absent = 0xffff;
    std::array<std::uint16_t, traces::ray_types*(traces::max_bounce + 1)> first_group_{};
    std::vector<Counters> counters_;  ///< object_kinds per (ray type, bounce); rays stand in the first of them
    std::vector<GroupKey> keys_;      ///< of each of them
};

}  // namespace raycache::cachesim
