#include "cachesim/replay/hierarchy.hpp"

#include <algorithm>

#include "traces/error.hpp"

namespace raycache::cachesim {

namespace {

bool is_between_kernels(traces::ObjectKind kind) { return traces::role_of(kind).is_between_kernels; }

}  // namespace

Hierarchy::Hierarchy(const Gpu& gpu, const std::vector<traces::Region>& regions, InstructionSet instructions)
    : rules_(gpu, regions, instructions),
      numbers_(regions.size()),
      window_(rules_.rounds * gpu.sms),
      shared_(rules_, numbers_, observers_),
      work_(rules_),
      misses_(rules_.rounds) {
    for (std::uint32_t sm = 0; sm < gpu.sms; ++sm) sms_.emplace_back(rules_, sm, window_.data(), numbers_, observers_);
}

void Hierarchy::observe(RequestSink& sink) {
    if (std::any_of(rules_.kinds.begin(), rules_.kinds.end(), is_between_kernels))
        throw Error("trace of a wavefront: expected one of a megakernel, whose requests can be followed");
    observers_.add(sink);
}

void Hierarchy::end_window() {
    Lookups& missing = misses_.sort(
        sms_.size(), [this](std::size_t sm) -> const Lookups& { return sms_[sm].missing(); },
        [this](std::uint32_t access) { return window_[access].round; });
    work_.tally.make_room(numbers_.size());
    shared_.look_up(missing, window_.data(), work_);
    if (observers_.any()) observers_.end_window();
    for (SmCaches& sm : sms_) sm.end_window();
}

void Hierarchy::end_kernel() {
    for (SmCaches& sm : sms_) sm.end_kernel();
}

std::vector<RayGroup> Hierarchy::groups(const std::vector<const BatchGroups*>& batches) const {
    return work_.tally.groups(batches, rules_.kinds, rules_.gpu.levels.size(), rules_.count_loads);
}

}  // namespace raycache::cachesim
