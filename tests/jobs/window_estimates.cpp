// Estimates from windows as a whole: against the exact steady state, against themselves.
#include <tbb/task_arena.h>
#include <catch2/catch.hpp>
#include <cmath>

#include "cachesim/report/report.hpp"
#include "cachesim/report/timed_report.hpp"
#include "small_jobs.hpp"
#include "tools/bench/coverage/interval_coverage.hpp"
#include "tools/jobs/launches.hpp"
#include "tools/jobs/replay_launches.hpp"
#include "tools/jobs/windows/estimate.hpp"

using namespace raycache;
using namespace raycache::tools;

namespace {

/// One SM of small CTAs: a wave of eight warps, an L2 of 256 KiB that the scene does not fit in.
GpuSettings small_gpu() {
    GpuSettings gpu;
    gpu.names = {"rtx-3070"};
    gpu.changes = {"sms=1", "warps_per_cta=2", "max_warps_per_sm=8", "l2.ways=1"};
    return gpu;
}

/// With the fewest windows that give an interval.
std::vector<cachesim::Series> estimated(int threads) {
    LaunchSettings launches = test::small_launches({"coherent", "micro-jitter"});
    launches.sampling.mu = "0";
    launches.sampling.bounces = 1;
    EstimateSettings settings;
    settings.windows = true;
    settings.window_count = 2;
    test::Listener listener;
    tbb::task_arena arena(threads);
    return arena.execute(
        [&] { return estimate(launches, settings, small_gpu().load({}), false, listener, {}).result.traffic; });
}

}  // namespace

TEST_CASE("an estimate from windows of two strategies with the same samples is exactly 1 ± 0, for any threads") {
    const auto series = estimated(2);
    const cachesim::Report report = cachesim::make_report(series, "coherent", cachesim::GroupBy::none);
    REQUIRE(report.rows.size() == 2);
    for (const cachesim::TrafficKey key :
         {cachesim::TrafficKey("l2_bytes_ratio"), cachesim::TrafficKey("dram_bytes_ratio")}) {
        const std::optional<cachesim::Estimate> ratio = report.rows[1][key];
        REQUIRE(ratio);
        CHECK(ratio->mean == 1);
        CHECK(ratio->half_width == 0);
    }
    CHECK(report.rows[0]["l2_bytes_per_ray"]->mean > 0);
    CHECK(*report.rows[0]["l2_bytes_per_ray"]->half_width > 0);

    const auto one_thread = estimated(1);
    REQUIRE(one_thread.size() == series.size());
    for (std::size_t s = 0; s < series.size(); ++s) CHECK(one_thread[s].launches == series[s].launches);
}

TEST_CASE("strategies of different thread maps are paired: in windows and in whole launches, over the same samples") {
    LaunchSettings launches = test::small_launches({"owen@samples", "owen@rows", "owen@tile"});
    launches.sampling.resolution = "64x48";  // some CTAs see nothing of the scene
    for (CaseSettings& one : launches.cases) one.spp = 64;
    launches.sampling.bounces = 1;
    test::Listener listener;
    EstimateSettings settings;
    settings.windows = true;
    settings.window_count = 4;
    const auto gpus = small_gpu().load({});
    const Predicted windows = estimate(launches, settings, gpus, true, listener, {}).result;
    launches.sampling.resolution = "20x10";
    const Launches whole(launches, {}, listener);
    for (const LaunchSource& source : whole.sources()) {
        CHECK(source.header->launches == whole.sources()[0].header->launches);
        CHECK(source.indices == 32);
    }
    const Predicted exact = predict(whole.sources(), gpus, listener);
    for (const bool in_windows : {true, false}) {
        const Predicted& made = in_windows ? windows : exact;
        const auto report = cachesim::make_timed_report(made.times, "owen@samples", made.traffic);
        REQUIRE(report.rows.size() == 3);
        const double rays = static_cast<double>(report.rows[0].totals.rays);
        for (std::size_t r = 1; r < 3; ++r) {
            INFO(report.rows[r].strategy);
            // The paths are the same, or a sample of the same; only who shares a warp differs.
            CHECK(static_cast<double>(report.rows[r].totals.rays) == Approx(rays).epsilon(in_windows ? 0.1 : 0));
            CHECK(report.traffic.rows[r]["l2_bytes_ratio"]);
            REQUIRE(report.rows[r]["speed_up"]);
            CHECK(report.rows[r]["speed_up"]->mean > 0.3);
            CHECK(report.rows[r]["speed_up"]->mean < 3);
        }
    }
}

TEST_CASE("intervals of estimates from windows hold the exact steady state as often as they say", "[slow]") {
    bench::CoverageSettings settings;
    settings.scene.source = "courtyard";
    settings.scene.detail = 50000;
    settings.sampling.resolution = "48x32";
    settings.sampling.k = "1";
    settings.sampling.bounces = 1;
    settings.gpu = small_gpu();
    settings.spp = 32;
    settings.estimates = 40;
    settings.pool = 6;
    settings.sizes.indices = 2;
    settings.sizes.work_groups = 8;
    settings.sizes.sm_windows = 32;
    settings.sizes.windows = 4;
    tools::Observer silent;
    const auto figures = bench::interval_coverage(settings, silent);
    REQUIRE(figures.size() == 8);
    for (const bench::FigureCoverage& f : figures) {
        CAPTURE(f.figure, f.exact, f.held, f.half_width, f.error, f.bias);
        // Of 40 intervals of 95 % fewer than 34 hold in 0.3 % of all cases.
        CHECK(f.held >= 34.0 / 40);
        CHECK(f.half_width < 0.5);
        // The mean of 40 estimates scatters by a sixth of one of them.
        CHECK(std::fabs(f.bias) < 0.5 * f.half_width);
    }
}
