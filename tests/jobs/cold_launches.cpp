// Whole launches from cold caches beside an estimate of the steady state.
#include <tbb/task_arena.h>

#include <catch2/catch.hpp>

#include "small_jobs.hpp"
#include "tools/jobs/replay_job.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tools;
using Catch::Matchers::Contains;

namespace {

/// One SM that holds eight warps, an L2 of 256 KiB; few windows.
ReplayJob job_of(const std::vector<std::string>& strategies, bool timed, std::uint64_t cold) {
    ReplayJob job;
    job.launches = test::small_launches(strategies);
    job.launches.sampling.bounces = 1;
    job.gpu.names = {"rtx-3070"};
    job.gpu.changes = {"sms=1", "warps_per_cta=2", "max_warps_per_sm=8", "l2.ways=1"};
    job.timed = timed;
    job.estimate.windows = true;
    job.estimate.window_count = 4;
    job.estimate.cold_launches = cold;
    return job;
}

ReplayResult run_on(int threads, const ReplayJob& job) {
    tbb::task_arena arena(threads);
    Observer silent;
    return arena.execute([&] { return run(job, silent); });
}

}  // namespace

TEST_CASE("Cold launches beside the steady state are those that are replayed alone, for any threads") {
    const std::vector<std::string> two{"cranley-patterson", "micro-jitter"};
    const ReplayJob job = job_of(two, true, 2);
    ReplayJob whole = job;
    whole.estimate = {};
    whole.launches.sampling.trace_samples = 2;
    const ReplayResult beside = run_on(2, job), alone = run_on(1, whole), again = run_on(1, job);
    REQUIRE(beside.cold.size() == 2);
    for (std::size_t s = 0; s < 2; ++s) {
        CHECK(beside.cold[s].launches == alone.series[s].launches);
        CHECK(beside.cold[s].stages == again.cold[s].stages);
        REQUIRE(beside.cold[s].stages.size() == 2);
        for (std::size_t i = 0; i < 2; ++i) {
            CHECK(beside.cold[s].stages[i].sample == alone.times[s].launches[i].sample);
            CHECK(beside.cold[s].stages[i].all().cycles == alone.times[s].launches[i].cycles);
            CHECK(beside.cold[s].stages[i].all().warp_accesses == alone.times[s].launches[i].warp_accesses);
        }
        CHECK(beside.series[s].launches == again.series[s].launches);
    }

    const std::string text = result_text(beside);
    const auto read = std::get<ReplayResult>(parse_result(text, "it"));
    CHECK(read.cold[1].stages == beside.cold[1].stages);
    CHECK(result_text(read) == text);
}

TEST_CASE("Cold launches without time are counted, and the estimate beside them is as without") {
    const ReplayJob job = job_of({"coherent"}, false, 1);
    ReplayJob without = job;
    without.estimate.cold_launches = 0;
    const ReplayResult beside = run_on(2, job), plain = run_on(2, without);
    REQUIRE(beside.cold.size() == 1);
    CHECK(beside.cold[0].stages.empty());
    CHECK(beside.cold[0].launches.size() == 1);
    CHECK(beside.series[0].launches == plain.series[0].launches);
    CHECK(plain.cold.empty());
}

TEST_CASE("More cold launches than a strategy has are refused") {
    Observer silent;
    CHECK_NOTHROW(check_windows(job_of({"coherent"}, false, 4).launches, job_of({"coherent"}, false, 4).estimate));
    CHECK_THROWS_WITH(run(job_of({"coherent"}, false, 5), silent),
                      Contains("5 cold launches; expected 1 to 4: N is 4"));
    ReplayJob samples = job_of({"coherent"}, false, 2);
    samples.launches.sampling.thread_map = "samples";  // 32 sample indices of a pixel in a warp
    CHECK_THROWS_WITH(run(samples, silent), Contains("expected 1 to 1") && Contains("32 sample indices"));
}

TEST_CASE("What cold launches will take is said before anything runs") {
    struct Expecting : test::Listener {
        double cold = 0, windows = 0;
        void expect(const std::string& stage, Work work, double seconds) override {
            if (stage == "cold launches") cold += seconds;
            if (stage.starts_with("windows")) windows += seconds;
            CHECK((work == Work::timed_replay || stage == "load"));
            CHECK(begun.size() <= 1);  // "load"
        }
    } listener;
    ReplayJob job = job_of({"coherent"}, true, 1);
    run(job, listener);
    CHECK(listener.cold > 0);
    CHECK(listener.windows > 0);
    CHECK(listener.begun.back() == "cold launches");
    CHECK((listener.running == 0 && listener.ended_well));
}
