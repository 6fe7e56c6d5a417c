// Two models that simulate no cache: distinct sectors, and reuse distances. Both take the warps of a launch in waves of
// as many as a GPU holds at once, a wave to its end before the next begins: CTA c on SM c mod sms, SMs in turn,
// resident warps of each in turn, one access a turn.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/analysis/stack_distance.hpp"
#include "cachesim/cache/line_ids.hpp"
#include "cachesim/frontend/coalesce.hpp"
#include "cachesim/frontend/load_counter.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "tools/bench/tradeoff/demand.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::bench {

using Wave = std::vector<std::shared_ptr<const traces::WarpTrace>>;

/// The warps of one wave as look-ups, in the order in which a GPU would issue them.
class Waves {
public:
    Waves(const cachesim::Gpu&, const std::vector<traces::Region>&);

    /// Calls look_up(sm, line, sectors) for what the warps access, and counts rays and accesses where `counted`.
    /// At most a wave of warps.
    template <class LookUp>
    void run(const Wave& warps, bool counted, Demand& counts, LookUp&& look_up) {
        place(warps);
        for (bool busy = true; busy;) {
            busy = false;
            for (std::uint32_t sm = 0; sm < sms_; ++sm) {
                if (!issue(sm, counted, counts)) continue;
                busy = true;
                for (std::size_t i = 0; i < found_.count; ++i) look_up(sm, found_.lines[i], found_.sectors[i]);
            }
        }
    }

private:
    struct Warp {
        const traces::Record *next, *end;
        const std::uint32_t* elements;
    };
    void place(const Wave&);
    /// The next access of the SM becomes found_; false if there is none.
    bool issue(std::uint32_t sm, bool counted, Demand&);

    std::uint32_t sms_, warps_per_cta_;
    std::vector<traces::ObjectKind> kinds_;
    cachesim::LineIds ids_;
    cachesim::Coalescer coalesce_;
    cachesim::LoadCounter loads_;
    cachesim::Lookups found_;
    std::vector<std::vector<Warp>> warps_;  ///< by SM
    std::vector<std::size_t> turn_;
};

/// Distinct sectors: of each warp access (what L1 is asked for), of what an SM accesses in a wave (L2), of what all do
/// (DRAM). As if caches held exactly a wave, and nothing of the one before.
class UniqueSectors {
public:
    UniqueSectors(const cachesim::Gpu&, const std::vector<traces::Region>&);
    void wave(const Wave&, bool counted);
    const Demand& counts() const { return counts_; }

private:
    struct Seen {
        std::uint32_t wave = 0, sectors = 0;
    };
    /// How many of them are new in this wave.
    std::uint32_t add(std::vector<Seen>&, std::uint32_t line, std::uint32_t sectors) const;

    Waves waves_;
    std::vector<std::vector<Seen>> seen_;  ///< by SM, then all together; each by line
    std::uint32_t wave_ = 0;
    Demand counts_;
};

/// L1s and the last cache as fully associative ones, by stack distance.
class ReuseDistances {
public:
    ReuseDistances(const cachesim::Gpu&, const std::vector<traces::Region>&);
    void wave(const Wave&, bool counted);
    const Demand& counts() const { return counts_; }

private:
    Waves waves_;
    std::vector<cachesim::StackDistance> l1_;  ///< by SM
    cachesim::StackDistance l2_;
    std::uint64_t l1_lines_, l2_lines_;
    Demand counts_;
};

}  // namespace raycache::bench
