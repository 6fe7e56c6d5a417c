#include "cachesim/replay/timed/warp_scheduler.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "timed_cases.hpp"

using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

std::vector<unsigned> picks(WarpScheduler& scheduler, const std::vector<std::uint64_t>& able) {
    std::vector<unsigned> all;
    for (const std::uint64_t bits : able) all.push_back(scheduler.pick(bits));
    return all;
}

}  // namespace

TEST_CASE("loose round-robin takes the next that is able, the first after the last") {
    WarpScheduler scheduler(timed_gpu());
    CHECK(picks(scheduler, {0b1011, 0b1011, 0b1011, 0b1011, 0b0100}) == std::vector<unsigned>{0, 1, 3, 0, 2});
    const std::uint64_t ends = std::uint64_t{1} << 63 | 1;
    CHECK(picks(scheduler, {ends, ends, ends}) == std::vector<unsigned>{63, 0, 63});
    scheduler.end_kernel();
    CHECK(scheduler.pick(0b1010) == 1);
}

TEST_CASE("greedy-then-oldest stays, and else takes the one that became resident first") {
    Gpu gpu = timed_gpu();
    gpu.scheduler = Scheduler::greedy_then_oldest;
    WarpScheduler scheduler(gpu);
    for (const auto& [bit, age] : {std::pair{0u, 5u}, {1u, 2u}, {2u, 9u}}) scheduler.become_resident(bit, age);
    CHECK(picks(scheduler, {0b111, 0b111, 0b101, 0b101, 0b110, 0b110}) == std::vector<unsigned>{1, 1, 0, 0, 1, 1});
}

TEST_CASE("a scheduler issues while a flight is ready and its loads have room before the port") {
    Gpu gpu = timed_gpu();
    gpu.timing->load_queue = 2;
    WarpScheduler scheduler(gpu);
    scheduler.assign(3, 40);
    CHECK_FALSE(scheduler.can_issue());
    scheduler.make_ready(3);
    CHECK(scheduler.pick_ready() == 3);
    CHECK(scheduler.flight(3) == 40);
    scheduler.issue_load(3, false, 10);
    CHECK(scheduler.can_issue());
    scheduler.issue_load(3, false, 11);
    CHECK_FALSE(scheduler.can_issue());  // two wait
    scheduler.load_passed();
    CHECK(scheduler.can_issue());
    scheduler.issue_load(3, true, 12);
    scheduler.load_passed();
    CHECK_FALSE(scheduler.can_issue());  // the visit has no more
}

TEST_CASE("instructions run in chains, behind those that began before, and early ones cost their issue only") {
    Gpu gpu = timed_gpu();
    gpu.timing->dependent_chains = 2;
    gpu.timing->instruction_latency = 5;
    WarpScheduler scheduler(gpu);
    CHECK(scheduler.run(100, 6, 0) == 100 + 2 * 5 + 1 + 1);  // at 0 1, 5 6, 10 11
    // The next block can issue from 106 on: its own latency is the limit, then the issue of many.
    CHECK(scheduler.run(100, 2, 0) == 108);
    CHECK(scheduler.run(100, 1, 1) == 100);
    CHECK(scheduler.run(103, 20, 0) == 103 + 9 * 5 + 1 + 1);
    for (int block = 0; block < 20; ++block) scheduler.run(103, 20, 0);
    CHECK(scheduler.run(103, 1, 0) == 109 + 20 + 20 * 20 + 1);
}
