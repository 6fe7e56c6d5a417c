// Sectored set-associative caches of equal geometry: the L1s of an SM, or the one L2 of a GPU.
//
// A look-up of a line that is absent evicts a line and fetches the wanted sectors only; a look-up of a line that is
// present but lacks wanted sectors (a sector miss) fetches just these. Fill can add neighbours to what is fetched. What
// is fetched is there for the next look-up.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cachesim/cache/fill.hpp"
#include "cachesim/cache/geometry.hpp"
#include "cachesim/cache/line_fills.hpp"

namespace raycache::cachesim {

/// Some caches of a level, neighbours in their numbering.
struct CacheRange {
    CacheRange(unsigned n, unsigned from = 0) : count(n), first(from) {}  // NOLINT(google-explicit-constructor)

    unsigned count, first;
};

/// Looks up runs of requests, so that the call through the table of the policy costs little per look-up.
class Level {
public:
    virtual ~Level() = default;

    /// Looks up `count` lines in order, each in its set (numbered through all slices of all these caches), and
    /// leaves in `sectors` those that it fetched: the wanted ones that were missing, and what Fill adds.
    virtual void process(const std::uint32_t* sets, const std::uint32_t* lines, std::uint32_t* sectors,
                         std::size_t count) = 0;

    /// Before the first look-up: fills() will be asked for. Not where nobody asks, as it costs some caches time.
    virtual void count_fills() {}
    /// Of all look-ups so far.
    virtual LineFills fills() const = 0;
};

/// `Policy` holds tags and sectors of all sets and decides what to evict. It offers
///     Policy(sets, ways, sectors_per_line, …)                  all sets empty; `more` comes last
///     std::uint32_t access(set, line, sectors)                 the sectors that were missing; now present
///     void prefetch(set, line) const                           a hint, changes nothing
///     LineFills fills() const                                  so far
template <class Policy>
class LevelWith final : public Level {
public:
    template <class... More>
    LevelWith(const CacheGeometry& geometry, CacheRange caches, More... more)
        : fill_(geometry),
          policy_(geometry.slices * geometry.sets * caches.count, geometry.ways,
                  geometry.line_bytes / geometry.sector_bytes, more...) {}

    void process(const std::uint32_t* sets, const std::uint32_t* lines, std::uint32_t* sectors,
                 std::size_t count) override {
        constexpr std::size_t ahead = 32;  // so that their memory is on its way
        for (std::size_t i = 0; i < std::min(ahead, count); ++i) policy_.prefetch(sets[i], lines[i]);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t later = std::min(i + ahead, count - 1);
            policy_.prefetch(sets[later], lines[later]);
            const std::uint32_t missing = policy_.access(sets[i], lines[i], sectors[i]);
            sectors[i] = missing;
            // Looked up again, the line is the newest already: nothing but its sectors changes.
            if (fill_.widens() && missing) sectors[i] |= policy_.access(sets[i], lines[i], fill_.pieces(missing));
        }
    }

    LineFills fills() const override { return policy_.fills(); }

private:
    Fill fill_;
    Policy policy_;
};

}  // namespace raycache::cachesim
