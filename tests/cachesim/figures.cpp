// The lists of figures: what every report, file and page follows.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <string>
#include <string_view>

#include "cachesim/report/profiler.hpp"
#include "cachesim/report/timed_report.hpp"
#include "tests/cachesim/series.hpp"

using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using nlohmann::json;

namespace {

template <class List>
void check_texts(const List& list) {
    std::set<std::string_view> keys;
    for (const auto& figure : list) {
        CAPTURE(figure.key);
        CHECK(keys.insert(figure.key).second);
        CHECK(std::string_view(figure.title).find('\n') == std::string_view::npos);
        CHECK_FALSE(std::string_view(figure.title).empty());
        CHECK_FALSE(std::string_view(figure.unit).empty());
        const std::string_view definition = figure.definition;
        CHECK(definition.size() > 10);
        CHECK(definition.find('\n') == std::string_view::npos);
        CHECK_FALSE(definition.ends_with('.'));
        CHECK((figure.legend == nullptr) == (figure.subject == nullptr));
        CHECK((figure.of != Of::total || !figure.denominator));
    }
}

/// Whether every row has a value, perhaps null, where `figures` says it is.
void check_paths(const json& report) {
    REQUIRE(report["figures"].size() > 20);
    for (const json& figure : report["figures"])
        for (const json& row : report["rows"]) {
            CAPTURE(figure.dump());
            const json* value = &row;
            for (const json& key : figure["path"])
                if (!value->is_null()) {
                    REQUIRE(value->contains(key.get<std::string>()));
                    value = &(*value)[key.get<std::string>()];
                }
        }
}

std::vector<Series> two_strategies(std::size_t levels) {
    std::vector<Series> all;
    for (const std::uint64_t n : {1, 2}) {
        all.push_back(series(n == 1 ? "a" : "b", {launch(0, counters(100, 4000, 800, 8000 / n, 4000 / n, 1000)),
                                                  launch(1, counters(100, 4100, 820, 8400 / n, 4100 / n, 990))}));
        all.back().caches.levels = levels;
        for (LaunchStatistics& one : all.back().launches) {
            Counters& c = one.groups[0].by_kind[0];
            if (levels == 3) c.levels[2] = {c.dram_sectors * 2, c.dram_sectors};
        }
    }
    return all;
}

}  // namespace

TEST_CASE("every figure has a key of its own, a title, a unit and a definition in one sentence") {
    check_texts(traffic_figures);
    check_texts(timed_figures);
}

TEST_CASE("the figures of a report in JSON say where their values are") {
    for (const std::size_t levels : {2, 3})
        check_paths(json::parse(to_json(make_report(two_strategies(levels), "a", GroupBy::none))));
    std::vector<TimedSeries> times;
    for (const Series& s : two_strategies(2)) {
        TimedSeries& timed = times.emplace_back();
        static_cast<Origin&>(timed) = s;
        timed.launches.resize(2);
        for (std::uint32_t i = 0; i < 2; ++i) timed.launches[i].sample = i;
        timed.launches[0].cycles = timed.launches[1].cycles = 1000;
    }
    const json report = json::parse(to_json(make_timed_report(times, "a", two_strategies(2))));
    check_paths(report);
    CHECK(report["figures"].back()["key"] == "visit_latency");
}

TEST_CASE("the columns of a table are figures, and so are the fields of CSV") {
    const Report report = make_report(two_strategies(3), "a", GroupBy::none);
    const std::string text = to_text(report, any_width), csv = to_csv(report);
    const std::string titles = ',' + csv.substr(0, csv.find('\n')) + ',';
    for (const TrafficFigure& figure : traffic_figures) {
        if (figure.presence == Presence::wavefront) continue;
        CAPTURE(figure.key);
        CHECK(titles.find(std::string(",") + figure.key + ',') != std::string::npos);
        if (figure.column) CHECK(text.find(figure.column) != std::string::npos);
        if (figure.legend && !figure.is_compared()) CHECK(text.find(std::string(figure.subject)) != std::string::npos);
    }
}

TEST_CASE("a figure that names a metric of the profiler has its value") {
    std::vector<ProfiledSeries> series;
    for (const Series& s : two_strategies(2)) {
        static_cast<Series&>(series.emplace_back()) = s;
        series.back().instructions = s.launches;
    }
    const ProfilerReport made = make_profile(series, "", GroupBy::none);
    const Row& row = made.report.rows[0];
    std::map<std::string, double> metrics;
    const json profile = json::parse(to_json(made));
    for (const json& metric : profile["rows"][0]["metrics"])
        if (!metric["value"].is_null()) metrics[metric["name"]] = metric["value"];
    int named = 0;
    for (const TrafficFigure& figure : traffic_figures) {
        if (!figure.profiler) continue;
        CAPTURE(figure.key);
        REQUIRE(metrics.contains(figure.profiler));
        const double scale = std::string_view(figure.profiler).ends_with(".pct") ? 100 : 1;
        CHECK(scale * figure.value(row.totals, row.caches) == Approx(metrics[figure.profiler]).epsilon(1e-12));
        ++named;
    }
    CHECK(named >= 5);
}

TEST_CASE("each numerator of the traffic identity is the next denominator") {
    std::mt19937_64 random(3);
    for (const std::size_t levels : {2, 3}) {
        Counters c;
        c.rays = random() % 1000 + 1;
        c.steps = random() % 1000 + 1;
        c.warp_accesses = random() % 1000 + 1;
        for (std::size_t level = 0; level < levels; ++level) c.levels[level].sectors = random() % 1000 + 1;
        c.dram_sectors = random() % 1000 + 1;
        const auto terms = identity_terms(levels);
        const CacheUnits units{levels, 32};
        CHECK(terms.size() == terms_before_caches + levels);
        CHECK(terms.front().denominator(c, units) == c.rays);
        for (std::size_t i = 1; i < terms.size(); ++i)
            CHECK(terms[i - 1].numerator(c, units) == terms[i].denominator(c, units));
        CHECK(terms.back().numerator(c, units) == c.dram_sectors);
    }
}
