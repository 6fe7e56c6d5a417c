// What the caches of all SMs lack during some rounds, in order of issue: by round, within a round by SM.
//
// A cache never decides who issues next, so an SM may run many rounds before the next SM does, and its caches stay in
// those of the machine that simulates them. Only the shared level sees the SMs one after the other in every round: what
// they ask of it is put in order when the last SM has run.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cachesim/cache/lookups.hpp"

namespace raycache::cachesim {

class MissWindow {
public:
    explicit MissWindow(std::size_t rounds) : ends_(rounds) {}

    /// All that the SMs lack, in order of issue. `missing_of(sm)`: what SM number `sm` of `sms` lacks, in order of
    /// rounds but for look-ups of different rounds; `round_of(access)`: below rounds.
    template <class MissingOf, class RoundOf>
    Lookups& sort(std::size_t sms, const MissingOf& missing_of, const RoundOf& round_of) {
        std::fill(ends_.begin(), ends_.end(), 0);
        std::size_t count = 0;
        for (std::size_t sm = 0; sm < sms; ++sm) {
            const Lookups& missing = missing_of(sm);
            for (std::size_t i = 0; i < missing.count; ++i) ++ends_[round_of(missing.accesses[i])];
            count += missing.count;
        }
        std::uint32_t before = 0;
        for (std::uint32_t& end : ends_) {
            const std::uint32_t here = end;
            end = before;
            before += here;
        }
        sorted_.count = 0;
        sorted_.reserve(count);
        for (std::size_t sm = 0; sm < sms; ++sm) {
            const Lookups& missing = missing_of(sm);
            for (std::size_t i = 0; i < missing.count; ++i) {
                const std::uint32_t to = ends_[round_of(missing.accesses[i])]++;
                sorted_.lines[to] = missing.lines[i];
                sorted_.sectors[to] = missing.sectors[i];
                sorted_.accesses[to] = missing.accesses[i];
            }
        }
        sorted_.count = count;
        return sorted_;
    }

private:
    std::vector<std::uint32_t> ends_;  ///< by round, in sorted_
    Lookups sorted_;
};

}  // namespace raycache::cachesim
