// A wavefront: the same paths as a megakernel's, in other kernels.
#include <tbb/global_control.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "test_rays.hpp"
#include "tests/traces/files.hpp"
#include "tracer/capture.hpp"
#include "tracer/paths/integrators/path_integrator.hpp"
#include "tracer/simt/recorder.hpp"
#include "tracer/simt/warp_traversal.hpp"
#include "tracer/simt/wavefront.hpp"
#include "traces/error.hpp"
#include "traces/read_launch.hpp"
#include "traces/reader.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;
using Catch::Matchers::Contains;
using Stage = WavefrontKernel::Stage;

namespace {

/// Triangles in a closed ball, textured, under a lamp: paths of all lengths.
Scene room() {
    Scene scene = soup(800, 0.4F, 3);
    append(scene, moved(icosphere(2), 4, {0, 0, 0}));
    scene.name = "room";
    Material textured = scene.materials[0], lamp = scene.materials[0];
    textured.base_color = {0.8F, 0.7F, 0.5F};
    textured.base_color_texture = 0;
    lamp.emission = {5, 5, 4};
    scene.materials = {scene.materials[0], textured, lamp};
    scene.textures.push_back({1, 1, {200, 100, 50, 255}, "dot"});
    scene.texcoords.assign(scene.positions.size(), {0.5F, 0.5F});
    for (std::size_t t = 0; t < scene.material_of.size(); ++t)
        scene.material_of[t] = t % 40 == 0 ? 2 : t % 2 == 0 ? 1 : 0;
    scene.sky = {0.2F, 0.3F, 0.5F};
    scene.cameras[0] = {"inside", {0, 0, 3}, {0, 0, -1}, {0, 1, 0}, 60};
    return scene;
}

CaptureSettings picture(const std::string& order = "", ThreadMap map = ThreadMap::tile) {
    CaptureSettings settings;
    settings.width = 40;
    settings.height = 24;
    settings.thread_map = map;
    settings.strategy.decorrelation = "cranley-patterson";
    settings.strategy.samples.spp = 1;
    settings.trace_samples = 1;
    if (!order.empty()) settings.execution = {Execution::wavefront, order};
    return settings;
}

std::vector<traces::WarpTrace> all_warps(const Capture& capture, std::uint32_t launch = 0) {
    std::vector<traces::WarpTrace> warps;
    const auto worker = capture.make_worker();
    const auto wavefront = capture.is_wavefront() ? capture.begin_wavefront(launch) : nullptr;
    const std::uint32_t per_kernel = capture.header().warps_per_kernel();
    for (std::uint32_t number = 0; number < capture.header().warps_per_launch; ++number) {
        traces::WarpTrace& warp = warps.emplace_back();
        if (!wavefront) {
            capture.trace_warp(*worker, launch, number, warp);
            continue;
        }
        if (number != 0 && number % per_kernel == 0) wavefront->end_kernel();
        wavefront->trace_warp(*worker, number % per_kernel, warp);
        warp.launch = launch;
        warp.warp = number;
    }
    return warps;
}

using RaysByKind = std::map<std::pair<traces::RayType, unsigned>, std::uint64_t>;

RaysByKind count_rays(const std::vector<traces::WarpTrace>& warps) {
    RaysByKind rays;
    for (const auto& warp : warps)
        for (const traces::Record& r : warp.records)
            if (!r.is_access()) rays[{r.ray, r.bounce}] += r.lanes();
    return rays;
}

/// Elements of each lane access of a kind of region, sorted: what is read, whatever the warps.
std::vector<std::uint32_t> elements_of(const Capture& capture, const std::vector<traces::WarpTrace>& warps,
                                       traces::ObjectKind kind) {
    std::vector<std::uint32_t> all;
    for (const auto& warp : warps) {
        std::size_t next = 0;
        for (const traces::Record& r : warp.records) {
            if (!r.is_access()) continue;
            if (capture.header().regions[r.region].kind == kind)
                all.insert(all.end(), warp.elements.begin() + static_cast<std::ptrdiff_t>(next),
                           warp.elements.begin() + static_cast<std::ptrdiff_t>(next + r.lanes()));
            next += r.lanes();
        }
    }
    std::sort(all.begin(), all.end());
    return all;
}

std::vector<Vec3> megakernel_picture(const Capture& capture) {
    const PreparedScene& scene = capture.scene();
    NullRecorder recorder;
    const auto traversal = make_traversal(scene, recorder);
    PathIntegrator integrator({scene.scene(), capture.camera(), scene.lights(), scene.texels(), capture.strategy(),
                               capture.settings().paths, *traversal});
    std::vector<Vec3> pixels(std::size_t{40} * 24);
    for (std::uint32_t warp = 0; warp < capture.header().warps_per_launch; ++warp) {
        std::array<PathLane, traces::warp_lanes> lanes;
        std::array<Vec3, traces::warp_lanes> radiance;
        const std::uint32_t mask = capture.lane_jobs(0, warp, lanes);
        integrator.trace(mask, lanes, radiance);
        for (unsigned l = 0; l < traces::warp_lanes; ++l)
            if (((mask >> l) & 1U) != 0) pixels[lanes[l].pixel] = radiance[l];
    }
    return pixels;
}

/// Runs a launch to its end and puts the radiance of its paths together.
std::vector<Vec3> wavefront_picture(const Capture& capture) {
    const auto wavefront = capture.begin_wavefront(0);
    const auto worker = capture.make_worker();
    traces::WarpTrace trace;
    for (std::uint32_t k = 0; k < capture.header().kernels_per_launch; ++k) {
        for (std::uint32_t warp = 0; warp < capture.header().warps_per_kernel(); ++warp)
            wavefront->trace_warp(*worker, warp, trace);
        wavefront->end_kernel();
    }
    std::vector<Vec3> pixels(std::size_t{40} * 24);
    for (std::uint32_t warp = 0; warp < capture.header().warps_per_kernel(); ++warp) {
        std::array<PathLane, traces::warp_lanes> lanes;
        const std::uint32_t mask = capture.lane_jobs(0, warp, lanes);
        for (unsigned l = 0; l < traces::warp_lanes; ++l)
            if (((mask >> l) & 1U) != 0) pixels[lanes[l].pixel] = wavefront->radiance(warp * traces::warp_lanes + l);
    }
    return pixels;
}

}  // namespace

TEST_CASE("wavefront: kernels come by vertex: sort, extend, shade, connect") {
    CHECK(wavefront_kernels({0, true}, true) ==
          std::vector<WavefrontKernel>{{Stage::extend, 0}, {Stage::shade, 0}, {Stage::connect, 0}});
    CHECK(wavefront_kernels({1, true}, true) == std::vector<WavefrontKernel>{{Stage::extend, 0},
                                                                             {Stage::shade, 0},
                                                                             {Stage::connect, 0},
                                                                             {Stage::sort, 1},
                                                                             {Stage::extend, 1},
                                                                             {Stage::shade, 1},
                                                                             {Stage::connect, 1}});
    CHECK(wavefront_kernels({1, false}, false) ==
          std::vector<WavefrontKernel>{{Stage::extend, 0}, {Stage::shade, 0}, {Stage::extend, 1}, {Stage::shade, 1}});
}

TEST_CASE("wavefront: the picture is a megakernel's bit by bit, for every order") {
    const PreparedScene scene(room(), {});
    const std::vector<Vec3> expected = megakernel_picture(Capture(scene, picture()));
    std::set<float> values;
    for (const Vec3 p : expected) values.insert(p.x);
    REQUIRE(values.size() > 300);
    for (const RayOrderEntry& order : ray_orders()) {
        INFO(order.name);
        CHECK(wavefront_picture(Capture(scene, picture(order.name))) == expected);
    }
}

TEST_CASE("wavefront: rays of each kind, nodes, triangles and texels visited are a megakernel's, for every order") {
    const PreparedScene scene(room(), {});
    const Capture mega(scene, picture());
    const auto mega_warps = all_warps(mega);
    const RaysByKind expected = count_rays(mega_warps);
    REQUIRE(expected.size() == 8);  // camera, 3 bounces, 4 shadow
    for (const RayOrderEntry& order : ray_orders()) {
        INFO(order.name);
        const Capture capture(scene, picture(order.name));
        const auto warps = all_warps(capture);
        REQUIRE(warps.size() == capture.header().warps_per_launch);
        CHECK(count_rays(warps) == expected);
        for (const auto kind : {traces::ObjectKind::node, traces::ObjectKind::triangle, traces::ObjectKind::texel})
            CHECK(elements_of(capture, warps, kind) == elements_of(mega, mega_warps, kind));
    }
}

TEST_CASE("wavefront: an order permutes rays among warps, and compaction leaves no gaps") {
    const PreparedScene scene(room(), {});
    const Capture plain(scene, picture("none")), sorted(scene, picture("meister"));
    const auto rays_of_warps = [](const Capture& capture) {
        std::vector<std::uint32_t> masks;
        const auto warps = all_warps(capture);
        for (const auto& warp : warps)
            for (const traces::Record& r : warp.records)
                if (!r.is_access() && r.ray == traces::RayType::bounce) masks.push_back(r.mask);
        return masks;
    };
    const auto a = rays_of_warps(plain), b = rays_of_warps(sorted);
    CHECK(a == b);  // as many rays in as many warps
    std::size_t partial = 0;
    for (const std::uint32_t mask : a) partial += mask != ~0U;
    CHECK(partial <= 3);  // the last warp of each bounce
    // What is read in which order differs.
    CHECK(all_warps(plain).size() < all_warps(sorted).size());
}

TEST_CASE("wavefront: buffers are written before they are read, and every ray is sorted once") {
    const PreparedScene scene(room(), {});
    const Capture capture(scene, picture("garanzha-loop"));
    const auto& regions = capture.header().regions;
    const auto warps = all_warps(capture);
    std::set<std::uint64_t> written;
    std::uint64_t too_early = 0, sorted = 0, runs = 0;
    unsigned sort_regions = 0;
    std::map<std::uint8_t, bool> is_runs;
    for (std::size_t r = 0; r < regions.size(); ++r)
        if (regions[r].kind == traces::ObjectKind::sort) is_runs[static_cast<std::uint8_t>(r)] = sort_regions++ == 1;
    REQUIRE(sort_regions == 2);
    for (const auto& warp : warps) {
        std::size_t next = 0;
        for (const traces::Record& r : warp.records) {
            if (!r.is_access()) continue;
            const traces::Region& region = regions[r.region];
            for (unsigned i = 0; i < r.lanes(); ++i) {
                const std::uint64_t address = region.address(warp.elements[next + i]);
                if (traces::is_write(region.kind)) written.insert(address);
                const bool buffer = region.kind == traces::ObjectKind::ray_state ||
                                    region.kind == traces::ObjectKind::hit || region.kind == traces::ObjectKind::queue;
                too_early += buffer && written.count(address) == 0;
                if (region.kind == traces::ObjectKind::sort) ++(is_runs[r.region] ? runs : sorted);
            }
            next += r.lanes();
        }
    }
    CHECK(too_early == 0);
    std::uint64_t bounces = 0;
    for (const auto& [kind, rays] : count_rays(warps)) bounces += kind.first == traces::RayType::bounce ? rays : 0;
    CHECK(sorted == bounces);
    CHECK(runs > 0);
    CHECK(runs < sorted);
}

TEST_CASE("wavefront: the header says so, and a megakernel's says nothing new") {
    const PreparedScene scene(room(), {});
    const Capture mega(scene, picture()), wave(scene, picture("moon"));
    CHECK(mega.header().kernels_per_launch == 1);
    CHECK(mega.header().regions.size() == 3);
    CHECK(mega.header().provenance.execution == "megakernel");
    CHECK(wave.header().kernels_per_launch == 4 * 3 + 3);
    CHECK(wave.header().warps_per_kernel() == mega.header().warps_per_launch);
    CHECK(wave.header().provenance.execution == "wavefront");
    CHECK(wave.header().provenance.order == "moon");
    CHECK(wave.header().regions.size() == 3 + 10 + 1);
    for (const traces::Region& region : wave.header().regions) CHECK(region.base % (2U << 20U) == 0);
}

TEST_CASE("wavefront: a file has the same warps, whatever the number of threads", "[slow]") {
    const PreparedScene scene(room(), {});
    for (const ThreadMap map : {ThreadMap::tile, ThreadMap::samples}) {
        CaptureSettings settings = picture("meister-two-point", map);
        settings.width = 20;
        settings.strategy.samples.spp = 64;
        settings.trace_samples = 2;
        const Capture capture(scene, settings);
        const TemporaryFolder folder;
        std::vector<std::vector<std::uint8_t>> bytes;
        for (const std::size_t threads : {1, 4}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            const std::string path = folder / ("wave" + std::to_string(threads) + ".rct");
            write_capture(capture, path, {});
            bytes.push_back(read_file(path));
        }
        CHECK(bytes[0].size() > 1000);
        CHECK(bytes[0] == bytes[1]);
        const traces::Reader reader(folder / "wave1.rct");
        CHECK(reader.header() == capture.header());
        std::size_t differ = 0;
        for (std::uint32_t launch = 0; launch < capture.header().launches.size(); ++launch) {
            const auto expected = all_warps(capture, launch);
            std::size_t next = 0;
            traces::read_launch(reader, launch, [&](traces::WarpTrace&& warp) { differ += warp != expected[next++]; });
            CHECK(next == expected.size());
        }
        CHECK(differ == 0);
    }
}

TEST_CASE("wavefront: settings that make no sense are refused in one line") {
    const PreparedScene scene(room(), {});
    CaptureSettings settings = picture();
    settings.execution.order = "morton";
    CHECK_THROWS_AS(Capture(scene, settings), UsageError);
    CHECK_THROWS_WITH(Capture(scene, settings), Contains("ray order morton with execution megakernel"));
    settings = picture("hilbert");
    CHECK_THROWS_WITH(Capture(scene, settings), Contains("unknown ray order 'hilbert'"));
    settings = picture("none");
    settings.width = settings.height = 8192;
    CHECK_THROWS_WITH(Capture(scene, settings), Contains("67108864 paths a launch; expected at most 16777216"));
    settings.width = settings.height = 4096;
    settings.paths.bounces = 64;
    CHECK_THROWS_WITH(Capture(scene, settings), Contains("kernels of 524288 warps; expected at most 67108864"));
    CHECK_THROWS_WITH(execution_from("kernel"), Contains("expected one of: megakernel, wavefront"));
}

TEST_CASE("wavefront: no path goes on where all rays miss, and the kernels after that are empty") {
    Scene empty = soup(1, 0.01F, 1);
    empty.cameras[0] = {"away", {0, 0, 30}, {0, 0, 1}, {0, 1, 0}, 45};
    empty.sky = {1, 1, 1};
    const PreparedScene scene(std::move(empty), {});
    const Capture capture(scene, picture("morton"));
    const auto warps = all_warps(capture);
    const std::uint32_t used = 2 * capture.header().warps_per_kernel();
    for (const auto& warp : warps)
        if (warp.warp >= used) REQUIRE(warp.records.empty());
    CHECK(wavefront_picture(capture)[7] == Vec3{1, 1, 1});
}
