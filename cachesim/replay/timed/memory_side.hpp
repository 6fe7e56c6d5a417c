// Below the L1s, in time: crossbar, L2 slices and DRAM channels, each a server with a rate and a next-free time.
//
// A request leaves its SM when the SM's port and the slice's port of the crossbar are free; the port stays taken until
// then, so what comes behind waits (head-of-line blocking). The slice looks it up; data of a hit are on their way after
// l2_latency - l1_latency, those of a miss after the DRAM channel of the slice was free and dram_latency - l2_latency
// more. Replies cross the other half of the crossbar in order of readiness.
#pragma once

#include <cstdint>
#include <queue>
#include <span>
#include <vector>

#include "cachesim/cache/line_map.hpp"
#include "cachesim/gpus/gpu.hpp"
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

    /// Takes requests in order of time, ties in order of SM.
    void request(const MissRequest&);

    struct Reply {
        Cycle ready = 0;  ///< at the slice; after next_reply(): at the SM
        std::uint64_t order = 0;
        std::uint32_t slice = 0, entry = 0;
        std::uint16_t sm = 0;
        std::uint8_t sector = 0, l1 = 0;
        bool operator>(const Reply& other) const {
            return ready != other.ready ? ready > other.ready : order > other.order;
        }
    };
    /// The next reply that is ready at its slice before `end`, carried to its SM; false if there is none.
    bool next_reply(Cycle end, Reply&);
    bool idle() const { return replies_.empty(); }

    const LevelAnswers& l2() const { return answers_; }
    std::uint64_t dram_sectors() const { return dram_sectors_; }
    double dram_cycles_per_sector() const { return dram_cost_; }
    double slice_cycles_per_sector() const { return slice_cost_; }
    double crossbar_cycles_per_sector() const { return crossbar_cost_; }

private:
    Cycle look_up(std::uint64_t line, std::uint32_t sector, std::uint32_t slice, Cycle time);
    Cycle read_dram(std::uint32_t slice, Cycle time);

    CacheGeometry geometry_;
    Timing timing_;
    bool perfect_;
    LineMap map_;
    SectorTags tags_;
    std::uint32_t sectors_per_line_, sectors_per_fill_;
    std::uint32_t sms_, slices_per_channel_;
    Cycle shortest_, dram_extra_, far_extra_;
    double crossbar_cost_, slice_cost_, dram_cost_;                        ///< cycles per sector
    std::vector<double> sm_out_, sm_in_, slice_in_, slice_out_, channel_;  ///< when each is free
    std::vector<std::uint16_t> merges_;                                    ///< of each sector of each entry
    /// Arrivals of the sectors on their way, of each slice: how many miss-status holding registers are taken.
    std::vector<std::priority_queue<Cycle, std::vector<Cycle>, std::greater<>>> under_way_;
    std::priority_queue<Reply, std::vector<Reply>, std::greater<>> replies_;
    std::uint64_t order_ = 0;
    LevelAnswers answers_;
    std::uint64_t dram_sectors_ = 0;
};

}  // namespace raycache::cachesim
