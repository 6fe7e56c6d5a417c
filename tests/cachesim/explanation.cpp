// The text of an explanation: factors, the one that does most, the waterfall, and the sentence.
#include "cachesim/report/explanation.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "cachesim/analysis/traffic_identity.hpp"
#include "cachesim/report/waterfall.hpp"
#include "tests/cachesim/series.hpp"

using namespace raycache::cachesim;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

using test::counters;

/// 40 steps/ray, 0.2 accesses/step, 8 sectors/access, half miss in L1, a quarter of these in L2.
const Counters plain = counters(10, 400, 80, 640, 320, 80);

/// As plain, but with half the warp accesses per step, and half again of L2's misses.
const Counters better = counters(10, 400, 40, 320, 160, 60);

LaunchStatistics launch(std::uint32_t sample, const Counters& counts) {
    LaunchStatistics s;
    s.sample = sample;
    RayGroup group;
    group.by_kind[0] = counts;
    group.rays = counts.rays;
    group.by_kind[0].rays = 0;
    s.groups.push_back(group);
    return s;
}

Explanation explanation(const std::vector<Counters>& base, const std::vector<Counters>& other) {
    Explanation e;
    e.scene = "box.glb";
    e.gpu = "small";
    e.spp = 64;
    e.base.name = "plain";
    e.other.name = "clever";
    for (std::size_t i = 0; i < base.size(); ++i) {
        e.base.launches.push_back(launch(static_cast<std::uint32_t>(i), base[i]));
        e.other.launches.push_back(launch(static_cast<std::uint32_t>(i), other[i]));
    }
    e.base.findings.levels.resize(2);
    e.other.findings.levels.resize(2);
    return e;
}

}  // namespace

TEST_CASE("the factors of two hand-made counts multiply to their ratio of DRAM bytes per ray") {
    const auto f = traffic_factors({plain}, {better}, CacheUnits{});
    REQUIRE(f);
    std::vector<double> means;
    for (const Estimate& term : f->terms) means.push_back(term.mean);
    CHECK(means == std::vector<double>{1, 0.5, 1, 1, 1.5});
    CHECK(f->product() == 0.75);
    CHECK_FALSE(traffic_factors({plain}, {counters(10, 0, 0, 0, 0, 0)}, CacheUnits{}));
}

TEST_CASE("an L3 has a factor of its own") {
    Counters base = plain, other = better;
    base.levels[2].sectors = 160;
    other.levels[2].sectors = 80;
    const auto f = traffic_factors({base}, {other}, CacheUnits{3, 32});
    REQUIRE(f);
    CHECK(f->terms[4].mean == 1);
    CHECK(f->terms[5].mean == 1.5);
    CHECK(f->product() == 0.75);
    CHECK(identity_terms(3).size() == 6);
}

TEST_CASE("the sentence says how much at every level, why, and what is a matter of caches") {
    const std::string one = sentence(explanation({plain}, {better}));
    CHECK_THAT(one,
               StartsWith("clever reads 50.0 % fewer L2-to-L1 bytes per ray than plain (512.0 against 1024), most by "
                          "SIMT efficiency, x0.500 (fewer warp accesses per step: less divergence); 25.0 % fewer "
                          "DRAM bytes per ray (192.0 against 256.0), most by SIMT efficiency"));
    CHECK_THAT(one,
               Contains("with equal miss rates x0.500 of the DRAM bytes would remain, the miss rates give x1.500"));
    CHECK_THAT(one, EndsWith("from one sample index, so without a confidence interval."));
    const std::string two = sentence(explanation({plain, plain}, {better, better}));
    CHECK_THAT(two, StartsWith("clever reads 50.0 ±0.0 % fewer L2-to-L1 bytes per ray than plain"));
    CHECK_THAT(two, EndsWith("give x1.500 ±0.000."));
}

TEST_CASE("the sentence does not claim what the sample indices do not show") {
    const std::string text = sentence(explanation({plain, plain}, {better, counters(10, 400, 80, 640, 320, 81)}));
    CHECK_THAT(text, Contains("more DRAM bytes per ray") && Contains("no certain difference"));
    CHECK_THAT(text, !Contains("most by"));
    CHECK_THAT(text, Contains("--trace-samples"));
    CHECK_THAT(sentence(explanation({counters(10, 400, 80, 640, 0, 0)}, {plain})), Contains("no ratio"));
}

TEST_CASE("the sentence says that there is no difference where there is none") {
    CHECK(sentence(explanation({plain}, {plain})) ==
          "There is no difference: clever reads as many bytes per ray as plain from every level.");
    CHECK_THAT(sentence(explanation({plain, better}, {plain, better})), StartsWith("There is no difference: "));
    Counters other = plain;
    other.levels[1].sectors /= 2;
    CHECK_THAT(sentence(explanation({plain}, {other})),
               StartsWith("clever reads 50.0 % fewer") && Contains("as many DRAM bytes per ray (256.0 against 256.0)"));
    Counters base = plain;
    base.dram_sectors = 1'000'000;
    other = base;
    other.dram_sectors += 1;
    CHECK_THAT(sentence(explanation({base}, {other})),
               StartsWith("clever reads as many L2-to-L1 bytes per ray as plain") &&
                   Contains("0.0001 % more DRAM bytes per ray"));
}

TEST_CASE("an explanation names both L1 hit rates, and compulsory misses where DRAM sees little else") {
    Counters base = plain, other = better;
    base.requests = 3200;
    base.levels[0].hits = base.levels[0].sectors - base.levels[1].sectors;
    base.dram_first_sectors = 80;
    other.requests = 1600;
    other.levels[0].hits = other.levels[0].sectors - other.levels[1].sectors;
    other.dram_first_sectors = 59;
    const Explanation e = explanation({base, base}, {other, other});
    const std::string text = to_text(e);
    CHECK_THAT(text, Contains("L1 visit miss rate") && Contains("(l1tex__t_sector_hit_rate): 90.0 and 90.0"));
    CHECK_THAT(text, Contains("note: small: at least 95 % of the sectors read from DRAM are compulsory"));
    const auto json = nlohmann::json::parse(to_json(e));
    CHECK(json["base"]["l1_hit_rate"] == 0.9);
    CHECK(json["base"]["l1_visit_hit_rate"] == 0.5);
    CHECK(json["other"]["dram_compulsory_share"] == 59.0 / 60);
    CHECK(json["factors"]["simt_efficiency"]["factor"]["mean"] == 0.5);
    CHECK(json["verdict"]["level"] == "l2_bytes");
    CHECK_THAT(to_text(explanation({plain, plain}, {better, better})), !Contains("compulsory misses (first"));
}

TEST_CASE("an explanation of nothing is still a text") {
    const std::string text = to_text(explanation({Counters{}}, {Counters{}}));
    CHECK_THAT(text, !Contains("nan") && !Contains("inf"));
    CHECK_THAT(text, Contains("no depth in this trace"));
    CHECK_THAT(to_json(explanation({Counters{}}, {Counters{}})), Contains("null"));
}

TEST_CASE("each bar of a waterfall begins where the one before it ended") {
    // x1/4 to x1 on 9 cells, so a factor of 2 is four cells.
    CHECK(waterfall({{"a", 0.5}, {"b", 0.5}, {"c", 2}, {"= all", 1, true}}, 23) ==
          "              x0.25  x1\n"
          "a      x0.500     ◄███│\n"
          "b      x0.500 ◄███    │\n"
          "c      x2.000 ███►    │\n"
          "= all  x0.500     ◄▒▒▒│\n");
}
