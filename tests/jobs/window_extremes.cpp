// Estimates from windows where there is little to estimate from, or numbers are far from usual ones.
#include <catch2/catch.hpp>
#include <cmath>

#include "cachesim/report/report.hpp"
#include "small_jobs.hpp"
#include "tools/jobs/windows/estimator.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/scene/scene.hpp"

using namespace raycache;
using namespace raycache::tools;

namespace {

LaunchSettings launches(const std::string& resolution, std::uint64_t spp) {
    LaunchSettings all = test::small_launches({"cranley-patterson", "micro-jitter"});
    all.sampling.resolution = resolution;
    all.sampling.bounces = 1;
    for (CaseSettings& one : all.cases) one.spp = spp;
    return all;
}

/// One SM of small CTAs, an L2 of 256 KiB.
std::vector<cachesim::Gpu> gpus() {
    GpuSettings gpu;
    gpu.names = {"rtx-3070"};
    gpu.changes = {"sms=1", "warps_per_cta=2", "max_warps_per_sm=8", "l2.ways=1"};
    return gpu.load({});
}

WindowSizes few() {
    WindowSizes sizes;
    sizes.indices = 2;
    sizes.work_groups = 16;
    sizes.sm_windows = 16;
    sizes.windows = sizes.timed_windows = 2;
    return sizes;
}

tracer::Scene courtyard() {
    tracer::SceneRequest request;
    request.source = "courtyard";
    request.detail = 50000;
    return load_scene(request, [](const std::string&) {});
}

Predicted estimated(tracer::Scene scene, const LaunchSettings& of, std::uint32_t blocks, Observer& observer,
                    const std::vector<cachesim::Gpu>& all = gpus(),
                    const std::vector<cachesim::Idealised>& in_time = {}) {
    const tracer::PreparedScene prepared(std::move(scene), {});
    EstimateSettings settings;
    settings.windows = true;
    Estimator estimator(prepared, strategies_of(of), settings, all, in_time, false, observer, {few(), 0});
    estimator.look(blocks, "cranley-patterson");
    return estimator.result();
}

}  // namespace

TEST_CASE("an estimate of one pixel and one sample is of what there is, with an interval of nothing") {
    Observer silent;
    const Predicted now = estimated(courtyard(), launches("1x1", 1), 2, silent);
    const auto report = cachesim::make_report(now.traffic, "cranley-patterson", cachesim::GroupBy::none);
    for (const cachesim::Row& row : report.rows) {
        CHECK(row["steps_per_ray"]->mean > 0);
        CHECK(row["steps_per_ray"]->half_width == 0);  // the same pixel and sample in both blocks
    }
}

TEST_CASE("windows in time that begin and end at once are refused") {
    GpuSettings gpu;
    gpu.names = {"rtx-3070"};
    gpu.changes = {"sms=1", "warps_per_cta=2"};  // one of eight warps has a ray: those of a window never fill the slots
    Observer silent;
    CHECK_THROWS_WITH(estimated(courtyard(), launches("1x1", 1), 2, silent, gpu.load({}), {{}}),
                      Catch::Contains("began and ended at once") && Catch::Contains("--exact"));
}

TEST_CASE("an estimate of one block has means and no interval, so that none is certain enough") {
    Observer silent;
    const Predicted now = estimated(courtyard(), launches("32x24", 16), 1, silent);
    const auto report = cachesim::make_report(now.traffic, "cranley-patterson", cachesim::GroupBy::none);
    CHECK(report.rows[1]["l2_bytes_ratio"]->mean > 0);
    CHECK_FALSE(report.rows[1]["l2_bytes_ratio"]->half_width);
    CHECK(std::isinf(worst_error(now, "cranley-patterson").error));
}

TEST_CASE("a scene a million times smaller or larger has the same estimate, within the interval") {
    Observer silent;
    const auto ratio = [&](float scale) {
        tracer::Scene scene = courtyard();
        for (tracer::Vec3& p : scene.positions) p = p * scale;
        for (tracer::Camera& camera : scene.cameras) camera.eye = camera.eye * scale;
        const Predicted now = estimated(std::move(scene), launches("32x24", 16), 4, silent);
        const auto report = cachesim::make_report(now.traffic, "cranley-patterson", cachesim::GroupBy::none);
        return std::pair(*report.rows[0]["l2_bytes_per_ray"], *report.rows[1]["l2_bytes_ratio"]);
    };
    const auto [bytes, of_baseline] = ratio(1);
    for (const float scale : {1e-6F, 1e6F}) {
        const auto [scaled_bytes, scaled_ratio] = ratio(scale);
        INFO("scale " << scale);
        CHECK(std::fabs(scaled_bytes.mean - bytes.mean) < *bytes.half_width);
        CHECK(std::fabs(scaled_ratio.mean - of_baseline.mean) < *of_baseline.half_width);
    }
}
