// Levels of accuracy that a pilot chooses from.
#include "tools/jobs/windows/fidelity.hpp"

#include <tbb/task_arena.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "small_jobs.hpp"
#include "tools/jobs/replay_job.hpp"
#include "tools/jobs/windows/steady_replay.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/scene/scene.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tools;
using Catch::Matchers::Contains;

namespace {

const std::vector<std::string> two{"cranley-patterson", "coherent"};

LaunchSettings launches_of(const std::vector<std::string>& strategies, std::uint64_t spp,
                           const std::string& resolution = "32x24") {
    LaunchSettings launches = test::small_launches(strategies);
    launches.sampling.bounces = 1;
    launches.sampling.resolution = resolution;
    for (CaseSettings& one : launches.cases) one.spp = spp;
    return launches;
}

GpuSettings one_sm() {
    GpuSettings gpu;
    gpu.names = {"rtx-3070"};
    gpu.changes = {"sms=1", "warps_per_cta=2", "max_warps_per_sm=8", "l2.ways=1"};
    return gpu;
}

const tracer::PreparedScene& courtyard() {
    static const tracer::PreparedScene prepared = [] {
        tracer::SceneRequest request;
        request.source = "courtyard";
        request.detail = 50000;
        return tracer::PreparedScene(load_scene(request, [](const std::string&) {}), {});
    }();
    return prepared;
}

WindowSizes few() {
    WindowSizes sizes;
    sizes.indices = 2;
    sizes.work_groups = 8;
    sizes.sm_windows = 8;
    sizes.windows = sizes.timed_windows = 2;
    return sizes;
}

Estimated chosen(const std::vector<std::string>& strategies, double target, int threads, Observer& observer,
                 std::uint64_t spp = 1024, const std::string& baseline = {}) {
    EstimateSettings settings;
    settings.windows = true;
    settings.fidelity = Fidelity::automatic;
    settings.target_error = target;
    settings.baseline = baseline;
    const auto gpus = one_sm().load({});
    tbb::task_arena arena(threads);
    return arena.execute([&] {
        return estimate_at_fidelity(courtyard(), strategies_of(launches_of(strategies, spp)), settings, gpus, observer,
                                    few());
    });
}

double relative(const cachesim::Estimate& e) { return *e.half_width / e.mean; }

ReplayJob job_of(std::uint64_t spp, const std::string& resolution, Fidelity fidelity) {
    ReplayJob job;
    job.launches = launches_of(two, spp, resolution);
    job.gpu = one_sm();
    job.timed = true;
    job.estimate.windows = true;
    job.estimate.fidelity = fidelity;
    return job;
}

}  // namespace

TEST_CASE("What a pilot chooses reaches the target, is the cheapest that does, and says so", "[slow]") {
    for (const double target : {0.5, 0.05}) {
        Observer silent;
        const Estimated answer = chosen(two, target, 2, silent);
        REQUIRE(answer.fidelity);
        const cachesim::FidelityChoice& choice = *answer.fidelity;
        CAPTURE(target, choice.picked, choice.reason);
        REQUIRE_FALSE(choice.levels.empty());
        REQUIRE(choice.pilots.size() == 1);
        CHECK(choice.target == target);
        CHECK_FALSE(choice.reason.empty());
        const cachesim::FidelityChoice::Pilot& pilot = choice.pilots.front();
        CHECK(pilot.difference.mean == Approx(pilot.by_time.mean / pilot.by_work.mean));
        const auto cheapest =
            std::min_element(choice.levels.begin(), choice.levels.end(), [](const auto& a, const auto& b) {
                return (a.suffices ? a.seconds : 1e300) < (b.suffices ? b.seconds : 1e300);
            });
        if (!choice.reason.ends_with("takes over")) CHECK(choice.picked == cheapest->name);
        if (choice.picked == "exact") continue;
        const cachesim::TimedSeries& own = answer.result.times.at(1);
        REQUIRE(own.speed_up);
        CHECK(relative(*own.speed_up) <= target);
        CHECK_FALSE(answer.result.times.at(0).speed_up);
        const auto report = make_timed_report(answer.result.times, two[0], answer.result.traffic);
        CHECK(report.rows.at(1)["speed_up"]->mean == own.speed_up->mean);
        CHECK(report.rows.at(1)["speed_up"]->half_width == own.speed_up->half_width);
    }
}

TEST_CASE("The choice and its answer do not depend on threads") {
    for (const double target : {0.2}) {
        Observer silent;
        const Estimated a = chosen(two, target, 1, silent), b = chosen(two, target, 2, silent);
        CHECK(a.fidelity->picked == b.fidelity->picked);
        CHECK(a.fidelity->reason == b.fidelity->reason);
        for (std::size_t i = 0; i < 2; ++i) {
            CHECK(a.result.traffic[i].launches == b.result.traffic[i].launches);
            CHECK(a.result.times[i].speed_up.has_value() == b.result.times[i].speed_up.has_value());
        }
        if (a.result.times[1].speed_up) CHECK(a.result.times[1].speed_up->mean == b.result.times[1].speed_up->mean);
    }
}

TEST_CASE("Strategies that are the same differ in nothing, which a pilot is certain of") {
    Observer silent;
    const Estimated answer = chosen({"micro-jitter", "micro-jitter@tile"}, 1e-6, 2, silent, 1024, "micro-jitter");
    CHECK(answer.fidelity->picked == "timed");
    CHECK_THAT(answer.fidelity->reason, Contains("the pilot itself"));
    CHECK(answer.result.times[1].speed_up->mean == 1);
    CHECK(*answer.result.times[1].speed_up->half_width == 0);
}

TEST_CASE("A picture whose every sample costs no more than a pilot is replayed as a whole, without one") {
    test::Listener listener;
    const ReplayResult automatic = run(job_of(4, "16x8", Fidelity::automatic), listener);
    REQUIRE(automatic.fidelity);
    CHECK(automatic.fidelity->picked == "exact");
    CHECK(automatic.fidelity->pilots.empty());
    CHECK(listener.begun == std::vector<std::string>{"load", "all samples"});
    Observer silent;
    const ReplayResult exact = run(job_of(4, "16x8", Fidelity::exact), silent);
    CHECK_FALSE(exact.fidelity);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(automatic.series[i].launches == exact.series[i].launches);
        CHECK(automatic.times[i].launches[0].cycles == exact.times[i].launches[0].cycles);
    }
    const std::string text = result_text(automatic);
    CHECK(result_text(std::get<ReplayResult>(parse_result(text, "it"))) == text);
}

TEST_CASE("Exact replay counts every ray of every sample index once, and is exact") {
    Observer silent;
    const ReplayJob exact = job_of(4, "16x8", Fidelity::exact);
    const ReplayResult steady = run(exact, silent);
    ReplayJob whole = exact;
    whole.estimate = {};
    whole.launches.sampling.trace_samples = 4;
    const ReplayResult cold = run(whole, silent);
    for (std::size_t s = 0; s < 2; ++s) {
        std::uint64_t rays = 0, accesses = 0;
        for (const auto& launch : cold.series[s].launches) {
            rays += launch.all().rays;
            accesses += launch.all().warp_accesses;
        }
        REQUIRE(steady.series[s].launches.size() == 1);
        CHECK(steady.series[s].launches[0].all().rays == rays);
        CHECK(steady.series[s].launches[0].all().warp_accesses == accesses);
        CHECK(steady.series[s].windows->all_indices);
        CHECK(steady.series[s].windows->indices == 4);
        CHECK(steady.times[s].launches[0].cycles > 0);
    }
    const auto report = make_timed_report(steady.times, two[0], steady.series);
    CHECK(report.rows[1]["speed_up"]->half_width == 0);
    CHECK(report.traffic.rows[1]["l2_bytes_ratio"]->half_width == 0);
    CHECK_THAT(to_text(report), Contains("all 4 sample indices were replayed") && !Contains("one sample index"));
    CHECK_THAT(to_json(report), Contains("\"all_indices\": true"));
}

TEST_CASE("One pixel and one sample index have an answer, too") {
    test::Listener listener;
    const ReplayResult answer = run(job_of(1, "1x1", Fidelity::automatic), listener);
    CHECK(answer.fidelity->picked == "exact");
    CHECK(answer.times[1].launches[0].cycles > 0);
    CHECK((listener.running == 0 && listener.ended_well));
}

TEST_CASE("A level that makes no sense is refused before anything runs") {
    test::Listener listener;
    const auto refused = [&](const ReplayJob& job, const std::string& words) {
        CHECK_THROWS_WITH(run(job, listener), Contains(words));
    };
    ReplayJob job = job_of(64, "32x24", Fidelity::automatic);
    job.timed = false;
    refused(job, "expected timed");
    job = job_of(64, "32x24", Fidelity::automatic);
    job.estimate.window_count = 8;
    refused(job, "expected a target error alone");
    job.estimate.window_count = 0;
    job.estimate.time_budget = 3;
    refused(job, "expected a target error alone");
    job = job_of(64, "32x24", Fidelity::automatic);
    job.gpu.names = {"xeon-8380"};
    job.gpu.changes = {};
    refused(job, "expected GPUs with a predicted time");
    CHECK(listener.begun.empty());

    Observer silent;
    CHECK_THROWS_WITH(chosen({"coherent"}, 0.1, 1, silent), Contains("expected a baseline and another"));
    CHECK_THROWS_WITH(chosen(two, 0.1, 1, silent, 1024, "owen"), Contains("owen"));
}
