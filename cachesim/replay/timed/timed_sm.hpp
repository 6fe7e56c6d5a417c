// One SM in time: schedulers, the port of its L1s, their tags and misses under way.
//
// A warp that is ready issues the loads of its next visit, one per scheduler and cycle. Loads wait in order for the
// port of their L1; each takes as many cycles there as Timing::l1_port says and looks up its sectors meanwhile. When
// the last sector of the visit is there, l1_latency later the warp issues the instructions of that visit, and is ready
// again.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "cachesim/cache/line_map.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/multiprocessor.hpp"
#include "cachesim/replay/timed/fill_buffer.hpp"
#include "cachesim/replay/timed/memory_side.hpp"
#include "cachesim/replay/timed/sector_tags.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"
#include "cachesim/replay/timed/visit.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

/// What all SMs share and none changes.
struct TimedRules {
    TimedRules(const Gpu&, const std::vector<traces::Region>&, const Idealised&);

    Gpu gpu;
    Timing timing;
    Idealised ideal;
    LineMap l1_map;
    std::vector<LoadShape> shapes;            ///< of each region
    std::vector<std::uint32_t> instructions;  ///< of a visit to each region, without its loads
    std::uint32_t sectors_per_line;
    int line_of_sector;  ///< log2 of it
    unsigned cta_slots;
};

class TimedSm {
public:
    TimedSm(const TimedRules&, std::uint16_t number);

    /// Makes a CTA's warps resident from that cycle on.
    void place(unsigned cta_slot, std::span<const WarpPointer> warps, Cycle from);

    /// Simulates cycles before `end`. Whatever needs a reply that is not there yet waits.
    void run(Cycle end);

    /// A sector arrives; its cycle is not before the end of the last run.
    void deliver(const MemorySide::Reply&);

    /// Misses of the last runs in order of time. The caller empties it.
    std::vector<MissRequest> misses;
    /// CTA slots that became free, and when. The caller empties it.
    std::vector<std::pair<Cycle, unsigned>> freed;

    /// No warp is resident.
    bool idle() const { return resident_ == 0; }
    Cycle last_end() const { return last_end_; }

    /// Cycles and rates are left out.
    TimedStatistics statistics;

private:
    /// A resident warp.
    struct Warp {
        WarpPointer trace;
        const traces::Record *next = nullptr, *end = nullptr;
        const std::uint32_t* elements = nullptr;  ///< of `next`
        std::uint64_t age = 0;                    ///< order of becoming resident
        std::uint32_t flights = 0;                ///< that have not ended
    };
    /// A visit of a warp that is under way. A warp has Timing::accesses_in_flight of them at once; each takes the
    /// warp's next access when it is done.
    struct Flight {
        Visit visit;
        /// By position in the visit (serve_port()): where the L1 held the sector that an earlier load looked up there.
        std::array<std::uint32_t, 2 * traces::warp_lanes> entries{};
        const LoadShape* shape = nullptr;
        std::uint32_t issued = 0;      ///< loads of the visit
        std::uint32_t at_port = 0;     ///< loads of the visit that have passed the port
        std::uint32_t unresolved = 0;  ///< sectors whose arrival is not known
        Cycle arrival = 0;             ///< of the latest sector so far
        Cycle first_issue = 0;
        std::uint32_t instructions = 0;
        bool computing = false;
    };
    struct Event {
        Cycle time;
        std::uint32_t flight;
        bool operator>(const Event& other) const {
            return time != other.time ? time > other.time : flight > other.flight;
        }
    };
    struct Load {
        Cycle time;
        std::uint32_t flight;
    };
    /// One L1 with its port.
    struct L1 {
        explicit L1(const TimedRules&);
        SectorTags tags;
        std::optional<FillBuffer> fills;     ///< Allocate::on_fill; its entries are numbered behind those of `tags`
        std::uint32_t entries;               ///< of `tags`
        std::vector<std::uint16_t> merges;   ///< of each sector of each entry
        std::vector<std::uint32_t> waiters;  ///< likewise: first of waiting_, or none
        std::vector<Load> queue;             ///< loads in order of issue, from `head` on
        std::size_t head = 0;
        Cycle port_free = 0;
        std::uint32_t position = 0;   ///< of the load at the head: its next element, if it could not end
        std::uint64_t under_way = 0;  ///< sectors
        std::queue<Cycle> arrivals;   ///< of those whose arrival is known, in order
    };
    struct Waiter {
        std::uint32_t flight, next;
    };
    /// One scheduler. Bit b: flight b mod per_warp of warp slot (b div per_warp) * schedulers + its number.
    struct Scheduler {
        std::uint64_t ready = 0;
        unsigned last = 63;
        std::uint32_t queued = 0;  ///< its loads that have not reached the port
        Cycle free = 0;            ///< when it has issued all instructions so far
    };

    Warp& warp_of(std::uint32_t flight) { return warps_[flight / per_warp_]; }
    Scheduler& scheduler_of(std::uint32_t flight) { return schedulers_[flight / per_warp_ % schedulers_.size()]; }
    std::uint32_t flight_of(unsigned scheduler, unsigned bit) const {
        return static_cast<std::uint32_t>((bit / per_warp_ * schedulers_.size() + scheduler) * per_warp_ +
                                          bit % per_warp_);
    }

    void begin_visit(std::uint32_t flight, Cycle);
    void end_flight(std::uint32_t flight, Cycle);
    void compute(std::uint32_t flight, Cycle);
    void issue(unsigned scheduler, Cycle);
    unsigned pick(const Scheduler&, unsigned number) const;
    Cycle serve_port(L1&, std::uint8_t number, Cycle, Cycle end);
    bool look_up(L1&, std::uint8_t number, std::uint32_t flight, std::uint64_t sector, std::uint32_t& entry, Cycle);
    void visit_done(std::uint32_t flight);

    const TimedRules& rules_;
    const std::uint16_t number_;
    std::vector<Warp> warps_;                ///< by slot
    std::vector<Flight> flights_;            ///< by slot * per_warp_ + number
    std::uint32_t per_warp_;                 ///< flights of a warp
    std::vector<std::uint32_t> unfinished_;  ///< warps of each CTA slot
    std::vector<Scheduler> schedulers_;
    std::vector<L1> l1s_;
    std::vector<Waiter> waiting_;
    std::uint32_t free_waiter_ = SectorTags::none;
    /// Warps whose data are there, and warps that begin a visit.
    std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
    Cycle now_ = 0;
    Cycle answer_free_ = 0;
    Cycle last_end_ = 0;
    std::uint64_t placed_ = 0;
    std::size_t resident_ = 0;
};

}  // namespace raycache::cachesim
