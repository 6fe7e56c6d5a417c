#include "cachesim/report/report.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "cachesim/report/estimate.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;

namespace {

Counters counters(std::uint64_t rays, std::uint64_t steps, std::uint64_t accesses, std::uint64_t sectors,
                  std::uint64_t l2, std::uint64_t dram) {
    Counters c;
    c.rays = rays;
    c.steps = c.lane_accesses = steps;
    c.warp_accesses = accesses;
    c.sectors = sectors;
    c.l2_sectors = l2;
    c.l1_hits = sectors - l2;
    c.dram_sectors = dram;
    c.l2_hits = l2 - dram;
    return c;
}

/// Camera nodes, half as much again for shadow triangles.
LaunchStatistics launch(std::uint32_t sample, Counters c) {
    RayGroup camera, shadow;
    camera.rays = c.rays;
    c.rays = 0;
    camera.by_kind[0] = c;
    shadow.ray = traces::RayType::shadow;
    shadow.rays = camera.rays / 2;
    shadow.by_kind[1] =
        counters(0, c.steps / 2, c.warp_accesses / 2, c.sectors / 2, c.l2_sectors / 2, c.dram_sectors / 2);
    return {sample, {camera, shadow}};
}

Series series(const std::string& strategy, std::vector<LaunchStatistics> launches) {
    Series s;
    s.scene = "room";
    s.strategy = strategy;
    s.sequence = "sobol";
    s.thread_map = "tile";
    s.gpu = "gtx-980-ti";
    s.spp = 64;
    s.launches = std::move(launches);
    return s;
}

std::vector<Series> two_strategies() {
    return {series("rotation", {launch(0, counters(1000, 40000, 6000, 50000, 24000, 3000)),
                                launch(1, counters(1100, 43000, 6500, 56000, 26000, 3500))}),
            series("micro-jitter", {launch(0, counters(1000, 38000, 4700, 38000, 13000, 1500)),
                                    launch(1, counters(1080, 41000, 5000, 43000, 14000, 1800))})};
}

}  // namespace

TEST_CASE("Student's t quantiles are those of the tables") {
    CHECK(student_t_975(1) == Approx(12.7062).epsilon(1e-5));
    CHECK(student_t_975(2) == Approx(4.30265).epsilon(1e-5));
    CHECK(student_t_975(9) == Approx(2.26216).epsilon(1e-5));
    CHECK(student_t_975(30) == Approx(2.04227).epsilon(1e-5));
}

TEST_CASE("a ratio estimate is as computed by hand") {
    // R = 15/6 = 2.5; residuals -0.5, 1, -0.5; var = 1.5 / (3 * 2 * 2^2) = 1/16; t(2) / 4.
    const Estimate e = ratio_of_totals({{2, 6, 7}, {1, 2, 3}});
    CHECK(e.mean == 2.5);
    REQUIRE(e.half_width);
    CHECK(*e.half_width == Approx(0.95 * std::sqrt(2 / (1 - 0.95 * 0.95)) / 4).epsilon(1e-12));
}

TEST_CASE("a paired ratio estimate is as computed by hand") {
    // Own R = 6/4 with residuals -0.5, 0.5 and mean y 3; baseline R' = 8/4, residuals 0, 0. Q = 0.75.
    // e = -1/6, 1/6; var = Q^2 (2/36) / 2 = (0.75/6)^2.
    const Estimate e = ratio_to_baseline({{2.5, 3.5}, {2, 2}}, {{4, 4}, {2, 2}});
    CHECK(e.mean == 0.75);
    REQUIRE(e.half_width);
    CHECK(*e.half_width == Approx(student_t_975(1) * 0.125).epsilon(1e-12));
}

TEST_CASE("what all strategies share cancels in a paired ratio") {
    const Estimate e = ratio_to_baseline({{1, 20, 3}, {1, 2, 3}}, {{2, 40, 6}, {1, 2, 3}});
    CHECK(e.mean == Approx(0.5));
    CHECK(*e.half_width == Approx(0).margin(1e-12));
}

TEST_CASE("estimates without a value are no numbers and have no interval") {
    CHECK(std::isnan(ratio_of_totals({{1, 2}, {0, 0}}).mean));
    CHECK_FALSE(ratio_of_totals({{1, 2}, {0, 0}}).half_width);
    CHECK(ratio_of_totals({{3}, {2}}).mean == 1.5);
    CHECK_FALSE(ratio_of_totals({{3}, {2}}).half_width);
    CHECK(std::isnan(ratio_to_baseline({{1, 2}, {1, 1}}, {{0, 0}, {1, 1}}).mean));
    CHECK(ratio_to_baseline({{0, 0}, {1, 1}}, {{1, 2}, {1, 1}}).mean == 0);
    CHECK(std::isnan(ratio_of_totals({{}, {}}).mean));
}

TEST_CASE("the product of the factors is the traffic ratio") {
    std::mt19937_64 random(4);
    for (int round = 0; round < 200; ++round) {
        const auto any = [&] {
            std::vector<LaunchStatistics> launches;
            for (std::uint32_t i = 0; i < 3; ++i) {
                const std::uint64_t dram = 2 + random() % 1000, l2 = dram + random() % 100000,
                                    all = l2 + random() % 1000000;
                launches.push_back(launch(
                    i, counters(2 + random() % 99999, 2 + random() % 9999999, 2 + random() % 99999, all, l2, dram)));
            }
            return launches;
        };
        const Report r = make_report({series("a", any()), series("b", any())}, "a", GroupBy::none);
        REQUIRE(r.rows[1].factors);
        CHECK(r.rows[1].factors->product() == Approx(r.rows[1].dram_bytes_ratio->mean).epsilon(1e-12));
        const Factors& f = *r.rows[1].factors;
        CHECK(f.product() / f.l2_locality == Approx(r.rows[1].l2_bytes_ratio->mean).epsilon(1e-12));
    }
}

TEST_CASE("the factors of a small case are as computed by hand") {
    const Report r = make_report({series("a", {launch(0, counters(100, 4000, 800, 8000, 4000, 1000))}),
                                  series("b", {launch(0, counters(200, 4000, 400, 8000, 2000, 250))})},
                                 "a", GroupBy::ray);
    REQUIRE(r.rows.size() == 4);
    CHECK(r.rows[2].group == "camera");
    const Factors& f = *r.rows[2].factors;
    CHECK(f.work == 0.5);
    CHECK(f.simt_efficiency == 0.5);
    CHECK(f.coalescing == 2);
    CHECK(f.l1_locality == 0.5);
    CHECK(f.l2_locality == 0.5);
    CHECK(r.rows[2].dram_bytes_ratio->mean == 0.125);
    CHECK(r.rows[2].dram_bytes_per_ray.mean == 32 * 250.0 / 200);
}

TEST_CASE("rows split by bounce, ray and object, and their totals add up") {
    const auto all = two_strategies();
    const auto names = [&](GroupBy by) {
        std::vector<std::string> groups;
        for (const Row& row : make_report({all[0]}, "", by).rows) groups.push_back(row.group);
        return groups;
    };
    CHECK(names(GroupBy::none) == std::vector<std::string>{"all"});
    CHECK(names(GroupBy::bounce) == std::vector<std::string>{"camera", "shadow 0"});
    CHECK(names(GroupBy::ray) == std::vector<std::string>{"camera", "shadow"});
    CHECK(names(GroupBy::object) == std::vector<std::string>{"node", "triangle"});
    const Row whole = make_report({all[0]}, "", GroupBy::none).rows[0];
    double bytes = 0;
    for (const Row& row : make_report({all[0]}, "", GroupBy::object).rows) {
        CHECK(row.totals.rays == whole.totals.rays);
        bytes += row.dram_bytes_per_ray.mean;
    }
    CHECK(bytes == Approx(whole.dram_bytes_per_ray.mean));
}

TEST_CASE("an unknown baseline is bad use; a missing or unpaired one is a note") {
    auto all = two_strategies();
    CHECK_THROWS_AS(make_report(all, "white", GroupBy::none), UsageError);
    CHECK_THROWS_WITH(make_report(all, "white", GroupBy::none), Catch::Contains("micro-jitter, rotation"));
    CHECK(make_report(all, "", GroupBy::none).notes.empty());
    all[1].spp = 16;
    Report r = make_report(all, "rotation", GroupBy::none);
    REQUIRE(r.notes.size() == 1);
    CHECK_THAT(r.notes[0], Catch::Contains("no ratio") && Catch::Contains("N 16"));
    CHECK_FALSE(r.rows[1].dram_bytes_ratio);
    all = two_strategies();
    all[1].launches[1].sample = 5;
    r = make_report(all, "rotation", GroupBy::none);
    REQUIRE(r.notes.size() == 1);
    CHECK_THAT(r.notes[0], Catch::Contains("sample indices differ"));
    CHECK_FALSE(r.rows[1].factors);
}

TEST_CASE("one sample index gives no interval and says so once") {
    auto all = two_strategies();
    for (Series& s : all) s.launches.resize(1);
    const Report r = make_report(all, "rotation", GroupBy::none);
    CHECK(r.notes == std::vector<std::string>{"one sample index: no confidence interval"});
    CHECK_FALSE(r.rows[0].dram_bytes_per_ray.half_width);
    CHECK(to_text(r).find("±0") == std::string::npos);
}

TEST_CASE("the text report is a readable table") {
    const std::string text = to_text(make_report(two_strategies(), "rotation", GroupBy::none));
    CHECK(
        text ==
        R"(strategy       N  GPU          rays  steps/ray  lanes/acc  sectors/acc  L1 %  L2 %  L2->L1 B/ray    DRAM B/ray    DRAM ratio
------------  --  ----------  -----  ---------  ---------  -----------  ----  ----  ------------  ------------  ------------
rotation      64  gtx-980-ti  3 150       39.5       6.64         8.48  52.8  87.0   761.9 ±73.8  99.05 ±36.88      baseline
micro-jitter  64  gtx-980-ti  3 120       38.0       8.14         8.35  66.7  87.8    415.4 ±7.5  50.77 ±33.83  0.513 ±0.151

rays: all sample indices together; step: one lane's visit to a node or triangle; acc: warp access; L1 %, L2 %: sectors found;
B/ray: bytes read; ±: 95 % confidence over sample indices; DRAM ratio: DRAM B/ray over that of rotation.

Where the ratios to rotation come from; below 1 is better

strategy       N  GPU          work  x SIMT efficiency  x coalescing  x L1 locality  = L2->L1 ratio  x L2 locality  = DRAM ratio
------------  --  ----------  -----  -----------------  ------------  -------------  --------------  -------------  ------------
micro-jitter  64  gtx-980-ti  0.961              0.815         0.985          0.707    0.545 ±0.043          0.940  0.513 ±0.151

work: steps/ray; SIMT efficiency: warp accesses/step; coalescing: sectors/warp access; L1, L2 locality: miss rates; each over the baseline's.

micro-jitter, N 64, gtx-980-ti: 48.7 % fewer DRAM bytes/ray, most by L1 locality, x0.707 (lower L1 miss rate).
)");
    std::size_t start = 0;
    for (std::size_t end; (end = text.find('\n', start)) != std::string::npos; start = end + 1)
        CHECK(end - start <= 160);
}

TEST_CASE("a report of nothing still prints") {
    auto empty = series("rotation", {});
    CHECK_FALSE(to_text(make_report({}, "", GroupBy::none)).empty());
    CHECK_FALSE(to_csv(make_report({empty}, "rotation", GroupBy::none)).empty());
    const Report zero = make_report(
        {series("a", {launch(0, {}), launch(1, {})}), series("b", {launch(0, {}), launch(1, {})})}, "a", GroupBy::none);
    CHECK_THAT(to_text(zero), Catch::Contains("-"));
    CHECK(to_text(zero).find("nan") == std::string::npos);
    CHECK(nlohmann::json::parse(to_json(zero))["rows"][1]["dram_bytes_ratio"]["mean"].is_null());
    CHECK(nlohmann::json::parse(to_json(zero))["rows"][1]["factors"].is_null());
    CHECK(to_csv(zero).find("nan") == std::string::npos);
}

TEST_CASE("JSON keeps every digit and the order of keys") {
    const Report r = make_report(two_strategies(), "rotation", GroupBy::bounce);
    const std::string text = to_json(r);
    CHECK(text == to_json(r));
    const auto json = nlohmann::ordered_json::parse(text);
    REQUIRE(json["rows"].size() == r.rows.size());
    for (std::size_t i = 0; i < r.rows.size(); ++i) {
        CHECK(json["rows"][i]["dram_bytes_per_ray"]["mean"].get<double>() == r.rows[i].dram_bytes_per_ray.mean);
        CHECK(json["rows"][i]["dram_bytes_per_ray"]["half_width_95"].get<double>() ==
              *r.rows[i].dram_bytes_per_ray.half_width);
        CHECK(json["rows"][i]["totals"]["dram_sectors"].get<std::uint64_t>() == r.rows[i].totals.dram_sectors);
    }
    CHECK(json.begin().key() == "baseline");
    CHECK(json["rows"][0].begin().key() == "scene");
    CHECK(json["by"] == "bounce");
}

TEST_CASE("names that are no UTF-8 end no program") {
    auto s = series("\xff\xfe", {launch(0, counters(1, 2, 3, 4, 3, 2))});
    CHECK_NOTHROW(to_json(make_report({s}, "", GroupBy::none)));
}

TEST_CASE("CSV has one field per header and quotes what needs it") {
    auto all = two_strategies();
    all[0].parameters = "K=1, \"wide\"";
    const std::string csv = to_csv(make_report(all, "rotation", GroupBy::none));
    CHECK_THAT(csv, Catch::Contains("sobol,\"K=1, \"\"wide\"\"\",tile"));
    std::vector<std::size_t> fields;
    bool quoted = false;
    fields.push_back(1);
    for (std::size_t i = 0; i + 1 < csv.size(); ++i) {
        if (csv[i] == '"') quoted = !quoted;
        if (csv[i] == ',' && !quoted) ++fields.back();
        if (csv[i] == '\n') fields.push_back(1);
    }
    CHECK(fields == std::vector<std::size_t>(3, fields[0]));
}
