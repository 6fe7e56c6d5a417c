// Whether ThreadSanitizer, with tbb_order.cpp, does its work: `races none` uses TBB as raycache does, and nothing may
// be reported; every other KIND has a race planted in it that must be.
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

namespace {

using Numbers = std::vector<int>;
constexpr int count = 10000;

/// Where the planted races happen.
long shared_sum = 0;

/// Adds to it without order; waits before, for a while, until a second thread has come here too.
void race_for_sum() {
    static std::atomic<int> threads{0};
    thread_local const int mine = threads.fetch_add(1, std::memory_order_relaxed);
    const auto start = std::chrono::steady_clock::now();
    while (threads.load(std::memory_order_relaxed) < 2 &&
           std::chrono::steady_clock::now() - start < std::chrono::seconds(10))
        std::this_thread::yield();
    shared_sum += mine;
}

void loops(bool race) {
    Numbers in(count), out(count);
    std::iota(in.begin(), in.end(), 0);
    tbb::parallel_for(tbb::blocked_range<int>(0, count, 16), [&](const tbb::blocked_range<int>& range) {
        for (int i = range.begin(); i < range.end(); ++i) {
            out[static_cast<std::size_t>(i)] = in[static_cast<std::size_t>(i)] + 1;
            if (race) race_for_sum();
        }
    });
    tbb::parallel_for(
        0, count, [&](int i) { ++out[static_cast<std::size_t>(i)]; }, tbb::simple_partitioner());
    shared_sum += std::accumulate(out.begin(), out.end(), 0L);
}

void arena(bool race) {
    Numbers out(count);
    tbb::task_arena two(2);
    two.execute([&] {
        tbb::parallel_for(0, count, [&](int i) {
            out[static_cast<std::size_t>(i)] = i;
            if (race) race_for_sum();
        });
    });
    shared_sum += out.back();
}

void pipeline(bool race) {
    Numbers written;
    int next = 0;
    tbb::enumerable_thread_specific<Numbers> locals;
    tbb::parallel_pipeline(
        8, tbb::make_filter<void, Numbers>(tbb::filter_mode::serial_in_order, [&](tbb::flow_control& control) {
               if (++next > 200) control.stop();
               return Numbers(10, next);
           }) & tbb::make_filter<Numbers, Numbers>(tbb::filter_mode::parallel, [&](Numbers numbers) {
               locals.local().assign(100, 1);
               if (race) race_for_sum();
               return numbers;
           }) & tbb::make_filter<Numbers, void>(tbb::filter_mode::serial_in_order, [&](Numbers numbers) {
               written.push_back(numbers.front());
           }));
    for (const Numbers& local : locals) shared_sum += static_cast<long>(local.size());
    shared_sum += written.back();
}

}  // namespace

int main(int argc, char** argv) {
    const std::string kind = argc == 2 ? argv[1] : "";
    if (kind != "none" && kind != "loop" && kind != "arena" && kind != "pipeline") {
        std::fprintf(stderr, "usage: races none|loop|arena|pipeline\n");
        return 2;
    }
    for (int round = 0; round < 20; ++round) {
        loops(kind == "loop");
        arena(kind == "arena");
        pipeline(kind == "pipeline");
    }
    std::printf("%ld\n", shared_sum);
    return 0;
}
