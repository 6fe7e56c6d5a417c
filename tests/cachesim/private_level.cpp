#include "cachesim/replay/timed/private_level.hpp"

#include <catch2/catch.hpp>

#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

/// L2 of one set of two lines, a sector a cycle, 170 cycles beyond L1.
Gpu cpu() {
    Gpu gpu = timed_gpu();
    gpu.levels.push_back(gpu.levels[1]);
    gpu.levels[1].sets = 1;
    gpu.levels[1].ways = 2;
    gpu.levels[1].slices = 1;
    gpu.timing->l2_mshrs = 2;
    gpu.timing->l2_mshr_merges = 2;
    gpu.timing->l3_latency = 300;
    gpu.timing->l3_mshrs = 64;
    gpu.timing->l3_mshr_merges = 4;
    return gpu;
}

struct Core {
    explicit Core(const Gpu& gpu) : ids(pieces, gpu.l1().line_bytes), rules(gpu, pieces, ids, {}), level(rules, 5) {}

    void ask(Cycle time, std::uint32_t line, std::uint32_t number, std::uint8_t sector = 0, std::uint8_t l1 = 0) {
        level.ask({time, ids.line(line, 0), line, number, 5, sector, l1});
    }
    void deliver(std::size_t miss, Cycle ready) {
        MemorySide::Reply reply;
        reply.ready = ready;
        reply.number = lacks[miss].number;
        level.deliver(reply, answers);
    }

    LineIds ids;
    TimedRules rules;
    PrivateLevel level;
    std::vector<MissRequest> lacks;
    std::vector<PrivateLevel::Answer> answers;
};

}  // namespace

TEST_CASE("a core's L2 sends for what it lacks, and answers when that has arrived") {
    Core core(cpu());
    core.ask(10, 1, 33, 2, 1);
    core.level.serve(10, core.lacks, core.answers);
    CHECK(core.level.idle());
    REQUIRE(core.lacks.size() == 1);
    CHECK(core.lacks[0].time == 10);
    CHECK(core.lacks[0].id == 1);
    CHECK(core.lacks[0].sector == 2);
    CHECK(core.lacks[0].sm == 5);
    CHECK(core.answers.empty());
    core.ask(11, 1, 34, 2, 0);  // the same sector, on its way
    core.level.serve(11, core.lacks, core.answers);
    CHECK(core.lacks.size() == 1);
    core.deliver(0, 400);
    REQUIRE(core.answers.size() == 2);
    CHECK(core.answers[0].number == 34);
    CHECK(core.answers[1].number == 33);
    CHECK(core.answers[1].l1 == 1);
    CHECK(core.answers[1].arrival == 400);
    core.ask(500, 1, 35, 2);
    core.level.serve(500, core.lacks, core.answers);
    CHECK(core.answers.back().number == 35);
    CHECK(core.answers.back().arrival == 500 + 170);
    core.ask(501, 1, 36, 3);
    core.level.serve(501, core.lacks, core.answers);
    CHECK(core.level.counts() == LevelAnswers{1, 1, 1, 1});
}

TEST_CASE("a request that finds no register holds up those behind it") {
    Core core(cpu());
    for (std::uint32_t line = 0; line < 3; ++line) core.ask(0, line, line);
    core.ask(0, 0, 9);
    for (Cycle now = 0; now < 10; ++now) core.level.serve(now, core.lacks, core.answers);
    CHECK(core.lacks.size() == 2);
    CHECK_FALSE(core.level.idle());
    core.deliver(0, 50);
    core.level.serve(49, core.lacks, core.answers);
    CHECK(core.lacks.size() == 2);
    core.level.serve(50, core.lacks, core.answers);
    CHECK(core.lacks.size() == 3);
    core.level.serve(51, core.lacks, core.answers);  // line 0 went for line 2
    CHECK_FALSE(core.level.idle());
}

TEST_CASE("a core's L2 serves at its rate") {
    Gpu gpu = cpu();
    gpu.timing->l2_bytes_per_cycle = 8;  // a sector in four cycles
    Core core(gpu);
    core.ask(0, 0, 0, 0);
    core.ask(0, 0, 1, 1);
    for (Cycle now = 0; now < 4; ++now) core.level.serve(now, core.lacks, core.answers);
    CHECK(core.lacks.size() == 1);
    core.level.serve(4, core.lacks, core.answers);
    CHECK(core.lacks.size() == 2);
}
