#include "tools/jobs/windows/scaled_findings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace raycache::tools {
namespace {

using cachesim::Findings;
using cachesim::LevelFindings;
using cachesim::MissCounts;

/// part / whole of `of`.
std::uint64_t share(std::uint64_t part, std::uint64_t whole, std::uint64_t of) {
    if (whole == 0) return 0;
    return static_cast<std::uint64_t>(
        std::llround(static_cast<double>(part) / static_cast<double>(whole) * static_cast<double>(of)));
}

MissCounts scaled(const MissCounts& from, std::uint64_t lookups, std::uint64_t misses) {
    MissCounts to;
    to.lookups = lookups;
    to.compulsory = share(from.compulsory, from.misses(), misses);
    to.conflict = std::min(share(from.conflict, from.misses(), misses), misses - to.compulsory);
    to.capacity = misses - to.compulsory - to.conflict;
    to.lucky_hits = share(from.lucky_hits, from.lookups - from.misses(), lookups - misses);
    return to;
}

/// Of what has a depth.
MissCounts steps(const LevelFindings& level) {
    MissCounts sum;
    for (const traces::ObjectKindRole& role : traces::object_kind_roles)
        if (role.is_step) sum += level.by_kind(role.kind);
    return sum;
}

LevelFindings scaled(const LevelFindings& from, std::size_t level, const cachesim::LaunchStatistics& launch) {
    LevelFindings to;
    std::array<MissCounts, traces::object_kinds> by_kind;
    for (const traces::ObjectKindRole& role : traces::object_kind_roles)
        by_kind[static_cast<std::size_t>(role.kind)] = from.by_kind(role.kind);
    for (const cachesim::RayGroup& group : launch.groups) {
        const std::size_t place = LevelFindings::place(group.ray, group.bounce);
        for (const traces::ObjectKindRole& role : traces::object_kind_roles) {
            const auto kind = static_cast<std::size_t>(role.kind);
            const cachesim::LevelCounts& counts = group.by_kind[kind].levels[level];
            MissCounts like = from.by_group[place * traces::object_kinds + kind];
            if (like.misses() == 0) like = by_kind[kind];
            to.of_group(place, role.kind) = scaled(like, counts.sectors, counts.sectors - counts.hits);
        }
    }
    const MissCounts before = steps(from), after = steps(to);
    for (std::size_t d = 0; d < from.by_depth.size(); ++d) {
        const MissCounts& at = from.by_depth[d];
        to.by_depth[d] = {
            share(at.lookups, before.lookups, after.lookups), share(at.compulsory, before.compulsory, after.compulsory),
            share(at.capacity, before.capacity, after.capacity), share(at.conflict, before.conflict, after.conflict),
            share(at.lucky_hits, before.lucky_hits, after.lucky_hits)};
    }
    return to;
}

}  // namespace

Findings scaled_findings(const Findings& of_windows, const cachesim::LaunchStatistics& launch) {
    Findings all;
    for (std::size_t level = 0; level < of_windows.levels.size(); ++level)
        all.levels.push_back(scaled(of_windows.levels[level], level, launch));
    const MissCounts l1 = all.levels.front().all();
    const cachesim::Sharing& from = of_windows.sharing;
    const std::uint64_t hits = from.hits() == 0 ? 0 : l1.lookups - l1.misses();
    all.sharing.same_warp = share(from.same_warp, from.hits(), hits);
    all.sharing.same_cta = std::min(share(from.same_cta, from.hits(), hits), hits - all.sharing.same_warp);
    all.sharing.other_cta = hits - all.sharing.same_warp - all.sharing.same_cta;
    return all;
}

}  // namespace raycache::tools
