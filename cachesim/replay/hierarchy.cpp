#include "cachesim/replay/hierarchy.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "traces/error.hpp"

namespace raycache::cachesim {

namespace {

/// Fewer accesses than these are looked up before another thread has woken up.
constexpr std::size_t fewest_for_threads = 2048;

bool is_between_kernels(traces::ObjectKind kind) { return traces::role_of(kind).is_between_kernels; }

}  // namespace

Hierarchy::Hierarchy(const Gpu& gpu, const std::vector<traces::Region>& regions, InstructionSet instructions)
    : rules_(gpu, regions, instructions),
      numbers_(regions.size()),
      shared_(rules_, numbers_, observers_),
      work_(rules_),
      on_threads_([this] { return Workspace(rules_); }),
      misses_(rules_.rounds) {
    AccessOrigin* const window = accesses_of(windows_[present_]);
    for (std::uint32_t sm = 0; sm < gpu.sms; ++sm) sms_.emplace_back(rules_, sm, window, numbers_, observers_);
}

void Hierarchy::observe(RequestSink& sink) {
    bool above = false;  // what is written passes these levels by, unheard
    for (std::size_t level = 0; level < rules_.shared; ++level)
        for (std::uint32_t sm = 0; sm < rules_.gpu.sms; ++sm) above = above || sink.wants(level, sm);
    if (above && std::any_of(rules_.kinds.begin(), rules_.kinds.end(), is_between_kernels))
        throw Error("trace of a wavefront: expected one of a megakernel, whose requests can be followed");
    observers_.add(sink);
}

AccessOrigin* Hierarchy::accesses_of(Window& window) {
    if (window.accesses.empty()) window.accesses.resize(rules_.rounds * rules_.gpu.sms);
    return window.accesses.data();
}

void Hierarchy::begin_window() {
    deferred_ = rules_.ids.dense() && !observers_.any() && tbb::this_task_arena::max_concurrency() > 1;
}

void Hierarchy::end_window() {
    if (deferred_) {
        look_up_deferred();
        return;
    }
    look_up_shared();
    ask_shared(windows_[present_], [this](std::size_t sm) -> const Lookups& { return sms_[sm].missing(); });
    if (observers_.any()) observers_.end_window();
    for (SmCaches& sm : sms_) sm.end_window();
}

/// The SMs look up the present window, and the shared level that before.
void Hierarchy::look_up_deferred() {
    std::size_t accesses = 0;
    for (const SmCaches& sm : sms_) accesses += sm.waiting();
    if (accesses < fewest_for_threads) {
        look_up_shared();
        for (SmCaches& sm : sms_) sm.end_run(work_);
    } else {
        // Waits for these alone, not for whatever else the arena has to do.
        tbb::this_task_arena::isolate([this] {
            tbb::parallel_for(
                std::size_t{0}, sms_.size() + 1,
                [this](std::size_t i) {
                    if (i == 0)
                        look_up_shared();
                    else if (sms_[i - 1].waiting())
                        sms_[i - 1].end_run(on_threads_.local());
                },
                tbb::simple_partitioner());
        });
    }
    Window& ended = windows_[present_];
    present_ ^= 1;
    ended.missing.resize(sms_.size());
    AccessOrigin* const next = accesses_of(windows_[present_]);
    for (std::size_t sm = 0; sm < sms_.size(); ++sm) sms_[sm].end_window(ended.missing[sm], next);
    shared_waits_ = true;
}

/// The window before the present one, if the shared level has not seen it.
void Hierarchy::look_up_shared() {
    if (!shared_waits_) return;
    const Window& before = windows_[present_ ^ 1];
    ask_shared(before, [&](std::size_t sm) -> const Lookups& { return before.missing[sm]; });
    shared_waits_ = false;
}

template <class MissingOf>
void Hierarchy::ask_shared(const Window& window, const MissingOf& missing_of) {
    const AccessOrigin* const accesses = window.accesses.data();
    Lookups& missing =
        misses_.sort(sms_.size(), missing_of, [accesses](std::uint32_t access) { return accesses[access].round; });
    work_.tally.make_room(numbers_.size());
    shared_.look_up(missing, accesses, work_);
}

void Hierarchy::catch_up() {
    look_up_shared();
    for (SmCaches& sm : sms_) sm.end_run(work_);
}

void Hierarchy::end_kernel() {
    for (SmCaches& sm : sms_) sm.end_kernel();
}

std::vector<RayGroup> Hierarchy::groups(const std::vector<const BatchGroups*>& batches) const {
    Tally sum(numbers_.per_ray());
    sum += work_.tally;
    for (const Workspace& work : on_threads_) sum += work.tally;
    return sum.groups(batches, rules_.kinds, rules_.gpu.levels.size(), rules_.count_loads);
}

}  // namespace raycache::cachesim
