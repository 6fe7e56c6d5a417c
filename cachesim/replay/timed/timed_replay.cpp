#include "cachesim/replay/timed/timed_replay.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "cachesim/replay/group_numbers.hpp"
#include "cachesim/replay/launch_checks.hpp"
#include "cachesim/replay/timed/each_sm.hpp"
#include "cachesim/replay/timed/streamed_traffic.hpp"
#include "cachesim/replay/timed/timed_sm.hpp"

namespace raycache::cachesim {

struct TimedReplay::Impl {
    Impl(const Gpu& gpu, const std::vector<traces::Region>& all_regions, std::uint32_t sample, const Idealised& ideal,
         PortPath path)
        : regions(checked(all_regions)),
          ids(regions, checked_timed(gpu).l1().line_bytes),
          rules(gpu, all_regions, ids, ideal, path),  // the links, too
          memory(rules),
          streamed(regions, gpu.l1().sector_bytes) {
        batch_begin.counts.sample = sample;
        for (std::uint32_t sm = 0; sm < rules.gpu.sms; ++sm)
            sms.emplace_back(rules, ids, static_cast<std::uint16_t>(sm));
    }

    /// Everything that was counted up to a point in time.
    struct State {
        TimedStatistics counts;  ///< but for what follows from these and the time
        std::uint64_t streamed = 0;
        Cycle registers = 0;  ///< MemorySide::waiting()
        Cycle time = 0;       ///< since the launch of the first kernel
    };
    State state(Cycle time) const;
    TimedStatistics between(const State& from, const State& to) const;
    void turn_to(std::uint32_t batch, Cycle time);
    /// Since the launch of the first kernel; a kernel's own launch counts.
    Cycle here() const { return placed == 0 ? launched : now + rules.timing.launch_cycles; }

    void place_cta();
    void tell_of_streams(Cycle);
    void run_window();
    void run_all() {
        if (!cta.empty()) place_cta();
        all_placed = true;
        while (!idle()) run_window();
        all_placed = false;
    }
    /// A CPU's caches get what they fetch ahead of the end of a kernel.
    bool fetches_ahead() const {
        return std::any_of(sms.begin(), sms.end(), [](const TimedSm& sm) { return sm.fetches_ahead(); });
    }
    void skip_idle_windows();
    /// Whether the SMs' work of a window is worth several threads, and they may have it.
    bool together() const {
        const std::uint64_t warps = (placed - ended) * rules.gpu.warps_per_cta;
        return warps >= fewest_warps_of_threads && ids.dense();
    }
    Cycle last_end() const {
        Cycle last = began;
        for (const TimedSm& sm : sms) last = std::max(last, sm.last_end());
        return last;
    }
    bool idle() const {
        return memory.idle() && std::all_of(sms.begin(), sms.end(), [](const TimedSm& sm) { return sm.idle(); });
    }

    struct FreeSlot {
        Cycle time;
        std::size_t sm;
        unsigned slot;
        auto operator<=>(const FreeSlot&) const = default;
    };

    const std::vector<traces::Region> regions;
    LineIds ids;
    const TimedRules rules;
    MemorySide memory;
    StreamedTraffic streamed;
    DramSink* sink = nullptr;
    std::deque<TimedSm> sms;
    Cycle now = 0;
    Cycle began = 0;     ///< the kernel
    Cycle launched = 0;  ///< the kernel, since the launch of the first one
    std::vector<WarpPointer> cta;
    std::uint64_t placed = 0, ended = 0;  ///< CTAs of the kernel on SMs
    std::vector<FreeSlot> free;           ///< earliest last
    bool all_placed = false;              ///< no CTA of the kernel waits for a slot
    std::uint64_t rays = 0;               ///< of CTAs that no SM runs

    std::uint32_t wanted = 0, of_cta = 0, running = 0;  ///< batches: of the next warp, of the CTA, of this cycle
    std::uint32_t last_batch = 0;
    bool has_warps = false;                ///< the one that is counted
    bool empty_batch = true;               ///< the last batch has no warp as yet
    std::uint64_t streamed_placed = 0;     ///< sectors streamed by CTAs that were placed
    State batch_begin;                     ///< of the one that is counted
    std::vector<TimedStatistics> batches;  ///< that have ended
};

TimedReplay::Impl::State TimedReplay::Impl::state(Cycle time) const {
    State s;
    s.counts.sample = batch_begin.counts.sample;
    s.counts.rays = rays;
    for (const TimedSm& sm : sms) s.counts += sm.statistics(now);
    s.counts.instructions += s.counts.loads;
    s.counts.issue.busy += static_cast<double>(s.counts.loads);
    s.counts.levels[rules.gpu.levels.size() - 1] = memory.answers();
    s.counts.dram_sectors = memory.dram_sectors() + streamed_placed;
    s.streamed = streamed_placed;
    s.registers = memory.waiting();
    s.time = time;
    return s;
}

TimedStatistics TimedReplay::Impl::between(const State& from, const State& to) const {
    const Gpu& gpu = rules.gpu;
    TimedStatistics t = to.counts;
    t -= from.counts;
    const double cycles_per_sector = memory.dram_cycles_per_sector();
    const double streamed_cycles =
        static_cast<double>(to.streamed - from.streamed) * cycles_per_sector / rules.timing.dram_channels;
    t.cycles = to.time - from.time + static_cast<Cycle>(std::ceil(streamed_cycles));
    t.seconds = static_cast<double>(t.cycles) / (rules.timing.clock_mhz * 1e6);
    const auto asked = static_cast<double>(t.levels[gpu.levels.size() - 1].requests());
    const std::uint64_t l1s = std::uint64_t{gpu.sms} * gpu.l1_per_sm;
    t.warp_slots = std::uint64_t{gpu.sms} * rules.cta_slots * gpu.warps_per_cta;
    const LevelTiming last = rules.timing.level(gpu.levels.size() - 1);
    t.peak_l2_gb_s = last.bytes_per_cycle * gpu.levels.back().slices * rules.timing.clock_mhz * 1e-3;
    t.peak_dram_gb_s = rules.timing.dram_gb_s;
    t.issue.copies = std::uint64_t{gpu.sms} * rules.timing.schedulers;
    t.l1_port.copies = l1s;
    t.l1_tags = {t.l1_tags.busy * rules.tag_cost, l1s};
    t.l1_data = {static_cast<double>(t.levels[0].requests()) * rules.data_cost, l1s};
    t.l1_mshrs.copies = l1s * rules.timing.l1_mshrs;
    t.l2_mshrs = {static_cast<double>(to.registers - from.registers),
                  std::uint64_t{gpu.levels.back().slices} * last.mshrs};
    t.crossbar = {asked * memory.crossbar_cycles_per_sector(), gpu.sms};
    t.l2_slices = {asked * memory.slice_cycles_per_sector(), gpu.levels.back().slices};
    if (gpu.traversal == Traversal::rt_unit) {
        t.rt_box_tests.copies = t.rt_triangle_tests.copies = gpu.sms;
        t.rt_warps.copies = std::uint64_t{gpu.sms} * gpu.rt_unit->warps;
    }
    t.dram = {static_cast<double>(t.dram_sectors) * cycles_per_sector, rules.timing.dram_channels};
    return t;
}

/// From this time on it is another batch, or none, that is counted.
void TimedReplay::Impl::turn_to(std::uint32_t batch, Cycle time) {
    if (batch == running) return;
    const State reached = state(time);
    if (has_warps && running != not_counted) batches.push_back(between(batch_begin, reached));
    batch_begin = reached;
    running = batch;
    has_warps = false;
}

void TimedReplay::Impl::place_cta() {
    const bool has_access =
        std::any_of(cta.begin(), cta.end(), [](const WarpPointer& w) { return !w->elements.empty(); });
    const std::uint64_t at_first = std::uint64_t{rules.cta_slots} * sms.size();
    if (has_access && placed >= at_first)
        while (free.empty()) run_window();
    turn_to(of_cta, here());
    has_warps = true;
    tell_of_streams(placed < at_first ? began + placed / sms.size() : now);
    if (!has_access) {
        for (const WarpPointer& warp : cta)
            for (const traces::Record& record : warp->records)
                if (!record.is_access()) rays += record.lanes();
    } else if (placed < at_first) {
        const std::uint64_t round = placed / sms.size();
        sms[placed % sms.size()].place(static_cast<unsigned>(round), cta, began + round);
        ++placed;
    } else {
        const FreeSlot slot = free.back();
        free.pop_back();
        sms[slot.sm].place(slot.slot, cta, std::max(slot.time + 1, now));
        ++placed;
    }
    cta.clear();
}

/// What the CTA that is placed in this cycle writes and sorts.
void TimedReplay::Impl::tell_of_streams(Cycle time) {
    const std::uint64_t before = std::exchange(streamed_placed, streamed.sectors());
    if (!sink) return;
    for (const std::uint64_t address : streamed.written()) sink->write(address, time);
    if (const std::uint64_t moved = streamed_placed - before - streamed.written().size()) sink->moved(moved);
    streamed.forget_written();
}

void TimedReplay::Impl::run_window() {
    const Cycle begin = now, end = now + memory.window();
    memory.run_replies(begin, end,
                       [this](const MemorySide::Reply& reply) { sms[reply.output].replies.push_back(reply); });
    for_each_sm(sms.size(), together(), [&](std::size_t i) { sms[i].run(end); });
    for (std::size_t i = 0; i < sms.size(); ++i) {
        TimedSm& sm = sms[i];
        for (const MissRequest& miss : sm.misses) memory.request(miss);
        sm.misses.clear();
        for (const auto& [time, slot] : sm.freed) free.push_back({time, i, slot});
        ended += sm.freed.size();
        sm.freed.clear();
    }
    memory.run_requests(begin, end);
    std::sort(free.begin(), free.end(), std::greater<>());
    now = end;
    skip_idle_windows();
}

/// Leaves out windows in which nothing happens, unless a CTA can begin.
void TimedReplay::Impl::skip_idle_windows() {
    if (!free.empty() && !all_placed) return;
    Cycle next = memory.next_time();
    for (const TimedSm& sm : sms) {
        if (next <= now) return;
        next = std::min(next, sm.next_time());
    }
    if (next != never && next > now) now += (next - now) / memory.window() * memory.window();
}

TimedReplay::TimedReplay(const Gpu& gpu, const std::vector<traces::Region>& regions, std::uint32_t sample,
                         const Idealised& ideal, PortPath path)
    : impl_(std::make_unique<Impl>(gpu, regions, sample, ideal, path)) {}
TimedReplay::~TimedReplay() = default;
TimedReplay::TimedReplay(TimedReplay&&) noexcept = default;

void TimedReplay::observe(DramSink& sink) {
    impl_->sink = &sink;
    impl_->memory.observe(&sink);
    impl_->streamed.keep_written();
}

void TimedReplay::push(std::shared_ptr<const traces::WarpTrace> warp) {
    Impl& i = *impl_;
    check(*warp, i.regions);
    i.cta.push_back(i.streamed.take(std::move(warp)));
    i.of_cta = i.wanted;
    if (i.wanted != not_counted) i.empty_batch = false;
    if (i.cta.size() == i.rules.gpu.warps_per_cta) i.place_cta();
}

void TimedReplay::end_kernel() {
    Impl& i = *impl_;
    i.run_all();
    while (i.fetches_ahead() || !i.memory.idle()) i.run_window();
    i.launched = i.last_end() + i.rules.timing.launch_cycles;
    i.began = i.now = std::max(i.now, i.launched);
    for (TimedSm& sm : i.sms) sm.end_kernel();
    i.placed = i.ended = 0;
    i.free.clear();
}

void TimedReplay::count_from_here() {
    Impl& i = *impl_;
    if (!std::exchange(i.empty_batch, true)) ++i.last_batch;
    i.wanted = i.last_batch;
}

void TimedReplay::count_until_here() { impl_->wanted = not_counted; }

TimedStatistics TimedReplay::finish() {
    Impl& i = *impl_;
    i.run_all();
    // The end of the last batch; of a launch that was not counted to its end it came before.
    i.turn_to(not_counted, i.last_end() + i.rules.timing.launch_cycles);
    TimedStatistics all = i.between(i.batch_begin, i.batch_begin);  // of no time
    for (const TimedStatistics& batch : i.batches) all += batch;
    return all;
}

const std::vector<TimedStatistics>& TimedReplay::batches() const { return impl_->batches; }

}  // namespace raycache::cachesim
