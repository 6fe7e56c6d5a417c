#include "cachesim/replay/timed/launch_stages.hpp"

#include <algorithm>
#include <utility>

namespace raycache::cachesim {
namespace {

LaunchStages::Stage& add_stage(LaunchStages::Stage& to, const LaunchStages::Stage& other) {
    to.cycles += other.cycles;
    to.warp_accesses += other.warp_accesses;
    return to;
}

LaunchStages::Stage stage_of(const TimedStatistics& batch) { return {batch.cycles, batch.warp_accesses}; }

}  // namespace

LaunchStages::Stage LaunchStages::all() const {
    Stage sum = filling;
    add_stage(sum, full);
    return add_stage(sum, draining);
}

LaunchStages& LaunchStages::operator+=(const LaunchStages& other) {
    add_stage(filling, other.filling);
    add_stage(full, other.full);
    add_stage(draining, other.draining);
    return *this;
}

StagedReplay::StagedReplay(const Gpu& gpu, const std::vector<traces::Region>& regions, std::uint32_t sample)
    : replay_(gpu, regions, sample),
      sample_(sample),
      warps_per_cta_(gpu.warps_per_cta),
      first_waiting_(std::uint64_t{gpu.sms} * std::max(1U, gpu.warps_per_sm / gpu.warps_per_cta)) {}

void StagedReplay::push(std::shared_ptr<const traces::WarpTrace> warp) {
    cta_.push_back(std::move(warp));
    if (cta_.size() == warps_per_cta_) take_cta();
}

void StagedReplay::take_cta() {
    if (std::any_of(cta_.begin(), cta_.end(), [](const auto& warp) { return !warp->elements.empty(); })) {
        replay_held();
        held_waits_ = working_++ == first_waiting_;
    }
    held_.insert(held_.end(), cta_.begin(), cta_.end());
    cta_.clear();
}

/// Behind it comes another CTA with accesses.
void StagedReplay::replay_held() {
    if (std::exchange(held_waits_, false)) {
        replay_.count_from_here();
        becomes_full_ = true;
    }
    for (auto& warp : held_) replay_.push(std::move(warp));
    held_.clear();
}

LaunchStages StagedReplay::finish() {
    if (!cta_.empty()) take_cta();
    const bool drains = working_ > 1;
    if (drains) replay_.count_from_here();
    for (auto& warp : held_) replay_.push(std::move(warp));
    const TimedStatistics all = replay_.finish();
    const std::vector<TimedStatistics>& batches = replay_.batches();
    LaunchStages stages;
    stages.sample = sample_;
    stages.filling = stage_of(drains ? batches.front() : all);
    if (becomes_full_) stages.full = stage_of(batches[1]);
    if (drains) stages.draining = stage_of(batches.back());
    return stages;
}

}  // namespace raycache::cachesim
