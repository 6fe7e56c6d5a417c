// The L2 of a CPU's core, and what its L1s ask of it: in order, at Timing::l2_bytes_per_cycle; the first that finds no
// room holds up the others.
#pragma once

#include <cstdint>
#include <vector>

#include "cachesim/replay/timed/memory_side.hpp"
#include "cachesim/replay/timed/ring.hpp"
#include "cachesim/replay/timed/timed_cache.hpp"
#include "cachesim/replay/timed/timed_rules.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"

namespace raycache::cachesim {

class PrivateLevel {
public:
    /// When a sector that an L1 asked for arrives there is known.
    struct Answer {
        Cycle arrival = 0;
        std::uint32_t number = 0;  ///< MissRequest::number
        std::uint8_t l1 = 0;
    };

    /// Of core number `sm`, empty. The rules must outlive this object.
    PrivateLevel(const TimedRules&, std::uint16_t sm);

    /// No request waits.
    bool idle() const { return queue_.empty(); }

    /// What an L1 lacks, in order of time.
    void ask(const MissRequest& request) { queue_.push(request); }

    /// Serves what can be served in this cycle. Adds what it lacks itself, and what it can answer.
    void serve(Cycle now, std::vector<MissRequest>& lacks, std::vector<Answer>& answers);

    /// The arrival of a sector that it lacked is known: so are those in the L1s that wait for it.
    void deliver(const MemorySide::Reply&, std::vector<Answer>& answers);

    const LevelAnswers& counts() const { return counts_; }

private:
    bool serve(const MissRequest&, Cycle now, std::vector<MissRequest>& lacks, std::vector<Answer>& answers);

    const TimedRules& rules_;
    std::uint16_t sm_;
    double cost_;    ///< cycles of a request
    Cycle latency_;  ///< beyond that of L1
    TimedCache cache_;
    Ring<MissRequest> queue_{};
    double free_ = 0;  ///< when the next is served
    LevelAnswers counts_;
};

}  // namespace raycache::cachesim
