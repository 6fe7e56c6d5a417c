// One SM in time: schedulers, the ports of its L1s, their lines and misses under way; of a CPU (three levels), its L2.
//
// A warp that is ready issues the loads of its next visit, one per scheduler and cycle. Loads wait in order for the
// port of their L1; each takes as many cycles there as Timing::l1_port says and looks up its sectors meanwhile. When
// the last sector of the visit is there, l1_latency later the warp issues the instructions of that visit, and is ready
// again. With Timing::operand_collectors each instruction goes its own way (instruction_flow.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cachesim/replay/multiprocessor.hpp"
#include "cachesim/replay/timed/event_wheel.hpp"
#include "cachesim/replay/timed/instruction_flow.hpp"
#include "cachesim/replay/timed/memory_side.hpp"
#include "cachesim/replay/timed/pool.hpp"
#include "cachesim/replay/timed/ring.hpp"
#include "cachesim/replay/timed/timed_cache.hpp"
#include "cachesim/replay/timed/timed_rules.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"
#include "cachesim/replay/timed/visit.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

class TimedSm {
public:
    /// `ids` number the lines of the regions; both must outlive this object.
    TimedSm(const TimedRules&, LineIds& ids, std::uint16_t number);

    /// Makes a CTA's warps resident from that cycle on.
    void place(unsigned cta_slot, std::span<const WarpPointer> warps, Cycle from);

    /// Simulates cycles before `end`. Whatever needs a reply that is not there yet waits.
    void run(Cycle end);

    /// Before this cycle nothing happens here unless a sector arrives.
    Cycle next_time() const;

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
    static constexpr std::uint32_t none = TimedCache::none;

    /// A resident warp.
    struct Warp {
        WarpPointer trace;
        const traces::Record *next = nullptr, *end = nullptr;
        const std::uint32_t* elements = nullptr;  ///< of `next`, from the first lane left on
        std::uint32_t left = 0;                   ///< lanes of `next` that have not had their turn; 0: none has
        bool among_triangles = false;             ///< the last access but for texels was to them (LeafStarts)
        std::uint32_t flights = 0;                ///< that have not ended
        std::uint64_t age = 0;                    ///< order of becoming resident
        Cycle since = 0;                          ///< it is resident
    };
    /// A visit of a warp that is under way. A warp has Timing::accesses_in_flight of them at once; each takes the
    /// warp's next access when it is done.
    struct Flight {
        std::uint8_t scheduler = 0, bit = 0;  ///< its place there
        const LoadShape* shape = nullptr;
        std::uint32_t region = 0;
        std::uint32_t instructions = 0;
        std::uint32_t issued = 0;   ///< loads of the visit
        std::uint32_t at_port = 0;  ///< loads of the visit that have passed the port
        bool computing = false;
        Cycle first_issue = 0;
        Visit visit;
        /// What the first load found, and when (LoadShape::steady): bit i: all sectors of element i were there, and
        /// its line was used after `found_since`; how many lines these are; in which cycle of the load each was asked.
        std::uint32_t there = 0, found_since = 0, lines = 0;
        std::array<std::uint8_t, traces::warp_lanes> cycle{};
        /// By element of the visit and line of the element, modulo 2: where the L1 held it when it was last looked up.
        std::array<std::uint32_t, 2 * traces::warp_lanes> entries{};
    };
    /// Data that a flight waits for: of all loads of its visit, or of one.
    struct Data {
        Cycle arrival = 0;             ///< of the latest sector so far
        std::uint32_t unresolved = 0;  ///< sectors whose arrival is not known
        std::uint32_t flight = 0;
        bool asked = false;  ///< the L1 has looked up all sectors
    };
    /// A load on its way through the port.
    struct Load {
        std::uint32_t flight = 0;
        std::uint32_t number = 0;  ///< of the visit
        std::uint32_t data = 0;    ///< of data_
    };
    /// One L1 with its port.
    struct L1 {
        TimedCache cache;
        Ring<Load> queue{};  ///< loads that wait, in order of issue
        Cycle port_free = 0;
        std::uint32_t position = 0;  ///< of the load at the front: the element to go on with
        std::uint32_t sector = 0;    ///< and how many of its sectors are done (serve_any())
        bool begun = false;          ///< groups of lanes before its first are done (serve_any())
        /// L1Port::tags: when the data path and the tag stage take one more; the latter in parts of a cycle, a tag
        /// each.
        double data_free = 0;
        std::uint64_t tags_free = 0;
    };
    /// The L2 of a CPU's core, and what its L1s ask of it.
    struct PrivateLevel {
        struct Request {
            Cycle time = 0;
            std::uint64_t line = 0;
            std::uint32_t id = 0, number = 0;  ///< number: register of the L1
            std::uint8_t sector = 0, l1 = 0;
        };
        TimedCache cache;
        Ring<Request> queue{};
        double free = 0;
    };
    /// Who waits for the arrival of a sector to be known: data_, or a register of an L1.
    struct Waiter {
        std::uint32_t who, next;
        std::uint8_t l1;
    };
    /// One scheduler. Bit b: flight b mod per_warp of warp slot (b div per_warp) * schedulers + its number.
    struct Scheduler {
        std::uint64_t ready = 0;
        unsigned last = 63;
        std::uint32_t queued = 0;                   ///< its loads that have not reached the port
        Cycle free = 0;                             ///< when it has issued all instructions so far
        std::array<std::uint16_t, 64> flight_of{};  ///< by bit
    };

    Warp& warp_of(std::uint32_t flight) { return warps_[per_warp_ == 1 ? flight : flight / per_warp_]; }
    /// The scheduler has become able to issue, or unable.
    void note(std::uint32_t scheduler) {
        const Scheduler& s = schedulers_[scheduler];
        const std::uint64_t bit = std::uint64_t{1} << scheduler;
        const bool can = s.ready != 0 && s.queued < rules_.timing.load_queue;
        can_issue_ = can ? can_issue_ | bit : can_issue_ & ~bit;
    }

    std::uint32_t shading(Warp&) const;
    std::uint32_t leaf(Warp&, std::uint32_t region, unsigned lanes) const;
    bool begin_visit(std::uint32_t flight);
    void make_ready(std::uint32_t flight, Cycle);
    void end_flight(std::uint32_t flight, Cycle);
    Cycle run_instructions(std::uint32_t flight, Cycle, std::uint32_t count, std::uint32_t early);
    void compute(std::uint32_t flight, Cycle);
    void issue(unsigned scheduler, Cycle);
    unsigned pick(const Scheduler&, std::uint64_t ready) const;
    void data_known(std::uint32_t number);

    // Timing::operand_collectors
    void run_flow(Cycle end);
    void open_visit(std::uint32_t flight, Cycle);
    void wake(std::uint32_t flight, Cycle);
    void advance(std::uint32_t flight, Cycle);
    Cycle ready_time(std::uint32_t flight) const;
    bool run_units(Cycle);
    bool feed_ports(Cycle, Cycle end);
    bool issue_one(unsigned scheduler, Cycle);
    Cycle next_in_flow(Cycle end) const;

    Cycle serve_port(std::uint8_t number, Cycle, Cycle end);
    template <L1Port port>
    Cycle serve_apart(std::uint8_t number, Cycle, Cycle end);
    Cycle serve_any(std::uint8_t number, Cycle, Cycle end);
    Cycle end_load(L1&, Cycle begin, Cycle end);
    Cycle serve_later(std::uint8_t number, Cycle, Cycle end);
    bool look_up(L1&, std::uint8_t number, const Load&, std::uint32_t id, std::uint32_t sector, std::uint32_t& known,
                 Cycle);
    bool miss(L1&, std::uint8_t number, const Load&, std::uint32_t sector, std::uint32_t id, std::uint32_t& entry,
              Cycle);
    Cycle retry_time(L1&, Cycle now, Cycle end) const;
    Cycle port_ready(const L1&, bool new_line, Cycle) const;
    void take_port(L1&, bool new_line, Cycle);

    void serve_private(Cycle);
    void arrive_in_l1(std::uint8_t l1, std::uint32_t number, Cycle);
    void wait(std::uint32_t& list, std::uint32_t who, std::uint8_t l1);

    const TimedRules& rules_;
    LineIds& ids_;
    const std::uint16_t number_;
    std::vector<Warp> warps_;                ///< by slot
    std::vector<Flight> flights_;            ///< by slot * per_warp_ + number
    std::uint32_t per_warp_;                 ///< flights of a warp
    std::uint32_t data_per_flight_;          ///< 1, or one for each load of a visit
    std::vector<Data> data_;                 ///< by flight * data_per_flight_ + load
    std::vector<std::uint32_t> unfinished_;  ///< warps of each CTA slot
    std::vector<Scheduler> schedulers_;
    std::uint64_t can_issue_ = 0;  ///< bit s: scheduler s has a ready flight, and room for its load
    std::vector<L1> l1s_;
    std::optional<PrivateLevel> private_;
    Pool<Waiter> waiters_;
    EventWheel events_;                    ///< flights whose data are there, and flights that begin a visit
    std::optional<InstructionFlow> flow_;  ///< with operand collectors
    Cycle now_ = 0;
    Cycle answer_free_ = 0;
    Cycle last_end_ = 0;
    std::uint64_t placed_ = 0;
    std::size_t resident_ = 0;
};

}  // namespace raycache::cachesim
