#include "cachesim/replay/sm_caches.hpp"

#include <catch2/catch.hpp>
#include <deque>
#include <random>
#include <thread>
#include <vector>

#include "random_launch.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

/// Four SMs that each issue one window of random accesses, on one thread or on one each.
struct FourSms {
    explicit FourSms(bool threads) {
        std::deque<SmCaches> sms;
        std::deque<Workspace> work;
        std::vector<AccessOrigin> window(rules.rounds * 4);
        BatchGroups& batch = numbers.begin_batch();
        for (std::uint32_t sm = 0; sm < 4; ++sm) {
            sms.emplace_back(rules, sm, window.data(), numbers, nobody);
            if (threads || sm == 0) work.emplace_back(rules);
        }
        const auto run = [&](std::uint32_t sm) {
            std::mt19937 random(sm);
            std::vector<std::vector<std::uint32_t>> elements(rules.rounds);
            Workspace& mine = work[threads ? sm : 0];
            for (std::size_t round = 0; round < rules.rounds; ++round) {
                traces::Record record;
                record.mask = 0xf0f0u;
                record.bounce = static_cast<std::uint8_t>(random() % 4);
                for (int lane = 0; lane < 8; ++lane) elements[round].push_back(random() % 500);
                sms[sm].access(record, elements[round].data(), 0, random() % 2, round, batch, mine);
            }
            sms[sm].end_run(mine);
        };
        if (threads) {
            std::vector<std::thread> running;
            for (std::uint32_t sm = 0; sm < 4; ++sm) running.emplace_back(run, sm);
            for (std::thread& thread : running) thread.join();
        } else {
            for (std::uint32_t sm = 0; sm < 4; ++sm) run(sm);
        }
        Tally sum(numbers.per_ray());
        for (const Workspace& w : work) sum += w.tally;
        groups = sum.groups({&batch}, rules.kinds, rules.gpu.levels.size(), rules.count_loads);
        for (const SmCaches& sm : sms) {
            const Lookups& missing = sm.missing();
            const auto count = static_cast<std::ptrdiff_t>(missing.count);
            lines.emplace_back(missing.lines.begin(), missing.lines.begin() + count);
            sectors.emplace_back(missing.sectors.begin(), missing.sectors.begin() + count);
        }
    }

    static Gpu gpu() {
        Gpu gpu = small_gpu();
        gpu.sms = 4;
        gpu.l1_per_sm = 2;
        gpu.levels[0].policy = "random";  // numbers of caches matter
        return gpu;
    }

    HierarchyRules rules{gpu(), {region(ObjectKind::node, 0x200000, 64, 64, 500)}, best_instruction_set()};
    GroupNumbers numbers{1};
    Observers nobody;
    std::vector<RayGroup> groups;
    std::vector<std::vector<std::uint32_t>> lines, sectors;  ///< that each SM lacks
};

}  // namespace

TEST_CASE("SMs on threads of their own miss and count what they do one after the other") {
    const FourSms one(false), four(true);
    CHECK(one.groups == four.groups);
    CHECK(one.lines == four.lines);
    CHECK(one.sectors == four.sectors);
    REQUIRE(one.groups.size() == 4);
    CHECK(one.groups[0].by_kind[0].levels[0].hits > 100);
    CHECK(one.lines[0].size() > 100);
    CHECK(one.lines[0] != one.lines[1]);
}

TEST_CASE("what an SM lacks it lacks again in the next window only if it was evicted since") {
    HierarchyRules rules(small_gpu(), {region(ObjectKind::node, 0x200000, 128, 128, 100)}, best_instruction_set());
    GroupNumbers numbers(1);
    Observers nobody;
    std::vector<AccessOrigin> window(2 * rules.rounds);
    Workspace work(rules);
    SmCaches sm(rules, 1, window.data(), numbers, nobody);
    BatchGroups& batch = numbers.begin_batch();
    const auto read = [&](std::vector<std::uint32_t> elements) {  // one access each
        traces::Record record;
        record.mask = 1;
        for (std::size_t i = 0; i < elements.size(); ++i) sm.access(record, &elements[i], 0, 0, i, batch, work);
        sm.end_run(work);
        const std::size_t lacks = sm.missing().count;
        for (std::size_t i = 0; i < lacks; ++i) CHECK(sm.missing().accesses[i] >= rules.rounds);  // its own place
        sm.end_window();
        return lacks;
    };
    CHECK(read({0, 1, 0, 1}) == 2);
    CHECK(read({0, 1}) == 0);
    CHECK(read({2, 4, 6, 8}) == 4);  // four ways of set 0
    CHECK(read({1, 0}) == 1);
    sm.end_kernel();
    CHECK(read({1, 0}) == 2);
}
