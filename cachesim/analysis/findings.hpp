// What an explanation counts beside the traffic itself: plain numbers, added up over launches in any order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

/// Sector look-ups of some caches, and what became of them. Every miss is in one class (Hill 1987).
struct MissCounts {
    std::uint64_t lookups = 0;
    std::uint64_t compulsory = 0;  ///< this cache had never held the sector
    std::uint64_t capacity = 0;    ///< a fully associative LRU cache of as many lines, asked the same, lacks it too
    std::uint64_t conflict = 0;    ///< that cache would have had it: lost to sets, hash or policy
    std::uint64_t lucky_hits = 0;  ///< hits where that cache would have missed: kept thanks to sets, hash or policy

    std::uint64_t misses() const { return compulsory + capacity + conflict; }
    MissCounts& operator+=(const MissCounts&);
    bool operator==(const MissCounts&) const = default;
};

/// All caches of one level together. Each cut adds up to the whole, except by_depth: not everything
/// has a depth.
struct LevelFindings {
    static constexpr unsigned bounces = traces::max_bounce + 1;
    static constexpr unsigned depths = 255;
    static constexpr unsigned rays = traces::ray_types * bounces;

    /// Of the rays of a type and bounce, on behalf of objects of a kind: index place() * object_kinds + kind.
    std::vector<MissCounts> by_group = std::vector<MissCounts>(std::size_t{rays} * traces::object_kinds);
    std::vector<MissCounts> by_depth = std::vector<MissCounts>(depths);  ///< index: ElementDepth

    static constexpr std::size_t place(traces::RayType ray, unsigned bounce) {
        return static_cast<std::size_t>(ray) * bounces + bounce;
    }
    MissCounts& of_group(std::size_t place, traces::ObjectKind kind) {
        return by_group[place * traces::object_kinds + static_cast<std::size_t>(kind)];
    }
    MissCounts by_ray(std::size_t place) const;
    MissCounts by_kind(traces::ObjectKind) const;
    MissCounts all() const;
    LevelFindings& operator+=(const LevelFindings&);
    bool operator==(const LevelFindings&) const = default;
};

/// Whose sector an L1 hit found: that of the warp which fetched it into this L1 last.
struct Sharing {
    std::uint64_t same_warp = 0;
    std::uint64_t same_cta = 0;   ///< another warp of the same CTA
    std::uint64_t other_cta = 0;  ///< a warp of another CTA, perhaps one that has ended

    std::uint64_t hits() const { return same_warp + same_cta + other_cta; }
    Sharing& operator+=(const Sharing&);
    bool operator==(const Sharing&) const = default;
};

struct Findings {
    std::vector<LevelFindings> levels;  ///< from L1 to the last before DRAM
    Sharing sharing;

    /// Both of the same GPU, or this one empty.
    Findings& operator+=(const Findings&);
    bool operator==(const Findings&) const = default;
};

}  // namespace raycache::cachesim
