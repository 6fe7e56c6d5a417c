// Results of jobs as text: what is read back gives the same reports.
#include <stdlib.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "cachesim/report/profiler.hpp"
#include "tests/jobs/small_jobs.hpp"
#include "traces/error.hpp"

namespace raycache {
namespace {

using Catch::Matchers::Contains;

/// Written and read back; the text of both is the same.
template <class Result>
Result read_back(const Result& result) {
    const std::string text = tools::result_text(result);
    const auto read = tools::parse_result(text, "it");
    CHECK(tools::result_text(read) == text);
    return std::get<Result>(read);
}

const std::vector<std::string> two{"cranley-patterson", "micro-jitter"};

TEST_CASE("The result of a replay reads back, and gives the same reports in every form") {
    tools::ReplayJob job{test::small_launches(two), {{"gtx-980-ti", "xeon-8380"}, {}, {}, {}, 0}, false};
    test::Listener listener;
    const tools::ReplayResult result = run(job, listener);
    const tools::ReplayResult read = read_back(result);
    REQUIRE(read.series.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) CHECK(read.series[i].launches == result.series[i].launches);
    for (const auto by : {cachesim::GroupBy::none, cachesim::GroupBy::bounce, cachesim::GroupBy::object}) {
        const auto own = make_report(result.series, two[0], by), other = make_report(read.series, two[0], by);
        CHECK(to_text(own) == to_text(other));
        CHECK(to_csv(own) == to_csv(other));
        CHECK(to_json(own) == to_json(other));
    }
    CHECK(read.subject.gpus == result.subject.gpus);
    CHECK(read.subject.traces == result.subject.traces);
    CHECK(listener.begun == std::vector<std::string>{"load", "replay"});
    CHECK((listener.running == 0 && listener.ended_well));
}

TEST_CASE("The result of a timed replay reads back with its cycles and its counts") {
    tools::ReplayJob job{test::small_launches(two), {{"gtx-980-ti"}, {}, {}, {}, 0}, true};
    tools::Observer silent;
    const tools::ReplayResult result = run(job, silent);
    const tools::ReplayResult read = read_back(result);
    const auto own = make_timed_report(result.times, two[0], result.series),
               other = make_timed_report(read.times, two[0], read.series);
    CHECK(to_text(own) == to_text(other));
    CHECK(to_csv(own) == to_csv(other));
    CHECK(to_json(own) == to_json(other));

    const cachesim::TimedStatistics& launch = result.times.at(0).launches.at(0);
    const tools::Json text = tools::Json::parse(tools::result_text(result)).at("times").at(0);
    const char* const keys[] = {"l1", "l2", "l3"};
    for (std::size_t level = 0; level < 3; ++level)
        CHECK(text.at("launches").at(0).at(keys[level]).at("hits") == launch.levels[level].hits);
    CHECK(launch.levels[0].hits != launch.levels[1].hits);
}

TEST_CASE("The result of explain reads back with its heat maps") {
    tools::ExplainJob job{test::small_launches(two), {{"gtx-980-ti"}, {}, {}, {}, 0}};
    job.by = cachesim::GroupBy::bounce;
    job.pixels = true;
    tools::Observer silent;
    const tools::ExplainResult result = run(job, silent);
    const tools::ExplainResult read = read_back(result);
    CHECK(read.explanation.base.findings == result.explanation.base.findings);
    CHECK(read.explanation.other.launches == result.explanation.other.launches);
    CHECK(to_text(read.explanation) == to_text(result.explanation));
    CHECK(to_json(read.explanation) == to_json(result.explanation));
    REQUIRE(read.maps.size() == 2);
    const auto same = [](float a, float b) { return a == b || (a != a && b != b); };
    for (std::size_t i = 0; i < 2; ++i) {
        REQUIRE(result.maps[i].dram_bytes.size() == std::size_t{32} * 24);
        CHECK(std::equal(read.maps[i].dram_bytes.begin(), read.maps[i].dram_bytes.end(),
                         result.maps[i].dram_bytes.begin(), result.maps[i].dram_bytes.end(), same));
        CHECK(std::equal(read.maps[i].active_lanes.begin(), read.maps[i].active_lanes.end(),
                         result.maps[i].active_lanes.begin(), result.maps[i].active_lanes.end(), same));
    }
}

TEST_CASE("The result of quality reads back, and what its settings warn of reaches the listener") {
    std::string folder = (std::filesystem::temp_directory_path() / "raycache-XXXXXX").string();
    REQUIRE(mkdtemp(folder.data()) != nullptr);
    const auto launches = test::small_launches({"cranley-patterson", "micro-jitter", "coherent"});
    tools::QualityJob job;
    job.scene = launches.scene;
    job.sampling = launches.sampling;
    job.cases = launches.cases;
    job.baseline = two[0];
    job.reference_spp = 8;
    job.reference_file = folder + "/reference.exr";
    job.repeats = 2;
    job.pairs = true;
    job.gpu.names = {"gtx-980-ti"};
    job.equal_time = true;
    test::Listener listener;
    const auto result = std::get<tools::QualityResult>(run(tools::AnyJob(job), listener));
    CHECK(std::filesystem::exists(job.reference_file));
    const auto read = read_back(result);
    CHECK(to_text(read.report, 200) == to_text(result.report, 200));
    CHECK(to_csv(read.report) == to_csv(result.report));
    CHECK(to_json(read.report) == to_json(result.report));
    CHECK(result.pictures.rows.size() == 3);
    CHECK(result.pictures.at_equal_time.size() == 3);
    REQUIRE(listener.warnings.size() == 1);  // of micro-jitter: K=2.5 is too much for N=4
    CHECK_THAT(listener.warnings[0], Contains("clamped to 1"));
    std::filesystem::remove_all(folder);
}

TEST_CASE("A capture job writes the trace that a replay job reads, with the counts of replaying it on the fly") {
    std::string folder = (std::filesystem::temp_directory_path() / "raycache-XXXXXX").string();
    REQUIRE(mkdtemp(folder.data()) != nullptr);
    const auto launches = test::small_launches({"owen"});
    tools::Observer silent;
    const std::string trace = folder + "/owen.rct";
    const auto captured =
        run(tools::CaptureJob{launches.scene, launches.sampling, launches.cases[0], trace, {}}, silent);
    CHECK(captured.warps > 0);
    tools::ReplayJob from_file, on_the_fly;
    from_file.launches.traces = {trace};
    on_the_fly.launches = launches;
    from_file.gpu.names = on_the_fly.gpu.names = {"h100"};
    const auto a = run(from_file, silent), b = run(on_the_fly, silent);
    CHECK(a.series.front().launches == b.series.front().launches);
    std::uint64_t rays = 0;
    for (const auto& launch : a.series.front().launches) rays += launch.all().rays;
    CHECK(rays == captured.rays);
    CHECK_THAT(tools::result_text(captured), Contains("owen.rct"));
    read_back(captured);
    std::filesystem::remove_all(folder);
}

TEST_CASE("The result of samples reads back with every point") {
    tools::SamplesJob job;
    job.strategy.spp = 16;
    job.copies = 9;
    tools::Observer silent;
    const auto result = run(job, silent), read = read_back(result);
    CHECK(to_text(read.samples) == to_text(result.samples));
    CHECK(to_json(read.samples) == to_json(result.samples));
    CHECK(to_csv(read.samples) == to_csv(result.samples));
    CHECK(result.samples.points.size() == 144);
}

TEST_CASE("A damaged or foreign text is no result") {
    tools::ReplayJob job{test::small_launches({"owen"}), {{"h100"}, {}, {}, {}, 0}, false};
    tools::Observer silent;
    const std::string text = tools::result_text(run(job, silent));
    const auto refusal = [](const std::string& changed) {
        try {
            tools::parse_result(changed, "it");
            return std::string();
        } catch (const Error& e) {
            return std::string(e.what());
        }
    };
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string changed = text;
        REQUIRE(changed.find(from) != std::string::npos);
        return changed.replace(changed.find(from), from.size(), to);
    };
    CHECK(refusal(text).empty());
    CHECK_THAT(refusal(text.substr(0, text.size() / 2)), Contains("expected JSON"));
    CHECK_THAT(refusal(with("\"steps\"", "\"stops\"")), Contains("did you mean 'steps'?"));
    CHECK_THAT(refusal(with("\"spp\":4,\"caches\"", "\"caches\"")), Contains(".spp\" is missing"));
    CHECK_THAT(refusal(with("\"ray\":\"camera\"", "\"ray\":\"lens\"")), Contains("expected one of: camera"));
    CHECK_THAT(refusal(with("raycache ", "raycat ")), Contains("run the job again"));
    CHECK_THAT(refusal(with("\"levels\":2", "\"levels\":7")), Contains("2 or 3 cache levels"));
}

}  // namespace
}  // namespace raycache
