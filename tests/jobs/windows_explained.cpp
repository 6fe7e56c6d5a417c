// Explanations of the steady state, from windows.
#include <catch2/catch.hpp>

#include "tests/jobs/small_jobs.hpp"
#include "tools/jobs/windows/scaled_findings.hpp"
#include "traces/error.hpp"

namespace raycache {
namespace {

using cachesim::LevelFindings;
using Catch::Matchers::Contains;

/// Two blocks of two windows each, on a GPU small enough for it.
tools::ExplainJob small_job() {
    tools::ExplainJob job{test::small_launches({"cranley-patterson", "coherent"}),
                          {{"gtx-980-ti"}, {"sms=1"}, {}, {}, 8}};
    job.launches.sampling.resolution = "64x48";
    for (tools::CaseSettings& c : job.launches.cases) c.spp = 16;
    job.by = cachesim::GroupBy::ray;
    job.estimate.windows = true;
    job.estimate.window_count = 4;
    return job;
}

TEST_CASE("An explanation from windows has intervals, and findings that add up to its counts") {
    tools::Observer silent;
    const tools::ExplainResult result = run(small_job(), silent);
    const cachesim::Explanation& e = result.explanation;
    REQUIRE(e.windows);
    CHECK(e.windows->blocks == 2);
    CHECK(e.windows->windows == 2);
    CHECK_FALSE(e.windows->last_cache_full);  // so few warps do not fill it
    CHECK(e.base.name == "cranley-patterson");
    CHECK(e.other.name == "coherent");
    for (const cachesim::ExplainedTrace* trace : {&e.base, &e.other}) {
        REQUIRE(trace->launches.size() == 2);
        const cachesim::Counters all = trace->totals();
        REQUIRE(trace->findings.levels.size() == 2);
        for (std::size_t level = 0; level < 2; ++level) {
            const LevelFindings& found = trace->findings.levels[level];
            CHECK(found.all().lookups == all.levels[level].sectors);
            CHECK(found.all().misses() == all.levels[level].sectors - all.levels[level].hits);
        }
        CHECK(trace->findings.levels[0].all().capacity > 0);
        CHECK(trace->findings.sharing.hits() == all.levels[0].hits);
    }
    const auto factors = e.factors();
    REQUIRE(factors);
    for (const cachesim::Estimate& term : factors->terms) CHECK(term.half_width);
    CHECK(factors->product() == Approx(ratio(e, "dram_bytes_ratio").mean));

    REQUIRE(e.speed_ups.size() == cachesim::idealised_replays().size());
    for (const cachesim::SpeedUp& s : e.speed_ups) {
        CHECK(s.base_cycles.size() == 2);
        CHECK(s.base.cycles == static_cast<std::uint64_t>(s.base_cycles[0] + s.base_cycles[1]));
        CHECK(s.value().half_width);
    }
    CHECK(e.speed_ups[1].base.cycles < e.speed_ups[0].base.cycles);  // a perfect L1
    CHECK(result.subject.traces.size() == 2);
    CHECK_THAT(to_text(e), Contains("steady state, from 2 blocks of") && Contains("counts as capacity") &&
                               Contains("the last cache does not fill up"));
}

TEST_CASE("An explanation from windows has the counts of an estimate of the same windows") {
    const tools::ExplainJob job = small_job();
    tools::ReplayJob compared{job.launches, job.gpu, true, job.estimate};
    tools::Observer silent;
    const cachesim::Explanation e = run(job, silent).explanation;
    const tools::ReplayResult result = run(compared, silent);
    REQUIRE(result.series.size() == 2);
    CHECK(e.base.launches == result.series[0].launches);
    CHECK(e.other.launches == result.series[1].launches);
    for (std::size_t block = 0; block < 2; ++block) {
        CHECK(e.speed_ups[0].base_cycles[block] == static_cast<double>(result.times[0].launches[block].cycles));
        CHECK(e.speed_ups[0].other_cycles[block] == static_cast<double>(result.times[1].launches[block].cycles));
    }
}

TEST_CASE("The result of an explanation from windows reads back and says the same") {
    tools::ExplainJob job = small_job();
    job.timed = false;
    tools::Observer silent;
    const tools::ExplainResult result = run(job, silent);
    const auto read = std::get<tools::ExplainResult>(tools::parse_result(tools::result_text(result), "it"));
    CHECK(to_text(read.explanation) == to_text(result.explanation));
    CHECK(to_json(read.explanation) == to_json(result.explanation));
    CHECK(read.explanation.base.findings == result.explanation.base.findings);
}

TEST_CASE("A heat map of windows is refused, and so are windows of other pictures") {
    tools::ExplainJob job = small_job();
    job.pixels = true;
    CHECK_THROWS_WITH(job.check(), Contains("heat maps of windows; expected whole launches"));
    job.pixels = false;
    job.launches.cases[1].spp = 32;
    tools::Observer silent;
    CHECK_THROWS_WITH(run(job, silent), Contains("expected the sample indices of cranley-patterson"));
}

TEST_CASE("Findings scaled to a launch have its look-ups and misses, and keep the shares of the classes") {
    using traces::ObjectKind, traces::RayType;
    cachesim::Findings windows;
    windows.levels.resize(2);
    const std::size_t camera = LevelFindings::place(RayType::camera, 0),
                      second = LevelFindings::place(RayType::bounce, 2);
    windows.levels[0].of_group(camera, ObjectKind::node) = {100, 0, 30, 10, 6};
    windows.levels[0].by_depth[3] = {100, 0, 30, 10, 6};
    windows.sharing = {30, 20, 10};
    cachesim::LaunchStatistics launch;
    launch.groups.resize(2);
    launch.groups[0].ray = RayType::camera;
    launch.groups[0].by_kind[static_cast<std::size_t>(ObjectKind::node)].levels[0] = {1000, 600};
    launch.groups[1].ray = RayType::bounce;  // in no window: as nodes are on average
    launch.groups[1].bounce = 2;
    launch.groups[1].by_kind[static_cast<std::size_t>(ObjectKind::node)].levels[0] = {200, 160};
    const cachesim::Findings scaled = tools::scaled_findings(windows, launch);
    LevelFindings l1 = scaled.levels[0];
    CHECK(l1.of_group(camera, ObjectKind::node) == cachesim::MissCounts{1000, 0, 300, 100, 60});
    CHECK(l1.of_group(second, ObjectKind::node) == cachesim::MissCounts{200, 0, 30, 10, 16});
    CHECK(l1.by_depth[3] == cachesim::MissCounts{1200, 0, 330, 110, 76});
    CHECK(scaled.levels[1].all() == cachesim::MissCounts{});
    CHECK(scaled.sharing == cachesim::Sharing{380, 253, 127});
}

}  // namespace
}  // namespace raycache
