// The pipeline as a whole: header, jobs, and traces that depend on nothing but the settings.
#include <catch2/catch.hpp>

#include "test_rays.hpp"
#include "tracer/capture.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

Scene sunny_soup() {
    Scene scene = soup(2000, 0.3F, 1);
    scene.name = "soup";
    scene.hash = 77;
    scene.sky = {1, 1, 1};
    scene.sun = Sun{{0, 1, 0}, {1, 1, 1}};
    scene.cameras[0] = {"front", {0, 0, 3}, {0, 0, -1}, {0, 1, 0}, 45};
    return scene;
}

CaptureSettings small_picture(ThreadMap map = ThreadMap::tile) {
    CaptureSettings settings;
    settings.width = 40;
    settings.height = 24;
    settings.thread_map = map;
    settings.strategy.samples.spp = 64;
    settings.strategy.samples.seed = 5;
    settings.trace_samples = 3;
    settings.program = "raycache test";
    settings.command = "trace soup";
    return settings;
}

}  // namespace

TEST_CASE("capture: the header says where the trace comes from, what it reads and which samples it holds") {
    const PreparedScene scene(sunny_soup(), {});
    const Capture capture(scene, small_picture());
    const traces::Header& header = capture.header();
    const traces::Provenance& p = header.provenance;
    CHECK(p.program == "raycache test");
    CHECK(p.command == "trace soup");
    CHECK(p.scene == "soup");
    CHECK(p.scene_hash == 77);
    CHECK(p.camera == "front");
    CHECK(p.sequence == "sobol");
    CHECK(p.decorrelation == "micro-jitter");
    CHECK_FALSE(p.parameters.empty());
    CHECK(p.thread_map == "tile");
    CHECK(p.layout == "bvh2");
    CHECK(p.spp == 64);
    CHECK(p.seed == 5);
    CHECK(p.width == 40);
    CHECK(p.height == 24);
    CHECK(p.bounces == 3);
    CHECK(header.regions.size() == 2);  // no textures
    CHECK(header.launches == choose_sample_indices(64, 3, 5));
    CHECK(header.warps_per_launch == 3 * 2 * 8);
}

TEST_CASE("capture: a textured scene has a texel region") {
    Scene scene = sunny_soup();
    scene.textures.push_back({1, 1, {1, 2, 3, 255}, "dot"});
    const PreparedScene prepared(std::move(scene), {});
    const auto regions = Capture(prepared, small_picture()).header().regions;
    REQUIRE(regions.size() == 3);
    CHECK(regions[2].kind == traces::ObjectKind::texel);
    CHECK(regions[2].stride == 4);
    CHECK(regions[2].count == 32);
    CHECK(regions[2].base % (2U << 20U) == 0);
    CHECK(regions[1].address(regions[1].count) <= regions[2].base);
}

TEST_CASE("capture: with the samples map launches are whole groups of 32 samples, rounded up") {
    const PreparedScene scene(sunny_soup(), {});
    CaptureSettings settings = small_picture(ThreadMap::samples);
    settings.trace_samples = 33;
    CHECK(Capture(scene, settings).header().launches == std::vector<std::uint32_t>{0, 32});
    settings.trace_samples = 1;
    CHECK(Capture(scene, settings).header().launches.size() == 1);
    settings.strategy.samples.spp = 40;
    settings.trace_samples = 64;
    const Capture odd(scene, settings);  // the second group has 8 samples
    REQUIRE(odd.header().launches == std::vector<std::uint32_t>{0, 32});
    std::array<PathLane, traces::warp_lanes> lanes;
    CHECK(odd.lane_jobs(1, 0, lanes) == 0xffU);
}

TEST_CASE("capture: a warp's trace does not depend on what the worker did before") {
    const PreparedScene scene(sunny_soup(), {});
    for (const ThreadMap map : {ThreadMap::tile, ThreadMap::samples}) {
        const Capture capture(scene, small_picture(map));
        const auto reused = capture.make_worker();
        traces::WarpTrace a, b;
        std::uint64_t differ = 0, empty = 0, rays = 0;
        const auto launches = static_cast<std::uint32_t>(capture.header().launches.size());
        for (std::uint32_t launch = 0; launch < launches; ++launch)
            for (std::uint32_t i = 0; i < capture.header().warps_per_launch; ++i) {
                const std::uint32_t warp = capture.header().warps_per_launch - 1 - i;
                capture.trace_warp(*reused, launch, warp, a);
                capture.trace_warp(*capture.make_worker(), launch, warp, b);
                differ += a != b;
                empty += a.records.empty();
                REQUIRE((a.launch == launch && a.warp == warp));
                for (const traces::Record& r : a.records)
                    if (!r.is_access() && r.ray == traces::RayType::camera) rays += r.lanes();
            }
        CHECK(differ == 0);
        const std::uint32_t samples = map == ThreadMap::tile ? 3 : 32;
        CHECK(rays == 40U * 24 * samples);
        CHECK(empty > 0);  // warps outside the picture
    }
}

TEST_CASE("capture: records of a path come in order: camera, then per vertex its texel, shadow and bounce rays") {
    const PreparedScene scene(sunny_soup(), {});
    const Capture capture(scene, small_picture());
    const auto worker = capture.make_worker();
    traces::WarpTrace trace;
    for (std::uint32_t warp = 0; warp < capture.header().warps_per_launch; ++warp) {
        capture.trace_warp(*worker, 0, warp, trace);
        if (trace.records.empty()) continue;
        REQUIRE(trace.records[0].ray == traces::RayType::camera);
        unsigned last = 0;
        for (const traces::Record& r : trace.records) {
            REQUIRE(r.bounce <= 3);
            const unsigned place = r.ray == traces::RayType::camera   ? 0
                                   : r.ray == traces::RayType::shadow ? 2U * r.bounce + 1
                                                                      : 2U * r.bounce;
            REQUIRE(place >= last);
            last = place;
        }
    }
}

TEST_CASE("capture: settings out of range are refused in one line") {
    const PreparedScene scene(sunny_soup(), {});
    const auto refused = [&](auto change, const char* why) {
        CaptureSettings settings = small_picture();
        change(settings);
        CHECK_THROWS_AS(Capture(scene, settings), UsageError);
        CHECK_THROWS_WITH(Capture(scene, settings), Catch::Contains(why) && !Catch::Contains("\n"));
    };
    refused([](CaptureSettings& s) { s.width = 0; }, "width of 0");
    refused([](CaptureSettings& s) { s.height = 16385; }, "height of 16385");
    refused([](CaptureSettings& s) { s.paths.bounces = 65; }, "--bounces 65");
    refused([](CaptureSettings& s) { s.strategy.samples.spp = 0; }, "");
    refused([](CaptureSettings& s) { s.trace_samples = 0; }, "");
    refused([](CaptureSettings& s) { s.strategy.sequence = "none"; }, "sobol");
    refused([](CaptureSettings& s) { s.strategy.decorrelation = "none"; }, "micro-jitter");
}

TEST_CASE("capture: the largest number of bounces is traced") {
    Scene closed = icosphere(2);
    closed.cameras[0] = {"inside", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 45};
    const PreparedScene scene(std::move(closed), {});
    CaptureSettings settings = small_picture();
    settings.paths.bounces = 64;
    const Capture capture(scene, settings);
    traces::WarpTrace trace;
    capture.trace_warp(*capture.make_worker(), 0, 0, trace);
    CHECK(trace.records.back().bounce == 64);
}
