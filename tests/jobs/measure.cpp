// The job "measure": what it walks, its control and its ratios. Times are not tested: they are the machine's.
#include <catch2/catch.hpp>

#include "tests/jobs/small_jobs.hpp"
#include "tools/jobs/measure_report.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tools;
using Catch::Contains;

namespace {

MeasureJob small_job() {
    const LaunchSettings launches = test::small_launches({"cranley-patterson", "coherent"});
    MeasureJob job;
    job.scene = launches.scene;
    job.sampling = launches.sampling;
    job.cases = launches.cases;
    job.modes = {"single"};
    job.repeats = 1;
    return job;
}

MeasuredWalk walk(const std::string& strategy, bool control, std::vector<double> rays, std::vector<double> seconds) {
    MeasuredWalk w;
    w.strategy = strategy;
    w.spp = 64;
    w.seed = control ? 2 : 1;
    w.control = control;
    w.mode = "single";
    w.order = "warp";
    w.group = "all";
    w.rays = std::move(rays);
    w.seconds = std::move(seconds);
    return w;
}

MeasureResult result_of(std::vector<MeasuredWalk> walks) {
    MeasureResult result;
    result.baseline = "cranley-patterson";
    result.repeats = 1;
    result.walks = std::move(walks);
    return result;
}

}  // namespace

TEST_CASE("measure: every strategy has a row per mode, order and group, and the baseline a control with its indices") {
    MeasureJob job = small_job();
    job.by = RayGroups::ray;
    test::Listener listener;
    const MeasureResult result = run(job, listener);
    CHECK(result.walks.size() == 3 * 2 * 4);  // strategies, orders, groups
    CHECK(listener.ended_well);
    double all = 0, groups = 0;
    for (const MeasuredWalk& w : result.walks) {
        CHECK(w.rays.size() == 2);
        CHECK(w.other_ends == 0);
        for (const double seconds : w.seconds) CHECK(seconds > 0);
        (w.group == "all" ? all : groups) += w.rays[0] + w.rays[1];
    }
    CHECK(all == groups);
    REQUIRE(result.subject.traces.size() == 3);
    const Json &base = result.subject.traces.front(), &control = result.subject.traces.back();
    CHECK(control["strategy"] == "cranley-patterson");
    CHECK(control["samples"] == base["samples"]);
    CHECK(control["seed"] != base["seed"]);
}

TEST_CASE("measure: shuffled walks have the same rays, and rays depend on nothing but the settings") {
    test::Listener listener;
    const MeasureResult once = run(small_job(), listener), again = run(small_job(), listener);
    for (std::size_t i = 0; i < once.walks.size(); ++i) {
        CHECK(once.walks[i].rays == again.walks[i].rays);
        for (const MeasuredWalk& other : once.walks)
            if (other.strategy == once.walks[i].strategy && other.control == once.walks[i].control)
                CHECK(other.rays == once.walks[i].rays);
    }
}

TEST_CASE("measure: a speed-up is time per ray of the baseline over that of the strategy, and per index without rays") {
    const MeasureReport report = make_measure_report(
        result_of({walk("cranley-patterson", false, {100, 100}, {2, 2}), walk("coherent", false, {200, 200}, {2, 2}),
                   walk("random", false, {100, 100}, {4, 4})}));
    CHECK_FALSE(report.rows[0].speed_up);
    CHECK(report.rows[1].speed_up->mean == Approx(2));
    CHECK(report.rows[1].speed_up_per_index->mean == Approx(1));
    CHECK(report.rows[2].speed_up->mean == Approx(0.5));
    CHECK(report.rows[0].ns_per_ray.mean == Approx(2e7));
    CHECK(report.warnings.empty());
}

TEST_CASE("measure: warns of a control whose interval does not hold 1, and of no other") {
    const std::vector<double> rays{100, 100, 100};
    const auto warnings = [&](std::vector<double> control_seconds) {
        return make_measure_report(result_of({walk("cranley-patterson", false, rays, {2, 2, 2}),
                                              walk("cranley-patterson", true, rays, std::move(control_seconds))}))
            .warnings;
    };
    CHECK(warnings({2.02, 1.98, 2.01}).empty());
    REQUIRE(warnings({1.51, 1.5, 1.49}).size() == 1);
    CHECK_THAT(warnings({1.51, 1.5, 1.49}).front(), Contains("seed 2") && Contains("single"));
}

TEST_CASE("measure: what cannot be measured is refused in one line") {
    test::Listener listener;
    const auto refusal = [&](const auto& change) -> std::string {
        MeasureJob job = small_job();
        change(job);
        try {
            run(job, listener);
            return {};
        } catch (const Error& e) {
            return e.what();
        }
    };
    CHECK_THAT(refusal([](MeasureJob& job) { job.modes = {"packet3"}; }), Contains("expected one of: single"));
    CHECK_THAT(refusal([](MeasureJob& job) { job.repeats = 0; }), Contains("at least 1"));
    CHECK_THAT(refusal([](MeasureJob& job) { job.cases.clear(); }), Contains("no strategy"));
    CHECK_THAT(refusal([](MeasureJob& job) { job.baseline = "owen"; }), Contains("'owen'"));
    CHECK_THAT(refusal([](MeasureJob& job) { job.sampling.execution = "wavefront"; }), Contains("wavefront"));
    CHECK_THAT(refusal([](MeasureJob& job) { job.cases.back().strategy.thread_map = "samples"; }),
               Contains("different launches"));
    const tracer::EmbreeFacts facts = tracer::embree_facts();
    for (const tracer::WalkMode& mode : tracer::walk_modes()) {
        if (facts.walks(mode)) continue;
        CHECK_THAT(refusal([&](MeasureJob& job) { job.modes = {mode.name}; }), Contains("no packets of"));
    }
}
