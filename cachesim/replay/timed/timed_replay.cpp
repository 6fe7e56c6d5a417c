#include "cachesim/replay/timed/timed_replay.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "cachesim/replay/launch_checks.hpp"
#include "cachesim/replay/timed/streamed_traffic.hpp"
#include "cachesim/replay/timed/timed_sm.hpp"

namespace raycache::cachesim {

struct TimedReplay::Impl {
    Impl(const Gpu& gpu, const std::vector<traces::Region>& all_regions, std::uint32_t sample, const Idealised& ideal)
        : regions(checked(all_regions)),
          ids(regions, checked_timed(gpu).l1().line_bytes),
          rules(gpu, all_regions, ids, ideal),  // the links, too
          memory(rules),
          streamed(regions, gpu.l1().sector_bytes) {
        total.sample = sample;
        make_sms();
    }

    void make_sms() {
        sms.clear();
        for (std::uint32_t sm = 0; sm < rules.gpu.sms; ++sm)
            sms.emplace_back(rules, ids, static_cast<std::uint16_t>(sm));
    }
    void place_cta();
    void run_window();
    void run_all() {
        if (!cta.empty()) place_cta();
        all_placed = true;
        while (!idle()) run_window();
        all_placed = false;
    }
    void skip_idle_windows();
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
    std::deque<TimedSm> sms;
    Cycle now = 0;
    Cycle began = 0;  ///< the kernel
    std::vector<WarpPointer> cta;
    std::uint64_t placed = 0;
    std::vector<FreeSlot> free;  ///< earliest last
    bool all_placed = false;     ///< no CTA of the kernel waits for a slot
    TimedStatistics total;
};

void TimedReplay::Impl::place_cta() {
    const bool has_access =
        std::any_of(cta.begin(), cta.end(), [](const WarpPointer& w) { return !w->elements.empty(); });
    const std::uint64_t at_first = std::uint64_t{rules.cta_slots} * sms.size();
    if (!has_access) {
        for (const WarpPointer& warp : cta)
            for (const traces::Record& record : warp->records)
                if (!record.is_access()) total.rays += record.lanes();
    } else if (placed < at_first) {
        const std::uint64_t round = placed / sms.size();
        sms[placed % sms.size()].place(static_cast<unsigned>(round), cta, began + round);
        ++placed;
    } else {
        while (free.empty()) run_window();
        const FreeSlot slot = free.back();
        free.pop_back();
        sms[slot.sm].place(slot.slot, cta, std::max(slot.time + 1, now));
        ++placed;
    }
    cta.clear();
}

void TimedReplay::Impl::run_window() {
    const Cycle begin = now, end = now + memory.window();
    memory.run_replies(begin, end, [this](const MemorySide::Reply& reply) { sms[reply.output].deliver(reply); });
    for (std::size_t i = 0; i < sms.size(); ++i) {
        TimedSm& sm = sms[i];
        sm.run(end);
        for (const MissRequest& miss : sm.misses) memory.request(miss);
        sm.misses.clear();
        for (const auto& [time, slot] : sm.freed) free.push_back({time, i, slot});
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
                         const Idealised& ideal)
    : impl_(std::make_unique<Impl>(gpu, regions, sample, ideal)) {}
TimedReplay::~TimedReplay() = default;
TimedReplay::TimedReplay(TimedReplay&&) noexcept = default;

void TimedReplay::push(std::shared_ptr<const traces::WarpTrace> warp) {
    check(*warp, impl_->regions);
    impl_->cta.push_back(impl_->streamed.take(std::move(warp)));
    if (impl_->cta.size() == impl_->rules.gpu.warps_per_cta) impl_->place_cta();
}

void TimedReplay::end_kernel() {
    Impl& i = *impl_;
    i.run_all();
    i.began = i.now = std::max(i.now, i.last_end() + i.rules.timing.launch_cycles);
    for (const TimedSm& sm : i.sms) i.total += sm.statistics;
    i.make_sms();
    i.placed = 0;
    i.free.clear();
}

TimedStatistics TimedReplay::finish() {
    Impl& i = *impl_;
    i.run_all();
    TimedStatistics& t = i.total;
    for (const TimedSm& sm : i.sms) t += sm.statistics;
    const Gpu& gpu = i.rules.gpu;
    t.instructions += t.loads;
    t.issue.busy += static_cast<double>(t.loads);
    const double streamed =
        static_cast<double>(i.streamed.sectors()) * i.memory.dram_cycles_per_sector() / i.rules.timing.dram_channels;
    t.cycles = i.last_end() + i.rules.timing.launch_cycles + static_cast<Cycle>(std::ceil(streamed));
    t.seconds = static_cast<double>(t.cycles) / (i.rules.timing.clock_mhz * 1e6);
    (i.rules.three_levels() ? t.l3 : t.l2) = i.memory.answers();
    t.dram_sectors = i.memory.dram_sectors() + i.streamed.sectors();
    const auto asked = static_cast<double>(i.memory.answers().requests());
    const std::uint64_t l1s = std::uint64_t{gpu.sms} * gpu.l1_per_sm;
    t.warp_slots = std::uint64_t{gpu.sms} * i.rules.cta_slots * gpu.warps_per_cta;
    const LevelTiming last = i.rules.timing.level(gpu.levels.size() - 1);
    t.peak_l2_gb_s = last.bytes_per_cycle * gpu.levels.back().slices * i.rules.timing.clock_mhz * 1e-3;
    t.peak_dram_gb_s = i.rules.timing.dram_gb_s;
    t.issue.copies = std::uint64_t{gpu.sms} * i.rules.timing.schedulers;
    t.l1_port.copies = l1s;
    t.l1_tags = {t.l1_tags.busy * i.rules.tag_cost, l1s};
    t.l1_data = {static_cast<double>(t.l1.requests()) * i.rules.data_cost, l1s};
    t.l1_mshrs.copies = l1s * i.rules.timing.l1_mshrs;
    t.l2_mshrs = {static_cast<double>(i.memory.waiting()), std::uint64_t{gpu.levels.back().slices} * last.mshrs};
    t.crossbar = {asked * i.memory.crossbar_cycles_per_sector(), gpu.sms};
    t.l2_slices = {asked * i.memory.slice_cycles_per_sector(), gpu.levels.back().slices};
    t.dram = {static_cast<double>(t.dram_sectors) * i.memory.dram_cycles_per_sector(), i.rules.timing.dram_channels};
    return t;
}

}  // namespace raycache::cachesim
