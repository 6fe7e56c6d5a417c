#include "cachesim/replay/replay.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "cachesim/replay/hierarchy.hpp"
#include "cachesim/replay/launch_checks.hpp"
#include "cachesim/replay/schedule.hpp"

namespace raycache::cachesim {

struct Replay::Impl {
    Impl(const Gpu& all_gpu, const std::vector<traces::Region>& all_regions, std::uint32_t sample,
         InstructionSet instructions)
        : gpu(checked(all_gpu)),
          warps_per_cta(gpu.warps_per_cta),
          cta_slots(std::max(1u, gpu.warps_per_sm / gpu.warps_per_cta)),
          regions(checked(all_regions)),
          sample_index(sample),
          sms(gpu.sms),
          memory(gpu, regions, instructions),
          schedule(std::in_place, gpu, cta_slots, memory),
          groups(&memory.group_numbers().begin_batch()) {}

    void place_cta();
    void run_all() {
        if (!cta.empty()) place_cta();
        while (schedule->next_free()) schedule->resume();
    }

    const Gpu gpu;
    const unsigned warps_per_cta, cta_slots;  ///< slots of each SM
    const std::vector<traces::Region> regions;
    const std::uint32_t sample_index;
    const unsigned sms;
    Hierarchy memory;
    std::optional<Schedule> schedule;  ///< of this kernel
    std::vector<PushedWarp> cta;       ///< warps of the CTA that is being pushed
    std::uint64_t placed = 0;          ///< CTAs of this kernel placed so far
    BatchGroups* groups;               ///< of the warps that are pushed
    bool empty_batch = true;           ///< the last batch has no warp as yet
};

/// Gives the collected CTA a place: rotating while there is room, then wherever a slot frees first.
void Replay::Impl::place_cta() {
    const bool has_access =
        std::any_of(cta.begin(), cta.end(), [](const PushedWarp& w) { return !w.trace->elements.empty(); });
    if (!has_access) {  // takes no slot and no turn; its rays count
        for (const PushedWarp& warp : cta)
            for (const traces::Record& record : warp.trace->records) memory.add_rays(record, *warp.groups);
    } else if (placed < std::uint64_t{cta_slots} * sms) {
        schedule->place(placed % sms, static_cast<unsigned>(placed / sms), cta);
        ++placed;
    } else if (const auto free = schedule->next_free()) {
        schedule->place(free->sm, free->slot, cta);
        schedule->resume();
        ++placed;
    }
    cta.clear();
}

Replay::Replay(const Gpu& gpu, const std::vector<traces::Region>& regions, std::uint32_t sample,
               InstructionSet instructions)
    : impl_(std::make_unique<Impl>(gpu, regions, sample, instructions)) {}
Replay::~Replay() = default;
Replay::Replay(Replay&&) noexcept = default;

void Replay::observe(RequestSink& sink) { impl_->memory.observe(sink); }

void Replay::push(std::shared_ptr<const traces::WarpTrace> warp) {
    check(*warp, impl_->regions);
    impl_->cta.push_back({std::move(warp), impl_->groups});
    if (impl_->groups->batch() != not_counted) impl_->empty_batch = false;
    if (impl_->cta.size() == impl_->warps_per_cta) impl_->place_cta();
}

void Replay::end_kernel() {
    impl_->run_all();
    impl_->memory.end_kernel();
    impl_->schedule.emplace(impl_->gpu, impl_->cta_slots, impl_->memory);
    impl_->placed = 0;
}

void Replay::count_from_here() {
    GroupNumbers& numbers = impl_->memory.group_numbers();
    if (!std::exchange(impl_->empty_batch, true)) numbers.begin_batch();
    impl_->groups = &numbers.last_batch();
}

void Replay::count_until_here() { impl_->groups = &impl_->memory.group_numbers().uncounted(); }

LaunchStatistics Replay::finish() {
    impl_->run_all();
    impl_->memory.catch_up();
    std::vector<const BatchGroups*> all;
    for (const BatchGroups& batch : impl_->memory.group_numbers().batches()) all.push_back(&batch);
    return {impl_->sample_index, impl_->memory.groups(all)};
}

std::vector<LaunchStatistics> Replay::batches() const {
    impl_->memory.catch_up();
    std::vector<LaunchStatistics> each;
    const auto& batches = impl_->memory.group_numbers().batches();
    const std::size_t count = batches.size() - (impl_->empty_batch ? 1 : 0);
    for (std::size_t b = 0; b < count; ++b) each.push_back({impl_->sample_index, impl_->memory.groups({&batches[b]})});
    return each;
}

LineFills Replay::last_level_fills() const {
    impl_->memory.catch_up();
    return impl_->memory.shared_fills();
}

}  // namespace raycache::cachesim
