#include "cachesim/replay/replay.hpp"

#include <algorithm>
#include <utility>

#include "cachesim/replay/hierarchy.hpp"
#include "cachesim/replay/launch_checks.hpp"
#include "cachesim/replay/schedule.hpp"

namespace raycache::cachesim {

struct Replay::Impl {
    Impl(const Gpu& gpu, const std::vector<traces::Region>& all_regions, std::uint32_t sample,
         InstructionSet instructions)
        : warps_per_cta(checked(gpu).warps_per_cta),
          cta_slots(std::max(1u, gpu.warps_per_sm / gpu.warps_per_cta)),
          regions(checked(all_regions)),
          sample_index(sample),
          sms(gpu.sms),
          memory(gpu, regions, instructions),
          schedule(gpu, cta_slots, memory) {}

    void place_cta();

    const unsigned warps_per_cta, cta_slots;  ///< slots of each SM
    const std::vector<traces::Region> regions;
    const std::uint32_t sample_index;
    const unsigned sms;
    Hierarchy memory;
    Schedule schedule;
    std::vector<WarpPointer> cta;  ///< warps of the CTA that is being pushed
    std::uint64_t placed = 0;      ///< CTAs placed so far
};

/// Gives the collected CTA a place: rotating while there is room, then wherever a slot frees first.
void Replay::Impl::place_cta() {
    const bool has_access =
        std::any_of(cta.begin(), cta.end(), [](const WarpPointer& w) { return !w->elements.empty(); });
    if (!has_access) {  // takes no slot and no turn; its rays count
        for (const WarpPointer& warp : cta)
            for (const traces::Record& record : warp->records) memory.add_rays(record);
    } else if (placed < std::uint64_t{cta_slots} * sms) {
        schedule.place(placed % sms, static_cast<unsigned>(placed / sms), cta);
        ++placed;
    } else if (const auto free = schedule.next_free()) {
        schedule.place(free->sm, free->slot, cta);
        schedule.resume();
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
    impl_->cta.push_back(std::move(warp));
    if (impl_->cta.size() == impl_->warps_per_cta) impl_->place_cta();
}

LaunchStatistics Replay::finish() {
    if (!impl_->cta.empty()) impl_->place_cta();
    while (impl_->schedule.next_free()) impl_->schedule.resume();
    return {impl_->sample_index, impl_->memory.groups()};
}

}  // namespace raycache::cachesim
