#include "cachesim/report/report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "cachesim/report/timed_report.hpp"
#include "tests/cachesim/series.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

std::vector<Series> two_strategies() {
    return {series("rotation", {launch(0, counters(1000, 40000, 6000, 50000, 24000, 3000)),
                                launch(1, counters(1100, 43000, 6500, 56000, 26000, 3500))}),
            series("micro-jitter", {launch(0, counters(1000, 38000, 4700, 38000, 13000, 1500)),
                                    launch(1, counters(1080, 41000, 5000, 43000, 14000, 1800))})};
}

}  // namespace

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
        CHECK(r.rows[1].factors->product() == Approx(r.rows[1]["dram_bytes_ratio"]->mean).epsilon(1e-12));
        const Factors& f = *r.rows[1].factors;
        CHECK(f.product() / f.terms[4].mean == Approx(r.rows[1]["l2_bytes_ratio"]->mean).epsilon(1e-12));
    }
}

TEST_CASE("the factors of a small case are as computed by hand") {
    const Report r = make_report({series("a", {launch(0, counters(100, 4000, 800, 8000, 4000, 1000))}),
                                  series("b", {launch(0, counters(200, 4000, 400, 8000, 2000, 250))})},
                                 "a", GroupBy::ray);
    REQUIRE(r.rows.size() == 4);
    CHECK(r.rows[2].group == "camera");
    const Factors& f = *r.rows[2].factors;
    const auto means = {f.terms[0].mean, f.terms[1].mean, f.terms[2].mean, f.terms[3].mean, f.terms[4].mean};
    CHECK(std::vector<double>(means) == std::vector<double>{0.5, 0.5, 2, 0.5, 0.5});
    for (std::size_t i = 0; const IdentityTerm& term : identity_terms(2)) {
        const std::string key = term.key;
        for (std::size_t figure = 0; figure < std::size(traffic_figures); ++figure)
            if (traffic_figures[figure].key == key) CHECK(r.rows[2].figures[figure]->mean == f.terms[i].mean);
        ++i;
    }
    CHECK(r.rows[2]["dram_bytes_ratio"]->mean == 0.125);
    CHECK(r.rows[2]["dram_bytes_per_ray"]->mean == 32 * 250.0 / 200);
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
        bytes += row["dram_bytes_per_ray"]->mean;
    }
    CHECK(bytes == Approx(whole["dram_bytes_per_ray"]->mean));
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
    CHECK_FALSE(r.rows[1]["dram_bytes_ratio"]);
    all = two_strategies();
    all[1].launches[1].sample = 5;
    r = make_report(all, "rotation", GroupBy::none);
    REQUIRE(r.notes.size() == 1);
    CHECK_THAT(r.notes[0], Catch::Contains("sample indices differ"));
    CHECK_FALSE(r.rows[1].factors);
}

TEST_CASE("ratios across variants of a GPU are to the baseline on one of them, as if that were another strategy's") {
    std::vector<Series> small = two_strategies(), large = two_strategies();
    for (Series& s : large) s.gpu = "large";
    for (LaunchStatistics& l : large[0].launches) l = launch(l.sample, counters(1000, 40000, 6000, 50000, 12000, 900));
    std::vector<Series> all = small;
    all.insert(all.end(), large.begin(), large.end());
    const Report own = make_report(all, "rotation", GroupBy::none),
                 across = make_report(all, {"rotation", small[0].gpu}, GroupBy::none);
    CHECK_FALSE(own.rows[2]["l2_bytes_ratio"]);
    CHECK_FALSE(across.rows[0]["l2_bytes_ratio"]);
    Series renamed = large[0];
    renamed.strategy = "larger";
    renamed.gpu = small[0].gpu;
    const Report expected = make_report({small[0], renamed}, "rotation", GroupBy::none);
    CHECK(across.rows[2]["l2_bytes_ratio"]->mean == expected.rows[1]["l2_bytes_ratio"]->mean);
    CHECK(across.rows[2].factors->product() == expected.rows[1].factors->product());
    CHECK(across.rows[3]["dram_bytes_ratio"]->mean == own.rows[1]["dram_bytes_ratio"]->mean);  // the same launches
    CHECK(to_text(across).find("ratios to rotation on " + small[0].gpu) != std::string::npos);

    all[2].caches.levels = 3;
    const Report other = make_report(all, {"rotation", small[0].gpu}, GroupBy::none);
    CHECK_FALSE(other.rows[2]["l2_bytes_ratio"]);
    CHECK(other.notes.front().find("its caches have other levels or sectors") != std::string::npos);
}

TEST_CASE("thread maps are compared with one another where launches hold as many sample indices") {
    auto all = two_strategies();
    for (const char* map : {"classes:8", "rows", "samples"}) {
        all[1].thread_map = map;
        CHECK(make_report(all, "rotation", GroupBy::none).rows[1]["dram_bytes_ratio"].has_value());
    }
    all[1].indices = indices_per_launch("samples");
    CHECK_FALSE(make_report(all, "rotation", GroupBy::none).rows[1]["dram_bytes_ratio"].has_value());
    all[1].indices = indices_per_launch("rows");

    // A baseline with the row's own thread map comes first.
    all[1].thread_map = "classes:8";
    all.push_back(all[1]);
    all[2].strategy = "rotation";
    const Report own = make_report(all, "rotation", GroupBy::none);
    REQUIRE(own.rows[1]["dram_bytes_ratio"]);
    CHECK(own.rows[1]["dram_bytes_ratio"]->mean == Approx(1));
}

TEST_CASE("a strategy without parameters beside one with several is not called undefined") {
    auto all = two_strategies();
    all.push_back(all[1]);
    all[1].parameters = "K=1";
    all[2].parameters = "K=2.5";
    const std::string text = to_text(make_report(all, "rotation", GroupBy::none), any_width);
    CHECK_THAT(text, Catch::Contains("rotation      -  ") && !Catch::Contains("undefined"));
}

TEST_CASE("one sample index gives no interval and says so once") {
    auto all = two_strategies();
    for (Series& s : all) s.launches.resize(1);
    const Report r = make_report(all, "rotation", GroupBy::none);
    CHECK(r.notes == std::vector<std::string>{"one sample index: no confidence interval"});
    CHECK_FALSE(r.rows[0]["dram_bytes_per_ray"]->half_width);
    CHECK(to_text(r).find("±0") == std::string::npos);
    CHECK(to_text(r).find("undefined") == std::string::npos);
}

TEST_CASE("the text report is a readable table, as wide as it needs to be or of 100 columns") {
    const Report report = make_report(two_strategies(), "rotation", GroupBy::none);
    const std::string text = to_text(report, any_width);
    CHECK(text ==
          R"(all rows: N 64, GPU gtx-980-ti

strategy       rays  steps/ray  lanes/acc  sectors/acc  L1 %  L2 %  L2->L1 B/ray    DRAM B/ray    DRAM ratio
------------  -----  ---------  ---------  -----------  ----  ----  ------------  ------------  ------------
rotation      3 150       39.5       6.64         8.48  76.4  87.0   761.9 ±73.8  99.05 ±36.88      baseline
micro-jitter  3 120       38.0       8.14         8.35  83.3  87.8    415.4 ±7.5  50.77 ±33.83  0.513 ±0.151

rays: all sample indices together; step: one lane's visit to a node or triangle; acc: warp access;
L1 %: hits of load requests, as Nsight Compute counts (l1tex__t_sector_hit_rate); L2 %: of sectors
asked for; B/ray: bytes read, by launches that begin with cold caches; ±: half width of the 95 %
confidence interval over sample indices; DRAM ratio: DRAM B/ray over that of rotation.

Where the ratios to rotation come from; below 1 is better

all rows: N 64, GPU gtx-980-ti

strategy        work    SIMT   coal.  L1 loc.  =L2->L1  L2 loc.   =DRAM
------------  ------  ------  ------  -------  -------  -------  ------
micro-jitter   0.961   0.815   0.985    0.707    0.545    0.940   0.513
              ±0.134  ±0.113  ±0.178   ±0.073   ±0.043   ±0.202  ±0.151

work: steps/ray; SIMT (efficiency): warp accesses/step; coal.(escing): sectors/warp access; L1
loc.(ality): miss rate of visits, L2 loc.: miss rate of sectors asked for; each over the baseline's.
Their product is the ratio exactly.

micro-jitter, N 64, gtx-980-ti: 45.5 ±4.3 % fewer L2-to-L1 bytes/ray, most by L1 locality, x0.707
  ±0.073 (lower L1 miss rate of visits); 48.7 ±15.1 % fewer DRAM bytes/ray.
)");
    const std::string narrow = to_text(report);
    std::size_t start = 0;
    for (std::size_t end; (end = narrow.find('\n', start)) != std::string::npos; start = end + 1)
        CHECK(columns_of(narrow.substr(start, end - start)) <= 100);
}

TEST_CASE("with three levels the product of the factors is the traffic ratio, and tables have columns for L3") {
    auto all = two_strategies();
    CHECK(to_text(make_report(all, "rotation", GroupBy::none)).find("L3") == std::string::npos);
    CHECK(to_csv(make_report(all, "rotation", GroupBy::none)).find("l3") == std::string::npos);
    CHECK(to_json(make_report(all, "rotation", GroupBy::none)).find("l3") == std::string::npos);
    const std::vector<Series> two_levels = all;
    for (Series& s : all) {
        s.gpu = "cpu";
        s.caches.levels = 3;
        for (LaunchStatistics& one : s.launches) {
            Counters& c = one.groups[0].by_kind[0];
            c.levels[2].sectors = c.dram_sectors;
            c.dram_sectors = c.levels[2].sectors / 4;
            c.levels[1].hits = c.levels[1].sectors - c.levels[2].sectors;
            c.levels[2].hits = c.levels[2].sectors - c.dram_sectors;
        }
    }
    all.insert(all.end(), two_levels.begin(), two_levels.end());
    const Report r = make_report(all, "rotation", GroupBy::ray);
    const Row& camera = r.rows[2];
    REQUIRE(camera.factors);
    CHECK(camera.factors->product() == Approx(camera["dram_bytes_ratio"]->mean).epsilon(1e-12));
    CHECK(camera["l3_hit_rate"]->mean == Approx(0.75).epsilon(0.01));
    CHECK_FALSE(r.rows[4]["l3_hit_rate"]);
    CHECK(r.rows[6].factors->terms.size() == 5);
    CHECK_FALSE(r.rows[6]["l3_locality"]);
    const std::string text = to_text(r, any_width);
    for (const char* title : {" L3 % ", "L3->L2 B/ray", "L3 loc.", "=L3->L2"}) CHECK_THAT(text, Catch::Contains(title));
    const auto json = nlohmann::json::parse(to_json(r));
    CHECK(json["rows"][2]["l3_hit_rate"]["mean"] == camera["l3_hit_rate"]->mean);
    CHECK(json["rows"][4]["l3_hit_rate"].is_null());
    CHECK(json["rows"][2]["factors"].contains("l3_locality"));
    CHECK(json["rows"][6]["factors"]["l3_locality"]["mean"] == 1);
    const std::string csv = to_csv(r);
    const auto commas = [&](std::size_t from) {
        return std::count(csv.begin() + from, csv.begin() + csv.find('\n', from), ',');
    };
    CHECK(commas(0) == commas(csv.find('\n') + 1));
    CHECK_THAT(csv, Catch::Contains("l3_bytes_per_ray"));
}

TEST_CASE("a report of nothing still prints") {
    auto empty = series("rotation", {});
    CHECK_FALSE(to_text(make_report({}, "", GroupBy::none)).empty());
    CHECK_FALSE(to_csv(make_report({empty}, "rotation", GroupBy::none)).empty());
    const Report zero = make_report(
        {series("a", {launch(0, {}), launch(1, {})}), series("b", {launch(0, {}), launch(1, {})})}, "a", GroupBy::none);
    CHECK_THAT(to_text(zero), Catch::Contains("  - ") && Catch::Contains("-: undefined"));
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
        CHECK(json["rows"][i]["dram_bytes_per_ray"]["mean"].get<double>() == r.rows[i]["dram_bytes_per_ray"]->mean);
        CHECK(json["rows"][i]["dram_bytes_per_ray"]["half_width_95"].get<double>() ==
              *r.rows[i]["dram_bytes_per_ray"]->half_width);
        CHECK(json["rows"][i]["totals"]["dram_sectors"].get<std::uint64_t>() == r.rows[i].totals.dram_sectors);
    }
    CHECK(json.begin().key() == "baseline");
    CHECK(json["rows"][0].begin().key() == "scene");
    CHECK(json["by"] == "bounce");
}

TEST_CASE("names that are no UTF-8 end no program") {
    auto s = series("\xff\xfe", {launch(0, counters(1, 2, 3, 4, 3, 2))});
    CHECK_NOTHROW(to_json(make_report({s}, "", GroupBy::none)));
    TimedSeries timed;
    timed.scene = "\xff\xfe";
    timed.launches.resize(1);
    CHECK_NOTHROW(to_json(make_timed_report({timed}, "")));
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
