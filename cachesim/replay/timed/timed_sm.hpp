// One SM in time: its warps and their visits, between the schedulers (warp_scheduler.hpp) and the ports of its L1s
// (port.hpp); of a CPU (three levels) its L2, too (private_level.hpp).
//
// A warp that is ready issues the loads of its next visit, one per scheduler and cycle. Loads wait in order for the
// port of their L1. When the last sector of the visit is there, l1_latency later the warp issues the instructions of
// that visit, and is ready again. With Timing::operand_collectors each instruction goes its own way
// (instruction_flow.hpp). With Traversal::rt_unit visits to nodes and triangles belong to the RT unit (rt_unit.hpp),
// which shares the ports with the schedulers. A warp whose trace says what waits for what issues in that order instead,
// by one flight (timed_sm_steps.cpp).
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cachesim/replay/multiprocessor.hpp"
#include "cachesim/replay/timed/answer_rate.hpp"
#include "cachesim/replay/timed/event_wheel.hpp"
#include "cachesim/replay/timed/instruction_flow.hpp"
#include "cachesim/replay/timed/memory_side.hpp"
#include "cachesim/replay/timed/pending_accesses.hpp"
#include "cachesim/replay/timed/port.hpp"
#include "cachesim/replay/timed/private_level.hpp"
#include "cachesim/replay/timed/resident_warp.hpp"
#include "cachesim/replay/timed/rt_unit.hpp"
#include "cachesim/replay/timed/timed_rules.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"
#include "cachesim/replay/timed/warp_scheduler.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

class alignas(64) TimedSm {
public:
    /// `ids` number the lines of the regions; both must outlive this object.
    TimedSm(const TimedRules&, LineIds& ids, std::uint16_t number);
    TimedSm(const TimedSm&) = delete;
    TimedSm& operator=(const TimedSm&) = delete;

    /// Makes a CTA's warps resident from that cycle on.
    void place(unsigned cta_slot, std::span<const WarpPointer> warps, Cycle from);

    /// Takes in the replies, and simulates cycles before `end`. Whatever needs a reply that is not there yet waits.
    /// SMs may run at once, on several threads, if the line ids are dense.
    void run(Cycle end);

    /// Before this cycle nothing happens here unless a sector arrives.
    Cycle next_time() const;

    /// Sectors that arrive, in order of coming; no cycle is before the end of the last run. The next one empties it.
    std::vector<MemorySide::Reply> replies;
    /// Misses of the last runs in order of time. The caller empties it.
    std::vector<MissRequest> misses;
    /// CTA slots that became free, and when. The caller empties it.
    std::vector<std::pair<Cycle, unsigned>> freed;

    /// No warp is resident.
    bool idle() const { return resident_ == 0; }
    /// A CPU's L2 still has requests, for sectors that nobody waits for.
    bool fetches_ahead() const { return private_ && !private_->idle(); }
    Cycle last_end() const { return last_end_; }

    /// The SM is idle and fetches nothing, and what it asked for has arrived: the next kernel begins. A GPU's L1s are
    /// empty then; a CPU's caches keep what they have.
    void end_kernel();

    /// What was counted so far, warps that are resident included; cycles and rates are left out.
    TimedStatistics statistics(Cycle now) const;

private:
    static constexpr std::uint32_t none = TimedCache::none;

    struct Warp {
        ResidentWarp records;
        std::uint32_t flights = 0;  ///< that have not ended
    };
    /// A visit of a warp that is under way. A warp has Timing::accesses_in_flight of them at once; each takes the
    /// warp's next access when it is done.
    struct alignas(64) Flight {
        std::uint8_t scheduler = 0, bit = 0;  ///< its place there
        bool computing = false;
        bool in_rt_unit = false;                    ///< the visit
        std::uint32_t tests = 0;                    ///< of the visit, there
        std::uint32_t loads = 0, instructions = 0;  ///< of the visit
        std::uint32_t issued = 0;                   ///< loads
        Cycle first_issue = 0;
        VisitAtPort visit;
    };

    std::uint32_t slot_of(std::uint32_t flight) const { return per_warp_ == 1 ? flight : flight / per_warp_; }
    Port& port_of(std::uint32_t flight) { return ports_[ports_.size() == 1 ? 0 : slot_of(flight) % ports_.size()]; }
    /// The scheduler has become able to issue, or unable.
    void note(std::uint32_t scheduler) {
        const std::uint64_t bit = std::uint64_t{1} << scheduler;
        can_issue_ = schedulers_[scheduler].can_issue() ? can_issue_ | bit : can_issue_ & ~bit;
    }

    std::uint32_t shading(std::uint32_t flight) { return warps_[slot_of(flight)].records.shading(rules_); }
    bool begin_visit(std::uint32_t flight, VisitAtPort&);
    void make_ready(std::uint32_t flight, Cycle);
    void end_flight(std::uint32_t flight, Cycle);
    void begin_in_rt_unit(std::uint32_t flight, Cycle);
    void leave_rt_unit(std::uint32_t flight, Cycle);
    void issue_of_rt_unit(Cycle);
    Cycle run_instructions(std::uint32_t flight, Cycle, std::uint32_t count, std::uint32_t early);
    void compute(std::uint32_t flight, Cycle);
    bool can_issue() const { return can_issue_ || (rt_unit_ && rt_unit_->can_issue()); }
    void issue(unsigned scheduler, Cycle);
    void serve(Port&, Cycle, Cycle end);
    void serve_private(Cycle);
    void take_replies();
    void deliver(const MemorySide::Reply&);
    void tell_ports();
    void data_known(std::uint32_t number);

    // traces::WarpTrace::issue
    bool has_steps(std::uint32_t flight) const {
        return !pending_.empty() && warps_[slot_of(flight)].records.has_steps();
    }
    void prepare_steps();
    void follow_steps(std::uint32_t flight, Cycle);
    Cycle obstacle(std::uint32_t slot) const;
    void open_place(std::uint32_t flight);
    void wait_until(std::uint32_t flight, Cycle);
    Port::Load load_of_place(std::uint32_t flight, std::uint32_t place, std::uint32_t load);
    void step_load_passed(const Port::Load&);
    void step_data_known(std::uint32_t number);

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

    const TimedRules& rules_;
    std::vector<Warp> warps_;                ///< by slot
    std::vector<Flight> flights_;            ///< by slot * per_warp_ + number
    std::uint32_t per_warp_;                 ///< flights of a warp
    std::uint32_t data_per_flight_;          ///< 1, or one for each load of a visit
    std::vector<LoadData> data_;             ///< by flight * data_per_flight_ + load
    std::vector<std::uint32_t> unfinished_;  ///< warps of each CTA slot
    std::vector<WarpScheduler> schedulers_;
    std::uint64_t can_issue_ = 0;  ///< bit s: scheduler s has a ready flight, and room for its load
    std::vector<Port> ports_;      ///< of each L1
    AnswerRate answer_rate_;
    std::optional<PrivateLevel> private_;
    std::vector<MissRequest> asked_;              ///< of private_, by the L1s
    std::vector<PrivateLevel::Answer> answered_;  ///< by private_
    EventWheel events_;                           ///< flights whose data are there, and flights that begin a visit
    std::optional<InstructionFlow> flow_;         ///< with operand collectors
    std::optional<RtUnit> rt_unit_;               ///< its warps are flights
    std::vector<PendingAccesses> pending_;        ///< by slot, once a warp with steps has come
    std::size_t first_place_ = 0;                 ///< in data_, of those of pending_
    std::deque<VisitAtPort> visits_;              ///< of warps with steps, from issue to the end of the port
    std::vector<VisitAtPort*> free_visits_;
    TimedStatistics counts_;  ///< but for those of ports and private_
    Cycle now_ = 0;
    Cycle last_end_ = 0;
    std::uint64_t placed_ = 0;
    std::size_t resident_ = 0;
};

}  // namespace raycache::cachesim
