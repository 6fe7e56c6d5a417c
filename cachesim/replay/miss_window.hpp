// What the caches of all SMs lack during some rounds, in order of issue: by round, within a round by SM.
//
// A cache never decides who issues next, so an SM may run many rounds before the next SM does, and its caches stay in
// those of the machine that simulates them. Only the shared level sees the SMs one after the other in every round: what
// they ask of it waits here until the last SM has run.
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

    std::size_t rounds() const { return ends_.size(); }

    /// Adds what an SM lacks. SMs come in ascending order, the accesses of one in order of rounds.
    void add(const Lookups& missing) {
        missing_.reserve(missing.count);
        const auto append = [&](const std::vector<std::uint32_t>& from, std::vector<std::uint32_t>& to) {
            std::copy_n(from.begin(), missing.count, to.begin() + static_cast<std::ptrdiff_t>(missing_.count));
        };
        append(missing.lines, missing_.lines);
        append(missing.sectors, missing_.sectors);
        append(missing.accesses, missing_.accesses);
        missing_.count += missing.count;
    }

    /// All that was added, in order of issue. Empties the window. `round_of(access)`: below rounds().
    template <class RoundOf>
    Lookups& take(const RoundOf& round_of) {
        std::fill(ends_.begin(), ends_.end(), 0);
        for (std::size_t i = 0; i < missing_.count; ++i) ++ends_[round_of(missing_.accesses[i])];
        std::uint32_t before = 0;
        for (std::uint32_t& end : ends_) {
            const std::uint32_t here = end;
            end = before;
            before += here;
        }
        sorted_.count = 0;
        sorted_.reserve(missing_.count);
        for (std::size_t i = 0; i < missing_.count; ++i) {
            const std::uint32_t to = ends_[round_of(missing_.accesses[i])]++;
            sorted_.lines[to] = missing_.lines[i];
            sorted_.sectors[to] = missing_.sectors[i];
            sorted_.accesses[to] = missing_.accesses[i];
        }
        sorted_.count = missing_.count;
        missing_.count = 0;
        return sorted_;
    }

private:
    std::vector<std::uint32_t> ends_;  ///< by round, in sorted_
    Lookups missing_, sorted_;
};

}  // namespace raycache::cachesim
