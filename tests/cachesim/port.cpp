// The port of an L1: its rule by hand, and its fast path against the rule.
#include "cachesim/replay/timed/port.hpp"

#include <catch2/catch.hpp>

#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

/// One port, visits of one load each.
struct OnePort {
    explicit OnePort(const Gpu& gpu)
        : ids(pieces, gpu.l1().line_bytes),
          rules(gpu, pieces, ids, {}),
          visits(8),
          data(8),
          port(rules, ids, 0, 0, data.data(), lacks) {}

    void push(std::uint32_t flight, const std::vector<std::uint32_t>& elements) {
        VisitAtPort& visit = visits[flight];
        visit.shape = &rules.shapes[0];
        visit.region = 0;
        visit.visit.begin(*visit.shape, static_cast<std::uint32_t>((std::uint64_t{1} << elements.size()) - 1),
                          elements.data(), 32);
        data[flight] = {0, 0, flight, false};
        port.push({&visit, flight, 0, flight});
    }
    /// When each of the loads has passed.
    std::vector<Cycle> pass(Cycle now, Cycle end) {
        std::vector<Cycle> times;
        while (!port.empty() && std::max(now, port.free()) < end) {
            now = std::max(now, port.free());
            if (port.serve(now, end)) times.push_back(port.free());
        }
        return times;
    }

    LineIds ids;
    TimedRules rules;
    std::vector<VisitAtPort> visits;
    std::vector<LoadData> data;
    std::vector<MissRequest> lacks;
    Port port;
};

using Cycles = std::vector<Cycle>;

void check_same(const TimedStatistics& a, const TimedStatistics& b) {
    CHECK(a.cycles == b.cycles);
    CHECK(a.levels[0] == b.levels[0]);
    CHECK(a.levels[1] == b.levels[1]);
    CHECK(a.levels[2] == b.levels[2]);
    CHECK(a.dram_sectors == b.dram_sectors);
    CHECK(a.visit_cycles == b.visit_cycles);
    CHECK(a.warp_cycles == b.warp_cycles);
    CHECK(a.l1_port.busy == b.l1_port.busy);
    CHECK(a.l1_tags.busy == b.l1_tags.busy);
    CHECK(a.l1_mshrs.busy == b.l1_mshrs.busy);
    CHECK(a.l2_mshrs.busy == b.l2_mshrs.busy);
}

}  // namespace

TEST_CASE("loads pass a port in order, each as many cycles as its lines and sectors ask for") {
    OnePort p(timed_gpu());                      // 4 tags, 4 sectors a cycle
    p.push(0, {0, 2, 4, 6});                     // a line
    p.push(1, {0, 8, 16, 24, 32});               // five lines
    p.push(2, {0, 2, 4, 6, 8, 10, 12, 14, 16});  // nine sectors
    p.push(3, {1, 0});                           // one sector
    CHECK(p.pass(10, 1000) == Cycles{11, 13, 16, 17});
    CHECK(p.port.counts().busy == 1 + 2 + 3 + 1);
    CHECK(p.port.counts().tags == 1 + 5 + 3 + 1);
    CHECK(p.port.counts().answers.requests() == 4 + 5 + 9 + 1);
    CHECK(p.port.counts().answers.merges == 1 + 6 + 1);  // sectors asked for before
    CHECK(p.lacks.size() == p.port.counts().answers.misses());
    CHECK(p.data[2].arrival == 15);  // so far: when its last sector was looked up
}

TEST_CASE("a load that finds no register goes on where it stopped when one is free") {
    Gpu gpu = timed_gpu();
    gpu.timing->l1_mshrs = 2;
    OnePort p(gpu);
    p.push(0, {0, 8, 16});
    CHECK(p.pass(0, 20).empty());
    CHECK(p.lacks.size() == 2);
    CHECK(p.port.free() == 20);  // asks again in the next window
    std::vector<std::uint32_t> known;
    AnswerRate rate(0);
    p.port.arrive(p.lacks[0].number, 35, rate, [&](std::uint32_t data) { known.push_back(data); });
    CHECK(known.empty());
    CHECK(p.pass(20, 100) == Cycles{36});
    CHECK(p.lacks.size() == 3);
    CHECK(p.lacks[2].time == 35);
    p.data[0].asked = true;
    for (const std::size_t miss : {1u, 2u})
        p.port.arrive(p.lacks[miss].number, 50 + miss, rate, [&](std::uint32_t data) { known.push_back(data); });
    CHECK(known == std::vector<std::uint32_t>{0});
    CHECK(p.data[0].arrival == 52);
}

TEST_CASE("a port keeps its lines for the next kernel if it is told so") {
    for (const bool keep : {false, true}) {
        OnePort p(timed_gpu());
        p.push(0, {0});
        p.pass(0, 10);
        AnswerRate rate(0);
        p.port.arrive(p.lacks[0].number, 20, rate, [](std::uint32_t) {});
        p.port.end_kernel(keep);
        p.push(1, {0});
        p.pass(30, 40);
        CHECK(p.port.counts().answers.hits == (keep ? 1 : 0));
    }
}

TEST_CASE("an SM answers as many waiting look-ups a cycle as it is told, in order of what is known") {
    AnswerRate any(0), one(1), three(3);
    const auto times = [](AnswerRate& rate, Cycle arrival, int count) {
        Cycles all;
        rate.begin(arrival);
        for (int i = 0; i < count; ++i) all.push_back(rate.answer());
        return all;
    };
    CHECK(times(any, 10, 4) == Cycles{10, 10, 10, 10});
    CHECK(times(one, 10, 3) == Cycles{10, 11, 12});
    CHECK(times(one, 12, 2) == Cycles{13, 14});
    CHECK(times(one, 40, 1) == Cycles{40});
    CHECK(times(three, 10, 4) == Cycles{10, 10, 10, 11});
    CHECK(times(three, 10, 3) == Cycles{11, 11, 12});
    CHECK(times(three, 13, 2) == Cycles{13, 13});
}

TEST_CASE("warps that wait for one sector are answered as many a cycle as the GPU says") {
    const auto cycles = [](std::uint32_t per_cycle) {
        Gpu gpu = timed_gpu();
        gpu.warps_per_sm = gpu.warps_per_cta = 16;
        gpu.timing->l1_mshr_merges = 16;
        gpu.timing->answers_per_cycle = per_cycle;
        return timed(gpu, launch_of(std::vector(16, chase({0})))).cycles;
    };
    CHECK(cycles(0) == 500);
    CHECK(cycles(1) == 500 + 15);
    CHECK(cycles(2) == 500 + 7);
    CHECK(cycles(3) == 500 + 5);
    CHECK(cycles(16) == 500);
}

TEST_CASE("the fast path of a port gives what its rule gives") {
    const std::vector<traces::Region> regions{region(ObjectKind::node, 0x200000, 64, 64, 300),
                                              region(ObjectKind::triangle, 0x800000, 48, 48, 200),
                                              region(ObjectKind::texel, 0xc00000, 4, 4, 4000)};
    struct Case {
        const char* name;
        void (*change)(Gpu&);
    };
    const Case cases[] = {
        {"tags", [](Gpu&) {}},
        {"half a line", [](Gpu& g) { g.timing->l1_bytes_per_cycle = 64; }},
        {"one tag", [](Gpu& g) { g.timing->tags_per_cycle = 1; }},
        {"a sector and a half", [](Gpu& g) { g.timing->l1_bytes_per_cycle = 48; }},
        {"banks", [](Gpu& g) { g.timing->l1_port = L1Port::banks; }},
        {"few registers", [](Gpu& g) { g.timing->l1_mshrs = 3; }},
        {"few lines", [](Gpu& g) { g.levels[0].ways = 2; }},
        {"fifo", [](Gpu& g) { g.levels[0].policy = "fifo"; }},
        {"tree", [](Gpu& g) { g.levels[0].policy = "tree_plru"; }},
        {"on fill", [](Gpu& g) { g.levels[0].allocate = Allocate::on_fill; }},
        {"wide fill", [](Gpu& g) { g.levels[0].fill_bytes = 64; }},
        {"collectors", [](Gpu& g) { g.timing->operand_collectors = 2; }},
        {"two L1s", [](Gpu& g) { g.l1_per_sm = 2; }},
        {"eight lanes", [](Gpu& g) { g.simd_width = 8; }},
        {"one answer", [](Gpu& g) { g.timing->answers_per_cycle = 1; }},
    };
    for (const Case& c : cases) {
        for (const std::uint64_t seed : {1, 2}) {
            Gpu gpu = timed_gpu();
            gpu.sms = 2;
            gpu.warps_per_sm = 12;
            gpu.warps_per_cta = 4;
            gpu.levels[0].ways = 16;
            gpu.levels[1].sets = 8;
            gpu.timing->schedulers = 4;
            gpu.timing->node_instructions = 6;
            gpu.timing->l1_mshrs = 40;
            gpu.timing->l1_mshr_merges = 3;
            c.change(gpu);
            const Launch launch = random_launch(regions, 40, 40, seed);
            CAPTURE(c.name, seed);
            const TimedStatistics fast = timed(gpu, launch);
            check_same(fast, timed(gpu, launch, {}, PortPath::rule));
            CHECK(fast.levels[0].hits > 500);
            CHECK(fast.levels[0].misses() > 500);
            Idealised unlimited, perfect;
            unlimited.infinite_bandwidth = perfect.perfect_l1 = true;
            for (const Idealised& ideal : {unlimited, perfect})
                check_same(timed(gpu, launch, ideal), timed(gpu, launch, ideal, PortPath::rule));
        }
    }
}
