#include "cachesim/replay/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cachesim/gpus/limits.hpp"
#include "cachesim/replay/hierarchy.hpp"
#include "cachesim/replay/schedule.hpp"
#include "traces/error.hpp"

namespace raycache::cachesim {

namespace {

Gpu checked(const Gpu& gpu) {
    if (const auto problem = find_problem(gpu))
        throw Error(fmt::format("GPU \"{}\": {}: {}", gpu.name, problem->key, problem->message));
    return gpu;
}

/// Only what a replay reads: base, sizes, count, kind.
std::vector<traces::Region> checked(const std::vector<traces::Region>& regions) {
    if (regions.size() >= traces::ray_start)
        throw Error(fmt::format("trace: expected at most {} regions, found {}; write the trace again",
                                traces::ray_start - 1, regions.size()));
    std::vector<traces::Region> copies;
    for (const traces::Region& r : regions) {
        if (static_cast<unsigned>(r.kind) >= traces::object_kinds)
            throw Error(
                fmt::format("region {} of the trace: expected an object kind of 0 to {}, found {}; write the "
                            "trace again",
                            copies.size(), traces::object_kinds - 1, static_cast<unsigned>(r.kind)));
        copies.push_back({r.kind, r.base, r.element_size, r.stride, r.count, 0, {}});
    }
    return copies;
}

}  // namespace

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

    void check(const traces::WarpTrace&) const;
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

/// What is read here is never trusted to be in range later.
void Replay::Impl::check(const traces::WarpTrace& warp) const {
    const auto where = [&] { return fmt::format("launch {}, warp {} of the trace", warp.launch, warp.warp); };
    std::size_t next = 0;
    for (const traces::Record& record : warp.records) {
        if (static_cast<unsigned>(record.ray) >= traces::ray_types)
            throw Error(fmt::format("{}: expected a ray type of 0 to {}, found {}; write the trace again", where(),
                                    traces::ray_types - 1, static_cast<unsigned>(record.ray)));
        if (!record.is_access()) continue;
        if (record.region >= regions.size())
            throw Error(fmt::format("{}: expected a region below {}, found {}; write the trace again", where(),
                                    regions.size(), record.region));
        const unsigned lanes = record.lanes();
        if (lanes == 0 || lanes > warp.elements.size() - next)
            throw Error(
                fmt::format("{}: expected an element for each of {} active lanes, found {}; write the trace "
                            "again",
                            where(), lanes, warp.elements.size() - next));
        std::uint32_t largest = 0;
        for (unsigned lane = 0; lane < lanes; ++lane) largest = std::max(largest, warp.elements[next + lane]);
        if (largest >= regions[record.region].count)
            throw Error(fmt::format("{}: expected elements of region {} below {}, found {}; write the trace again",
                                    where(), record.region, regions[record.region].count, largest));
        next += lanes;
    }
    if (next != warp.elements.size())
        throw Error(fmt::format("{}: expected {} elements, one for each active lane, found {}; write the trace again",
                                where(), next, warp.elements.size()));
}

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
    impl_->check(*warp);
    impl_->cta.push_back(std::move(warp));
    if (impl_->cta.size() == impl_->warps_per_cta) impl_->place_cta();
}

LaunchStatistics Replay::finish() {
    if (!impl_->cta.empty()) impl_->place_cta();
    while (impl_->schedule.next_free()) impl_->schedule.resume();
    return {impl_->sample_index, impl_->memory.groups()};
}

}  // namespace raycache::cachesim
