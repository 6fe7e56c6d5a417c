// The work of all SMs of a window, which are independent within it: on this thread, or on those of the current TBB
// arena that have nothing better to do.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace raycache::cachesim {

/// With fewer warps resident on all SMs a window is done sooner than another thread is told of it.
inline constexpr std::size_t fewest_warps_of_threads = 64;

/// Calls use(i) for 0 … sms - 1. `together`: on several threads, if there are. A thread that waits for another takes
/// no task from outside meanwhile, such as a replay of another launch, which would hold up this one to its end.
template <class Use>
void for_each_sm(std::size_t sms, bool together, const Use& use) {
    if (!together || tbb::this_task_arena::max_concurrency() == 1) {
        for (std::size_t i = 0; i < sms; ++i) use(i);
        return;
    }
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sms), [&](const tbb::blocked_range<std::size_t>& part) {
            for (std::size_t i = part.begin(); i != part.end(); ++i) use(i);
        });
    });
}

}  // namespace raycache::cachesim
