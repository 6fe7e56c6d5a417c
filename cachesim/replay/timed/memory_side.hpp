// Below the L1s, in time: crossbar, L2 slices and DRAM channels, each a server with a rate and a next-free time.
//
// Requests cross from SMs to slices, replies from slices to SMs (cachesim/replay/timed/crossbar.hpp). The slice looks a
// request up; data of a hit are ready to go back after l2_latency - l1_latency, those of a miss after the slice's DRAM
// channel was free and dram_latency - l2_latency more. A slice whose registers for misses are all taken, or merge no
// more, takes no request until one is free.
#pragma once

#include <cstdint>
#include <queue>
#include <span>
#include <vector>

#include "cachesim/cache/line_map.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/timed/crossbar.hpp"
#include "cachesim/replay/timed/fill_buffer.hpp"
#include "cachesim/replay/timed/sector_tags.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"

namespace raycache::cachesim {

/// A sector that an L1 lacks.
struct MissRequest {
    Cycle time = 0;  ///< of the look-up in L1
    std::uint64_t line = 0;
    std::uint32_t entry = 0;  ///< of the L1, to be told when the sector arrives
    std::uint16_t sm = 0;
    std::uint8_t sector = 0;
    std::uint8_t l1 = 0;  ///< which L1 of the SM
};

/// What may be switched off, to see what it costs.
struct Idealised {
    bool perfect_l1 = false;          ///< every look-up in L1 hits
    bool perfect_l2 = false;          ///< every look-up in L2 hits
    bool infinite_bandwidth = false;  ///< no port, crossbar, slice or channel is ever taken
    bool no_added_latency = false;    ///< L2 and DRAM answer as fast as L1
    bool full_warps = false;          ///< consecutive visits of a warp to objects of one kind fill up its lanes
};

class MemorySide {
public:
    MemorySide(const Gpu&, const Idealised&);

    /// No reply to a request at `time` is there before time + this.
    Cycle shortest_answer() const { return shortest_; }

    /// Of one SM in order of time.
    void request(const MissRequest&);

    struct Reply {
        Cycle ready = 0;           ///< at the slice; when delivered: at the SM
        std::uint32_t output = 0;  ///< the SM
        std::uint32_t entry = 0;
        std::uint8_t sector = 0, l1 = 0;
    };
    /// Calls deliver(reply) for every reply that reaches the head of its slice before `end`, in order of that time.
    /// Call before the SMs run to `end`.
    template <class Deliver>
    void run_replies(Cycle end, Deliver&& deliver) {
        to_sms_.run(end, [&](Reply reply, Cycle arrived) {
            reply.ready = arrived;
            deliver(reply);
        });
    }
    /// Lets requests before `end` reach their slices. Call after all SMs ran to `end`.
    void run_requests(Cycle end);

    bool idle() const { return to_slices_.empty() && to_sms_.empty(); }

    const LevelAnswers& l2() const { return answers_; }
    std::uint64_t dram_sectors() const { return dram_sectors_; }
    double dram_cycles_per_sector() const { return dram_cost_; }
    double slice_cycles_per_sector() const { return slice_cost_; }
    double crossbar_cycles_per_sector() const { return crossbar_cost_; }

private:
    struct Packet {
        Cycle ready = 0;
        std::uint32_t output = 0;  ///< the slice
        MissRequest miss;
    };

    void serve(const Packet&, Cycle);
    Cycle look_up(std::uint64_t line, std::uint32_t sector, std::uint32_t slice, Cycle time);
    Cycle read_dram(std::uint32_t slice, Cycle time);
    /// Number of the first entry of a slice's fill buffer.
    std::uint32_t first_fill(std::uint32_t slice) const {
        return static_cast<std::uint32_t>(geometry_.slices * geometry_.sets * geometry_.ways +
                                          std::uint64_t{slice} * fills_[slice].lines());
    }

    CacheGeometry geometry_;
    Timing timing_;
    bool perfect_;
    LineMap map_;
    SectorTags tags_;
    std::uint32_t sectors_per_line_, sectors_per_fill_;
    std::uint32_t sms_, slices_per_channel_;
    Cycle shortest_, dram_extra_, far_extra_;
    double crossbar_cost_, slice_cost_, dram_cost_;  ///< cycles per sector
    std::vector<double> channel_;                    ///< when each is free
    std::vector<std::uint16_t> merges_;              ///< of each sector of each entry
    /// Allocate::on_fill: of each slice; their entries are numbered behind those of tags_.
    std::vector<FillBuffer> fills_;
    /// Arrivals of the sectors on their way, of each slice: how many miss-status holding registers are taken.
    std::vector<std::priority_queue<Cycle, std::vector<Cycle>, std::greater<>>> under_way_;
    Crossbar<Packet> to_slices_;
    Crossbar<Reply> to_sms_;
    std::vector<double> sent_;  ///< when the port of each SM is free for its next request
    LevelAnswers answers_;
    std::uint64_t dram_sectors_ = 0;
};

}  // namespace raycache::cachesim
