// Parts made by several threads and used one after the other.
#pragma once

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <exception>
#include <utility>

namespace raycache::tools {

/// Calls use(make(i)) for i = 0 … count - 1: use() in this order and never twice at once, on whichever thread of the
/// TBB arena; make(), which must be thread-safe, for a few parts ahead on threads that have nothing else to do.
/// Two parts per thread at most wait for use(). The exception of the first part that has one is thrown, after the parts
/// before it were used; so all is as on one thread.
template <class Make, class Use>
void make_ahead(std::size_t count, const Make& make, const Use& use) {
    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    if (threads == 1 || count <= 1) {
        for (std::size_t i = 0; i < count; ++i) use(make(i));
        return;
    }
    struct Made {
        decltype(make(std::size_t{0})) part{};
        std::exception_ptr error{};
    };
    std::size_t next = 0;
    // Whoever waits here waits for these parts alone, and begins nothing else that would have to end first.
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_pipeline(
            2 * threads,
            tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, [&](tbb::flow_control& control) {
                if (next == count) control.stop();
                return next == count ? next : next++;
            }) & tbb::make_filter<std::size_t, Made>(tbb::filter_mode::parallel, [&](std::size_t i) {
                Made made;
                try {
                    made.part = make(i);
                } catch (...) {
                    made.error = std::current_exception();
                }
                return made;
            }) & tbb::make_filter<Made, void>(tbb::filter_mode::serial_in_order, [&](Made made) {
                if (made.error) std::rethrow_exception(made.error);
                use(std::move(made.part));
            }));
    });
}

}  // namespace raycache::tools
