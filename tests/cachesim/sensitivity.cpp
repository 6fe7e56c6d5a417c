// Latin hypercubes, and what is said of speed-ups at many values: ranks, quantiles, verdicts.
#include "cachesim/analysis/sensitivity.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <set>

#include "cachesim/analysis/latin_hypercube.hpp"
#include "cachesim/report/sensitivity_report.hpp"

using namespace raycache;
using namespace raycache::cachesim;

namespace {

GpuRange between(const std::string& low, const std::string& high) { return {false, {low, high}, "why"}; }
GpuRange among(std::vector<std::string> values) { return {true, std::move(values), "why"}; }

VariedPoint point(const std::string& key, const std::string& value, const Estimate& speed_up, const Estimate& change) {
    return {{{key, value}}, change, speed_up, speed_up};
}

/// 1.05 with the file's values; "a" moves it to 0.98 and 1.10, "b" hardly.
Sensitivity undecided() {
    Sensitivity s;
    s.gpu = "card";
    s.strategy = "micro-jitter";
    s.baseline = "cranley-patterson";
    s.per_index = s.per_ray = {1.05, 0.02};
    s.open = {{"b", "x", "assumed", among({"x", "y", "z"})}, {"a", "3", "assumed", between("1", "9")}};
    s.one_by_one = {point("b", "y", {1.06, 0.02}, {1.01, 0.02}), point("b", "z", {1.04, 0.02}, {0.99, 0.02}),
                    point("a", "1", {0.98, 0.01}, {0.93, 0.01}), point("a", "9", {1.10, 0.01}, {1.05, 0.01})};
    return s;
}

Sensitivity decided(double mean, double half_width) {
    Sensitivity s = undecided();
    s.per_index = s.per_ray = {mean, 0.01};
    for (VariedPoint& p : s.one_by_one) p.per_index = p.per_ray = {mean, half_width};
    return s;
}

}  // namespace

TEST_CASE("a Latin hypercube has one point in each stratum of every dimension") {
    for (const std::size_t n : {1, 2, 7, 32}) {
        const auto points = latin_hypercube(n, 5, 3);
        REQUIRE(points.size() == n);
        for (std::size_t d = 0; d < 5; ++d) {
            std::set<std::size_t> strata;
            for (const auto& x : points) {
                CHECK((x[d] >= 0 && x[d] < 1));
                strata.insert(static_cast<std::size_t>(x[d] * static_cast<double>(n)));
            }
            CHECK(strata.size() == n);
        }
    }
    CHECK(latin_hypercube(0, 3, 1).empty());
    CHECK(latin_hypercube(2, 0, 1) == std::vector<std::vector<double>>(2));
}

TEST_CASE("a Latin hypercube is the same for a seed, and another for another") {
    CHECK(latin_hypercube(8, 3, 1) == latin_hypercube(8, 3, 1));
    CHECK(latin_hypercube(8, 3, 1) != latin_hypercube(8, 3, 2));
    const auto x = latin_hypercube(32, 2, 1);
    std::set<bool> in_step;  // dimensions are not permuted alike
    for (const auto& p : x) in_step.insert(static_cast<int>(p[0] * 32) == static_cast<int>(p[1] * 32));
    CHECK(in_step.contains(false));
}

TEST_CASE("values of a range lie between its ends, whole where these are, and choices have equal parts") {
    std::set<std::string> whole;
    for (int i = 0; i < 100; ++i) whole.insert(value_at(between("3", "6"), i / 100.0));
    CHECK(whole == std::set<std::string>{"3", "4", "5", "6"});
    CHECK(value_at(between("2", "2.5"), 0.5) == "2.25");
    CHECK(value_at(between("0.5", "4"), 0) == "0.5");
    CHECK(value_at(among({"a", "b", "c", "d"}), 0.49) == "b");
    CHECK(value_at(among({"a", "b", "c", "d"}), 0.999999) == "d");
}

TEST_CASE("values are ranked by how far they move the speed-up") {
    const auto effects = ranked_effects(undecided());
    REQUIRE(effects.size() == 2);
    CHECK(effects[0].key == "a");
    CHECK(effects[0].low_value == "1");
    CHECK(effects[0].high_value == "9");
    CHECK(effects[0].swing == Approx(0.12));
    CHECK(effects[0].certain);
    CHECK(effects[1].key == "b");
    CHECK(effects[1].low_value == "z");  // of choices the slowest, and the fastest
    CHECK(effects[1].high_value == "y");
    CHECK_FALSE(effects[1].certain);
}

TEST_CASE("a value that moves the speed-up across 1 for certain leaves the verdict open, and is named") {
    const SensitivityVerdict verdict = verdict_of(undecided(), Per::index);
    CHECK(verdict.outcome == Outcome::not_known);
    CHECK(verdict.text == "not known, depends on a (1.050 ±0.020 at 3, 0.980 ±0.010 at 1)");
    Sensitivity unsure = undecided();
    unsure.one_by_one[2].change = {0.93, 0.2};
    CHECK_THAT(verdict_of(unsure, Per::index).text,
               Catch::StartsWith("not known: 1.050 ±0.020 with the file's values"));
    unsure.hypercube = {{{{"a", "1"}, {"b", "z"}}, {0.9, 0.01}, {0.95, 0.02}, {0.95, 0.02}}};
    CHECK(verdict_of(unsure, Per::index).text == "not known, depends on several values together, most on a, b");
}

TEST_CASE("only a speed-up that is certain at every point is faster, or slower, whatever is assumed") {
    CHECK(verdict_of(decided(1.05, 0.02), Per::index).outcome == Outcome::faster);
    CHECK_THAT(verdict_of(decided(1.05, 0.02), Per::index).text,
               Catch::StartsWith("faster whatever is assumed: 1.050"));
    CHECK(verdict_of(decided(0.9, 0.02), Per::ray).outcome == Outcome::slower);
    const SensitivityVerdict open = verdict_of(decided(1.05, 0.2), Per::index);
    CHECK(open.outcome == Outcome::not_known);
    CHECK_THAT(open.text, Catch::StartsWith("not known: faster by all that is assumed"));
    Sensitivity s = decided(1.05, 0.02);
    s.hypercube = {{{{"a", "1"}}, {1, 0.1}, {1.05, 0.1}, {1.05, 0.1}}};
    CHECK(verdict_of(s, Per::index).outcome == Outcome::not_known);
    s.one_by_one[0].per_index.half_width.reset();  // one launch: nothing is certain
    CHECK(verdict_of(s, Per::index).outcome == Outcome::not_known);
}

TEST_CASE("per index and per ray are told apart where rays differ") {
    const TimedSums base{{100, 110}, {10, 11}}, other{{100, 110}, {11, 12.1}};
    CHECK(speed_up_per_index(base, other).mean == Approx(1));
    CHECK(speed_up_per_ray(base, other).mean == Approx(1.1));
    CHECK(*speed_up_per_ray(base, other).half_width == Approx(0).margin(1e-9));
}

TEST_CASE("what a small sample says of a change is multiplied with what a large one says of the speed-up") {
    Sensitivity at_file;
    at_file.per_index = {1.2, 0.12};
    at_file.per_ray = {1.1, 0.11};
    const TimedSums base{{200, 220}, {1, 1}}, other{{100, 110}, {1, 1}}, base_file{{150, 165}, {1, 1}};
    const VariedPoint p = varied_point({{"a", "1"}}, base, other, base_file, other, at_file, false);
    CHECK(p.change.mean == Approx(200.0 / 150));
    CHECK(p.per_index.mean == Approx(1.2 * 200 / 150));
    CHECK(*p.per_index.half_width == Approx(0.1 * 1.2 * 200 / 150));  // the change itself is certain here
    CHECK(p.per_ray.mean == Approx(1.1 * 200 / 150));
    CHECK(varied_point({{"a", "1"}}, base, other, base_file, other, at_file, true).per_index.mean == Approx(2));
}

TEST_CASE("quantiles of the hypercube lie between its points") {
    Sensitivity s = undecided();
    CHECK(hypercube_quantile(s, 0.5) == 0);
    for (const double mean : {1.3, 1.1, 1.2}) s.hypercube.push_back(point("a", "1", {mean, 0.1}, {1, 0.1}));
    CHECK(hypercube_quantile(s, 0) == Approx(1.1));
    CHECK(hypercube_quantile(s, 0.25) == Approx(1.15));
    CHECK(hypercube_quantile(s, 1) == Approx(1.3));
}

TEST_CASE("a report says speed-ups, the range, the ranking, the verdict, and what is not read") {
    SensitivityReport report{{undecided()}, "16 windows, 8 with other values", "scale model of 2 SMs"};
    report.rows.front().unread = {"rt_unit.warps"};
    report.rows.front().hypercube = {point("a", "2", {1.01, 0.1}, {1, 0.1})};
    const std::string text = to_text(report);
    for (const char* words :
         {"card, micro-jitter over cranley-patterson: 1.050 ±0.020 per sample index, 1.050 ±0.020 per ray",
          "1 points of the hypercube, per sample index: 1.010 to 1.010", "Verdict: not known, depends on a",
          "Not read by these replays, so without effect: rt_unit.warps", "scale model of 2 SMs"}) {
        std::string flat = text;
        for (std::size_t at = 0; (at = flat.find("\n    ", at)) != std::string::npos;) flat.replace(at, 5, " ");
        for (char& c : flat)
            if (c == '\n') c = ' ';
        CHECK_THAT(flat, Catch::Contains(words));
    }
    CHECK(text.find("a ") < text.find("b "));
    const std::string csv = to_csv(report);
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 1 + 4 + 1);
    CHECK_THAT(to_json(report), Catch::Contains("\"outcome\": \"not_known\""));
}
