// Launches from cold caches beside estimates of the steady state, in reports.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "cachesim/report/cold_launches.hpp"
#include "series.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using Catch::Matchers::Contains;

namespace {

struct Compared {
    std::vector<Series> steady;
    std::vector<TimedSeries> times;
    std::vector<ColdLaunches> cold;
};

/// Two strategies of two blocks; the second one is twice as fast in every respect.
Compared compared(std::size_t launches = 1) {
    Compared all;
    for (const std::uint64_t k : {2, 1}) {
        const std::string name = k == 2 ? "cranley-patterson" : "micro-jitter";
        Series s = series(name, {launch(0, counters(100, 1000, 500, 2000, 100 * k, 10 * k)),
                                 launch(64, counters(100, 1000, 500, 2000, 110 * k, 12 * k))});
        s.windows = WindowSample{2, 64, 8, 2, 1.5, 0, true};
        TimedSeries t;
        static_cast<Origin&>(t) = s;
        t.launches.resize(2);
        t.launches[0].cycles = 900 * k;
        t.launches[1].cycles = 1100 * k;
        for (TimedStatistics& block : t.launches) block.rays = block.warp_accesses = 500;
        ColdLaunches cold;
        for (std::uint32_t i = 0; i < launches; ++i) {
            cold.launches.push_back(launch(5 + i, counters(100, 1000, 500, 2000, 150 * k, 100 * k)));
            cold.stages.push_back({5 + i, {300 * k, 100}, {600 * k, 300}, {400 * k + 7 * i, 100}});
        }
        all.steady.push_back(s);
        all.times.push_back(t);
        all.cold.push_back(cold);
    }
    return all;
}

TimedReport timed_report(const Compared& c) {
    return make_timed_report(c.times, "cranley-patterson", c.steady, c.cold);
}

}  // namespace

TEST_CASE("cold launches take their steady state times their factors, with its interval") {
    const TimedReport report = timed_report(compared());
    REQUIRE(report.cold.size() == 2);
    const ColdFigures::Time& time = *report.cold[1].time;
    CHECK(time.cycles == 1300);
    CHECK(time.steady_cycles.mean == Approx(1000));  // 500 accesses at 2 cycles
    CHECK(time.over_steady.mean == Approx(1.3));
    CHECK(time.cold.mean == Approx(1));
    CHECK(time.cold.mean * time.ramp.mean * time.tail.mean == Approx(1.3));
    CHECK(time.full_share.mean == Approx(0.6));
    REQUIRE(report.rows[1]["cycles_per_ray"]->half_width);
    const double relative = *report.rows[1]["cycles_per_ray"]->half_width / report.rows[1]["cycles_per_ray"]->mean;
    CHECK(*time.steady_cycles.half_width == Approx(1000 * relative));  // widened as that is
    CHECK(*time.over_steady.half_width == Approx(1.3 * relative));
    CHECK(*time.cold.half_width == Approx(relative));
    CHECK_FALSE(time.ramp.half_width);
    REQUIRE(time.speed_up);
    CHECK(time.speed_up->mean == Approx(2));
    CHECK_FALSE(time.speed_up->half_width);
    CHECK_FALSE(report.cold[0].time->speed_up);  // of the baseline
}

TEST_CASE("several cold launches are added up, and their speed-up has an interval") {
    const TimedReport report = timed_report(compared(3));
    const ColdFigures::Time& time = *report.cold[1].time;
    CHECK(time.cycles == 3 * 1300 + 7 * 3);
    CHECK(report.cold[1].samples == std::vector<std::uint32_t>{5, 6, 7});
    REQUIRE(time.speed_up->half_width);
    CHECK(*time.speed_up->half_width > 0);
}

TEST_CASE("bytes of cold launches are held against those of the steady state, access by access") {
    Compared c = compared();
    for (const bool full : {true, false}) {
        for (Series& s : c.steady) s.windows->last_cache_full = full;
        const Report report = make_report(c.steady, "cranley-patterson", GroupBy::none, c.cold);
        REQUIRE(report.cold.size() == 2);
        const std::vector<ColdFigures::Bytes>& bytes = report.cold[1].bytes;
        REQUIRE(bytes.size() == 2);
        CHECK(bytes[0].over_steady->mean == Approx(150.0 / 105));
        CHECK(*bytes[0].over_steady->half_width > 0);
        CHECK(bytes[1].over_steady.has_value() == full);  // below a cache that is not full nothing steady is known
        if (full) CHECK(bytes[1].over_steady->mean == Approx(100.0 / 11));
        CHECK_FALSE(report.cold[1].time);
    }
}

TEST_CASE("a steady state without intervals, or of nothing, gives cold launches none") {
    Compared c = compared();
    for (TimedSeries& t : c.times) t.launches.resize(1);
    for (Series& s : c.steady) s.launches.resize(1);
    CHECK_FALSE(timed_report(c).cold[1].time->cold.half_width);
    for (TimedSeries& t : c.times) t.launches[0].warp_accesses = t.launches[0].cycles = 0;
    const TimedReport report = timed_report(c);
    CHECK_FALSE(report.cold[1].time->over_steady.mean == report.cold[1].time->over_steady.mean);
    CHECK_THAT(to_text(report), Contains("-: not known"));
}

TEST_CASE("every form of a report shows cold launches, and none where there are none") {
    const Compared c = compared();
    const TimedReport timed = timed_report(c);
    const Report counted = make_report(c.steady, "cranley-patterson", GroupBy::none, c.cold);
    CHECK_THAT(to_text(timed), Contains("One launch (sample index 5) from cold caches beside the steady state") &&
                                   Contains("launch/steady") && Contains("ramp"));
    CHECK_THAT(to_text(counted), Contains("from cold caches beside the steady state"));
    const auto row = nlohmann::json::parse(to_json(timed)).at("rows").at(1).at("cold_launches");
    CHECK(row.at("samples") == std::vector<int>{5});
    CHECK(row.at("cycles") == 1300);
    CHECK(row.at("over_steady").at("mean") == Approx(1.3));
    CHECK(row.at("dram_bytes_over_steady").at("mean") == Approx(100.0 / 11));
    CHECK(nlohmann::json::parse(to_json(counted)).at("rows").at(1).at("cold_launches").contains("l2_bytes_per_ray"));
    for (const std::string& csv : {to_csv(timed), to_csv(counted)}) {
        const auto fields = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
        const std::string titles = csv.substr(0, csv.find('\n'));
        CHECK_THAT(titles, Contains("cold_samples") && Contains("cold_dram_bytes_over_steady_ci95"));
        const std::string last = csv.substr(csv.rfind('\n', csv.size() - 2) + 1);
        CHECK(fields(last) >= fields(titles));  // a verdict may hold commas
    }

    const TimedReport without = make_timed_report(c.times, "cranley-patterson", c.steady);
    CHECK_THAT(to_text(without) + to_json(without) + to_csv(without), !Contains("cold_") && !Contains("ramp"));
}
