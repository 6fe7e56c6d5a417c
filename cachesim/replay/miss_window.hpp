// What the L1s of all SMs lack during some rounds, in order of issue: by round, within a round by SM.
//
// A cache never decides who issues next, so an SM may run many rounds before the next SM does, and its L1s stay in the
// caches of the machine that simulates them. Only the shared level sees the SMs one after the other in every round:
// what they ask of it waits here until the last SM has run.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cachesim/cache/request.hpp"

namespace raycache::cachesim {

class MissWindow {
public:
    /// At most 2^16 rounds. `most`: requests of one warp access at most.
    MissWindow(std::size_t rounds, std::size_t most) : most_(most), rounds_(rounds) {}

    std::size_t rounds() const { return rounds_.size(); }

    /// Makes room for one warp access in this round. Within a round, SMs come in ascending order.
    void reserve(std::size_t round) {
        Round& r = rounds_[round];
        if (r.requests.size() - r.used < most_) [[unlikely]]
            r.requests.resize(2 * r.used + most_);
    }

    /// Adds what an L1 lacks of a request; nothing if that is no sector. There must be room.
    void add(std::size_t round, const Request& missing) {
        Round& r = rounds_[round];
        r.requests[r.used] = missing;
        r.used += missing.sectors != 0;
    }

    /// What was added to a round, free to change. Empties it.
    std::span<Request> take(std::size_t round) {
        Round& r = rounds_[round];
        const std::span<Request> requests(r.requests.data(), r.used);
        r.used = 0;
        return requests;
    }

private:
    struct Round {
        std::vector<Request> requests;
        std::size_t used = 0;
    };
    std::size_t most_;
    std::vector<Round> rounds_;
};

}  // namespace raycache::cachesim
