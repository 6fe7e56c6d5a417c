// Settings of jobs as text: read, written, refused.
#include <catch2/catch.hpp>

#include "tests/jobs/small_jobs.hpp"
#include "traces/error.hpp"

namespace raycache {
namespace {

using Catch::Matchers::Contains;
using test::refusal_of_job;
using tools::job_text;
using tools::parse_job;

const std::vector<tools::AnyJob> all_jobs{tools::CaptureJob{}, tools::RenderJob{},  tools::ReplayJob{},
                                          tools::ExplainJob{}, tools::QualityJob{}, tools::SamplesJob{}};

TEST_CASE("The text of every job reads back as the same job") {
    REQUIRE(all_jobs.size() == std::variant_size_v<tools::AnyJob>);
    for (const tools::AnyJob& job : all_jobs) {
        const std::string text = job_text(job);
        CHECK_THAT(text, Contains("\"job\": \"" + tools::job_name(job) + "\""));
        CHECK(parse_job(text, "it").index() == job.index());
        CHECK(job_text(parse_job(text, "it")) == text);
    }
}

TEST_CASE("What a text of a job says arrives in its settings, and what it leaves out has its default") {
    const auto job = std::get<tools::ReplayJob>(parse_job(
        R"({"job": "replay",
            "launches": {"scene": {"source": "courtyard", "fov": 40.5, "spatial_splits": true},
                         "sampling": {"k": 1.5, "bounces_diffuse": 2, "seed": 18446744073709551615},
                         "cases": [{"strategy": "owen"}, {"strategy": "coherent", "spp": 16, "mu": "0.25"}]},
            "gpu": {"names": ["h100"], "changes": ["l1.ways=8,16"], "l2_kib": [512]},
            "timed": true})",
        "it"));
    CHECK(job.launches.scene.source == "courtyard");
    CHECK(job.launches.scene.fov == 40.5F);
    CHECK(job.launches.scene.spatial_splits);
    CHECK(job.launches.scene.sky == "auto");
    CHECK(job.launches.sampling.k == "1.5");  // a number stands for its text
    CHECK(job.launches.sampling.bounces_diffuse == 2U);
    CHECK_FALSE(job.launches.sampling.bounces_transmission);
    CHECK(job.launches.sampling.seed == ~std::uint64_t{0});
    REQUIRE(job.launches.cases.size() == 2);
    CHECK(job.launches.cases[0].spp == tools::CaseSettings().spp);
    CHECK(job.launches.cases[1].spp == 16);
    CHECK(job.launches.cases[1].mu == "0.25");
    CHECK(job.gpu.names == std::vector<std::string>{"h100"});
    CHECK(job.gpu.l2_kib == std::vector<std::uint64_t>{512});
    CHECK(job.timed);
}

TEST_CASE("A key that a job does not have is refused with the one that was meant and where it stands") {
    CHECK_THAT(refusal_of_job(R"({"job": "replay", "tmied": true})"),
               Contains("cell 7: unknown key \"tmied\"") && Contains("did you mean 'timed'?"));
    CHECK_THAT(refusal_of_job(R"({"job": "capture", "sampling": {"resolutoin": "8x8"}})"),
               Contains("\"sampling.resolutoin\"") && Contains("did you mean 'resolution'?"));
    CHECK_THAT(refusal_of_job(R"({"job": "explain", "launches": {"cases": [{}, {"sttrategy": "owen"}]}})"),
               Contains("\"launches.cases[1].sttrategy\"") && Contains("did you mean 'strategy'?"));
}

TEST_CASE("A value of the wrong type is refused in one line that names its key") {
    const auto [text, place] = GENERATE(table<std::string, std::string>({
        {R"({"job": "replay", "timed": 1})", "\"timed\": expected true or false, found 1"},
        {R"({"job": "replay", "gpu": {"warps_per_sm": -1}})", "\"gpu.warps_per_sm\": expected a whole number"},
        {R"({"job": "replay", "gpu": {"warps_per_sm": 4294967296}})", "from 0 to 4294967295, found 4294967296"},
        {R"({"job": "replay", "gpu": {"names": "h100"}})", "\"gpu.names\": expected a list […], found \"h100\""},
        {R"({"job": "replay", "launches": []})", "\"launches\": expected an object"},
        {R"({"job": "capture", "output": true})", "\"output\": expected a text"},
        {R"({"job": "quality", "clamp": "nan"})", "\"clamp\": expected a number"},
        {R"({"job": "explain", "by": "bonce"})", "\"by\": expected one of: none, bounce, ray"},
        {R"({"job": "fly"})",
         "\"job\": expected one of: capture, render, replay, explain, quality, samples, found \"fly\""},
        {R"({"timed": true})", "key \"job\" is missing"},
        {R"([1])", "expected an object"},
        {R"({"job": "replay", "timed": true, "timed": false})", "found \"timed\" twice"},
        {R"({"job": "replay",)", "expected JSON"},
        {R"({"job": "quality", "clamp": 1e999})", "expected JSON"},
        {R"({"job": "quality", "clamp": 1e300})", "\"clamp\": expected a number"},
        {R"({"job": "replay", "timed": )" + std::string(100000, '['), "levels of brackets"},
    }));
    const std::string line = refusal_of_job(text);
    CHECK_THAT(line, Contains(place) && Contains("cell 7"));
    CHECK(line.find('\n') == std::string::npos);
}

TEST_CASE("Settings that make no sense are refused when the job is run, before anything takes time") {
    tools::Observer silent;
    const auto refusal = [&](const tools::AnyJob& job) {
        try {
            run(job, silent);
            return std::string();
        } catch (const Error& e) {
            return std::string(e.what());
        }
    };
    tools::ReplayJob replay{test::small_launches({"owen"}), {}, false};
    CHECK_THAT(refusal(replay), Contains("no GPU"));
    replay.gpu.names = {"h100"};
    replay.launches.traces = {"x.rct"};
    CHECK_THAT(refusal(replay), Contains("either one scene or trace files"));
    replay.launches = {};
    CHECK_THAT(refusal(replay), Contains("neither a scene nor traces"));
    replay.launches = test::small_launches({});
    CHECK_THAT(refusal(replay), Contains("without a case"));
    replay.launches = test::small_launches({"oven"});
    CHECK_THAT(refusal(replay), Contains("did you mean 'owen'?"));
    replay.launches = test::small_launches({"owen"});
    replay.launches.sampling.resolution = "32";
    CHECK_THAT(refusal(replay), Contains("WIDTHxHEIGHT"));
    tools::ExplainJob explain{test::small_launches({"owen"}), replay.gpu};
    CHECK_THAT(refusal(explain), Contains("expected two names"));
    CHECK_THAT(refusal(tools::CaptureJob{}), Contains("output"));
    tools::QualityJob quality;
    quality.cases = {{{"owen"}, "sobol", 4, {}, {}}};
    quality.reference_strategy = "coherent";
    CHECK_THAT(refusal(quality), Contains("expected one without bias"));
    quality.repeats = 0;
    CHECK_THAT(refusal(quality), Contains("1 to 1024"));
}

TEST_CASE("A layout or an integrator that does not exist is refused before the scene is loaded, with the closest") {
    tools::SceneSettings scene;
    scene.source = "no scene of this name";
    scene.layout = "bvh2-breadth-frist";
    tools::Observer nobody;
    CHECK_THROWS_WITH(scene.prepare({}, nobody), Contains("did you mean 'bvh2-breadth-first'?"));
    tools::SamplingSettings sampling;
    sampling.integrator = "pth";
    CHECK_THROWS_WITH(sampling.paths(), Contains("did you mean 'path'?"));
}

TEST_CASE("The command of a trace names layout and integrator where they are not the usual ones") {
    tools::SceneSettings scene;
    scene.source = "courtyard";
    const tools::SamplingSettings sampling;
    CHECK_THAT(capture_settings(scene, sampling, tools::CaseSettings{}).command,
               !Contains("--layout") && !Contains("--integrator"));
    scene.layout = "bvh2-breadth-first";
    CHECK_THAT(capture_settings(scene, sampling, tools::CaseSettings{}).command,
               Contains(" --layout bvh2-breadth-first ") && !Contains("--integrator"));
}

TEST_CASE("The command of a trace has the options that its integrator reads, and of its parameters those not usual") {
    tools::SceneSettings scene;
    scene.source = "courtyard";
    tools::SamplingSettings sampling;
    sampling.lights = "nee";
    sampling.integrator_parameters = {{"radius", "0.5"}, {"steps", "8"}, {"depth-bytes", ""}};
    CHECK_THAT(capture_settings(scene, sampling, tools::CaseSettings{}).command,
               Contains(" --bounces 3 --lights nee --thread-map") && !Contains("--radius"));
    sampling.integrator = "ao";
    CHECK_THAT(
        capture_settings(scene, sampling, tools::CaseSettings{}).command,
        Contains(" --integrator ao --radius 0.5 --thread-map") && !Contains("--bounces") && !Contains("--lights"));
    sampling.integrator = "ssao";
    sampling.integrator_parameters["depth-bytes"] = "2";
    CHECK_THAT(capture_settings(scene, sampling, tools::CaseSettings{}).command,
               Contains(" --integrator ssao --radius 0.5 --depth-bytes 2 --thread-map"));
    sampling.integrator_parameters["steps"] = "0";
    CHECK_THROWS_WITH(sampling.paths(), Contains("must be 1 to 1024, found 0"));
    sampling.integrator_parameters = {{"setps", "8"}};
    CHECK_THROWS_WITH(sampling.paths(), Contains("did you mean 'steps'?"));
}

}  // namespace
}  // namespace raycache
