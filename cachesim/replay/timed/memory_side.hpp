// Below the SMs, in time: crossbar, slices of the last cache level and DRAM channels, each a server with a rate and a
// next-free time.
//
// Requests cross from SMs to slices, replies from slices to SMs (cachesim/replay/timed/crossbar.hpp). The slice looks a
// request up; data of a hit are ready to go back after the level's latency less that of L1, those of a miss after a
// DRAM channel was free and the latency of DRAM less that of the level more; those of a far partition after what that
// adds. A slice whose registers for misses are all taken looks up no more until one is free; one whose request can
// merge no more does not until the data are there, and then finds them. Slice s has the channels from s * channels /
// slices on, those below (s + 1) * channels / slices or at least one, if one number divides the other; else lines are
// dealt out among all channels.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cachesim/cache/line_map.hpp"
#include "cachesim/replay/timed/crossbar.hpp"
#include "cachesim/replay/timed/cycle.hpp"
#include "cachesim/replay/timed/dram.hpp"
#include "cachesim/replay/timed/dram_sink.hpp"
#include "cachesim/replay/timed/timed_cache.hpp"
#include "cachesim/replay/timed/timed_rules.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"

namespace raycache::cachesim {

/// A sector that an SM lacks.
struct MissRequest {
    Cycle time = 0;            ///< of the look-up that missed
    std::uint64_t line = 0;    ///< byte address / line size
    std::uint32_t id = 0;      ///< LineIds
    std::uint32_t number = 0;  ///< of the register to be told when the sector arrives
    std::uint16_t sm = 0;
    std::uint8_t sector = 0;
    std::uint8_t l1 = 0;  ///< which L1 of the SM
};

class MemorySide {
public:
    explicit MemorySide(const TimedRules&);

    /// No reply to a request at `time` is there before time + this: so long can SMs run without hearing of each other.
    Cycle window() const { return window_; }

    /// Of one SM in order of time.
    void request(const MissRequest&);

    struct Reply {
        Cycle ready = 0;           ///< at the slice; when delivered: at the SM
        std::uint32_t output = 0;  ///< the SM
        std::uint32_t number = 0;  ///< as in the request
        std::uint8_t l1 = 0;
    };
    /// Calls deliver(reply) for every reply that reaches the head of its slice in these cycles, in order of that time.
    /// Call before the SMs run them.
    template <class Deliver>
    void run_replies(Cycle begin, Cycle end, Deliver&& deliver) {
        to_sms_.run(begin, end, [&](Reply reply, double arrived) {
            reply.ready = static_cast<Cycle>(std::ceil(arrived));
            deliver(reply);
        });
    }
    /// Lets requests of these cycles reach their slices. Call after all SMs ran them.
    void run_requests(Cycle begin, Cycle end);

    /// Before this cycle nothing happens here unless an SM asks.
    Cycle next_time() const { return std::min(to_slices_.next_time(), to_sms_.next_time()); }

    bool idle() const { return to_slices_.empty() && to_sms_.empty(); }

    const LevelAnswers& answers() const { return answers_; }
    std::uint64_t dram_sectors() const { return dram_sectors_; }
    /// The sink, or null, hears of every sector read from DRAM. It must outlive this object.
    void observe(DramSink* sink) { sink_ = sink; }
    /// Cycles that registers for misses were taken, of all slices together.
    Cycle waiting() const { return waiting_; }
    double dram_cycles_per_sector() const { return dram_.cost(); }
    double slice_cycles_per_sector() const { return slice_cost_; }
    double crossbar_cycles_per_sector() const { return crossbar_cost_; }

private:
    struct Packet {
        Cycle ready = 0;
        std::uint32_t output = 0;  ///< the slice
        std::uint32_t set = 0;     ///< of it
        std::uint32_t id = 0, number = 0;
        std::uint16_t sm = 0;
        std::uint8_t sector = 0, l1 = 0;
    };

    void serve(const Packet&, double arrived);
    Cycle look_up(const Packet&, Cycle);
    Cycle read_dram(const Packet&, std::uint32_t sector, Cycle);
    void hold_up(std::uint32_t slice, Cycle until) {
        slice_free_[slice] = std::max(slice_free_[slice], static_cast<double>(until) + slice_cost_);
    }
    std::size_t channel_of(const Packet&) const;

    const TimedRules& rules_;
    LevelTiming timing_;  ///< of the level
    std::uint32_t slice_count_, sectors_per_fill_;
    bool by_inputs_;  ///< CrossbarQueues::inputs
    std::vector<TimedCache> slices_;
    Cycle level_extra_, far_extra_;  ///< latencies beyond that of the level above
    Cycle window_;
    double crossbar_cost_, slice_cost_;  ///< cycles per sector
    Dram dram_;
    Crossbar<Packet> to_slices_;
    Crossbar<Reply> to_sms_;
    std::vector<double> sent_;        ///< when the port of each SM is free for its next request
    std::vector<double> slice_free_;  ///< when each slice looks up its next request
    LevelAnswers answers_;
    std::uint64_t dram_sectors_ = 0;
    Cycle waiting_ = 0;
    DramSink* sink_ = nullptr;
};

}  // namespace raycache::cachesim
