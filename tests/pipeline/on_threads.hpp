// Running something on a number of threads, whatever the machine has.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace raycache::test {

/// More than any test asks for.
inline constexpr int most_threads = 8;

/// run() in an arena of `threads`; what it returns.
template <class Run>
auto on_threads(int threads, const Run& run) {
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism, most_threads);
    return tbb::task_arena(threads).execute(run);
}

}  // namespace raycache::test
