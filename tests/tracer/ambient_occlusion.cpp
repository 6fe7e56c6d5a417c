// Ambient occlusion by rays in the world and by marches on the screen, where the answer is known.
#include <catch2/catch.hpp>

#include "test_rays.hpp"
#include "tracer/capture.hpp"
#include "tracer/paths/depth_buffer.hpp"
#include "tracer/render.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

constexpr std::uint32_t size = 24;
const std::vector<std::string> both{"ao", "ssao"};

using Given = std::map<std::string, std::string>;

RenderSettings picture(const std::string& integrator, const Given& given = {}, std::uint64_t spp = 16) {
    RenderSettings settings;
    settings.width = settings.height = size;
    settings.paths.integrator = integrator;
    for (const auto& [name, value] : given) settings.paths.parameters.set(name, value);
    settings.strategy.decorrelation = "cranley-patterson";
    settings.strategy.samples.spp = spp;
    return settings;
}

double mean_of(const Image& image) {
    double sum = 0;
    for (const Vec3 p : image.pixels) sum += static_cast<double>(p.x);
    return sum / static_cast<double>(image.pixels.size());
}

Scene seen_from(Scene scene, Vec3 eye, Vec3 at, float fov = 45) {
    const Vec3 forward = normalize(at - eye), right = normalize(cross(forward, {0, 1, 0.01F}));
    scene.cameras[0] = {"test", eye, forward, cross(right, forward), fov};
    return scene;
}

/// A floor y = 0 and a wall x = 0, both far larger than what is seen of them.
Scene corner_room() {
    Scene scene = quad({0, 0, 40}, {40, 0, 40}, {40, 0, -40}, {0, 0, -40});
    append(scene, quad({0, 0, 40}, {0, 0, -40}, {0, 40, -40}, {0, 40, 40}));
    return scene;
}

CaptureSettings capture_of(const Given& given, std::uint32_t width, std::uint32_t height) {
    CaptureSettings settings;
    settings.width = width;
    settings.height = height;
    settings.paths.integrator = "ssao";
    for (const auto& [name, value] : given) settings.paths.parameters.set(name, value);
    settings.strategy.samples.spp = 16;
    settings.trace_samples = 2;
    return settings;
}

/// Records of a region, or of ray starts, in a warp.
std::size_t records_of(const traces::WarpTrace& warp, std::uint8_t region) {
    return static_cast<std::size_t>(
        std::count_if(warp.records.begin(), warp.records.end(), [&](const auto& r) { return r.region == region; }));
}

}  // namespace

TEST_CASE("ambient occlusion: a plane is open, from straight above and from a slant, in every format of depth") {
    const Scene plane = quad({-500, 0, 500}, {500, 0, 500}, {500, 0, -500}, {-500, 0, -500});
    for (const Vec3 eye : {Vec3{0, 5, 0}, Vec3{0, 5, 5}, Vec3{3, 1, 20}, Vec3{-40, 2, 7}}) {
        const PreparedScene scene(seen_from(plane, eye, {0, 0, 0}, 20), {});
        for (const char* radius : {"0.5", "3", "100"}) {
            CHECK(mean_of(render(scene, picture("ao", {{"radius", radius}}), {})) == 1);
            for (const char* layout : {"linear", "tiled"})
                for (const char* bytes : {"2", "4"}) {
                    INFO(eye.x << " " << eye.y << " " << eye.z << ", radius " << radius << ", " << bytes << " bytes");
                    const Given given{{"radius", radius}, {"depth-layout", layout}, {"depth-bytes", bytes}};
                    CHECK(mean_of(render(scene, picture("ssao", given), {})) == 1);
                }
        }
    }
}

TEST_CASE("ambient occlusion: a radius of 0 sees nothing in the way, and the sky is open") {
    Scene dense = soup(500, 1, 3);
    const PreparedScene scene(seen_from(dense, {0, 0.2F, 4}, {0, 0, 0}), {});
    const PreparedScene away(seen_from(dense, {0, 0.2F, 4}, {0, 0.2F, 9}), {});
    for (const std::string& name : both) {
        CHECK(mean_of(render(scene, picture(name, {{"radius", "0"}}), {})) == 1);
        CHECK(mean_of(render(away, picture(name), {})) == 1);
        CHECK(mean_of(render(scene, picture(name, {{"radius", "2"}}), {})) < 0.98);
    }
    CHECK(mean_of(render(scene, picture("ssao", {{"radius", "2"}, {"thickness", "0"}}), {})) == 1);
}

TEST_CASE("ambient occlusion: at the foot of a wall half of the light is gone, in the world and on the screen") {
    // The floor 1 cm from the wall, a patch of 1 cm: rays into the quarter towards the wall meet it.
    const PreparedScene near_wall(seen_from(corner_room(), {0.5F, 0.5F, 0}, {0.02F, 0, 0}, 1), {});
    CHECK(mean_of(render(near_wall, picture("ao", {{"radius", "5"}}, 64), {})) == Approx(0.5).margin(0.03));
    // The crease from a distance, floor and wall both seen: both see the same.
    const PreparedScene crease(seen_from(corner_room(), {4, 4, 0}, {0, 0, 0}), {});
    const double world = mean_of(render(crease, picture("ao", {{"radius", "2"}}, 64), {}));
    const double screen =
        mean_of(render(crease, picture("ssao", {{"radius", "2"}, {"thickness", "10"}, {"steps", "64"}}, 64), {}));
    CHECK(world < 0.9);
    CHECK(screen == Approx(world).margin(0.04));
}

TEST_CASE("ambient occlusion: a larger radius closes more, up to the whole scene") {
    const PreparedScene scene(seen_from(soup(500, 1, 3), {0, 0.2F, 4}, {0, 0, 0}), {});
    double before = 1;
    for (const char* radius : {"0.05", "0.3", "8"}) {
        const double now = mean_of(render(scene, picture("ao", {{"radius", radius}}), {}));
        CHECK(now < before);
        before = now;
    }
    CHECK(mean_of(render(scene, picture("ao", {{"radius", "1e18"}}), {})) == Approx(before).margin(1e-6));
}

TEST_CASE("ssao: a layout changes where depths lie, never the picture; the defaults are what they are said to be") {
    const PreparedScene scene(seen_from(soup(500, 1, 3), {0, 0.2F, 4}, {0, 0, 0}), {});
    const Image rows = render(scene, picture("ssao"), {});
    CHECK(render(scene, picture("ssao", {{"depth-layout", "tiled"}}), {}).pixels == rows.pixels);
    CHECK(render(scene, picture("ssao", {{"radius", "auto"}, {"thickness", "auto"}, {"steps", "8"}}), {}).pixels ==
          rows.pixels);
    CHECK(render(scene, picture("ssao", {{"steps", "1"}}), {}).pixels != rows.pixels);
    CHECK_NOTHROW(render(scene, picture("ssao", {{"steps", "1024"}, {"radius", "1e18"}}), {}));
}

TEST_CASE("ssao: a trace has depths and normals alone, and a ray of each pixel reads its own first") {
    const PreparedScene scene(seen_from(soup(500, 1, 3), {0, 0.2F, 4}, {0, 0, 0}), {});
    for (const char* layout : {"linear", "tiled"}) {
        const Capture capture(scene, capture_of({{"depth-layout", layout}, {"depth-bytes", "2"}}, 40, 24));
        const auto& regions = capture.header().regions;
        REQUIRE(regions.size() == 2);
        CHECK((regions[0].kind == traces::ObjectKind::depth && regions[0].stride == 2));
        CHECK((regions[1].kind == traces::ObjectKind::normal && regions[1].stride == 4));
        CHECK(regions[0].address(regions[0].count) <= regions[1].base);
        CHECK(capture.header().provenance.bounces == 0);
        const DepthBuffer places(40, 24, {layout == std::string("tiled") ? DepthLayout::tiled : DepthLayout::linear, 2},
                                 1);
        const auto worker = capture.make_worker();
        std::size_t depths = 0;
        for (std::uint32_t w = 0; w < capture.header().warps_per_launch; ++w) {
            traces::WarpTrace warp;
            capture.trace_warp(*worker, 0, w, warp);
            std::array<PathLane, traces::warp_lanes> jobs;
            const std::uint32_t mask = capture.lane_jobs(0, w, jobs);
            if (mask == 0) continue;
            REQUIRE(warp.records.size() >= 2);
            CHECK((warp.records[0].region == traces::ray_start && warp.records[0].mask == mask));
            CHECK((warp.records[1].region == 0 && warp.records[1].mask == mask));
            std::size_t e = 0;
            for (std::uint32_t m = mask; m != 0; m &= m - 1) {
                const PathLane& lane = jobs[static_cast<unsigned>(std::countr_zero(m))];
                CHECK(warp.elements[e++] == places.element(lane.x, lane.y));
            }
            CHECK(records_of(warp, 1) <= 1);
            CHECK(records_of(warp, 0) <= 1 + 8);  // its own, and 8 steps
            depths += records_of(warp, 0);
        }
        CHECK(depths > 3 * capture.header().warps_per_launch);
    }
}

TEST_CASE("ssao: a picture of one pixel, and one of the sky, read what they must") {
    const PreparedScene scene(seen_from(soup(500, 1, 3), {0, 0.2F, 4}, {0, 0, 0}), {});
    const PreparedScene away(seen_from(soup(500, 1, 3), {0, 0.2F, 4}, {0, 0.2F, 9}), {});
    for (const PreparedScene* one : {&scene, &away}) {
        const Capture capture(*one, capture_of({}, 1, 1));
        CHECK(capture.header().regions[0].count == 1);
        traces::WarpTrace warp;
        capture.trace_warp(*capture.make_worker(), 0, 0, warp);
        CHECK(std::all_of(warp.elements.begin(), warp.elements.end(), [](std::uint32_t e) { return e == 0; }));
        if (one == &away) CHECK(warp.records.size() == 2);  // begins, and reads its depth
    }
}

TEST_CASE("ssao: what is prepared is shared by the captures of a scene with the same settings") {
    const PreparedScene scene(seen_from(soup(500, 1, 3), {0, 0.2F, 4}, {0, 0, 0}), {});
    const Capture a(scene, capture_of({}, 40, 24)), b(scene, capture_of({}, 40, 24));
    CHECK(a.integrator_data() == b.integrator_data());
    CHECK(Capture(scene.in_layout("bvh4"), capture_of({}, 40, 24)).integrator_data() == a.integrator_data());
    CHECK(Capture(scene, capture_of({}, 24, 40)).integrator_data() != a.integrator_data());
    CHECK(Capture(scene, capture_of({{"depth-bytes", "2"}}, 40, 24)).integrator_data() != a.integrator_data());
    CaptureSettings paths = capture_of({}, 40, 24);
    paths.paths = {};
    CHECK(Capture(scene, paths).integrator_data() == nullptr);
}

TEST_CASE("ambient occlusion: values that a parameter cannot have, and names that none has, are refused") {
    const auto refused = [](const char* name, const char* value, const char* message) {
        PathSettings settings;
        settings.integrator = "ssao";
        settings.parameters.set(name, value);
        CHECK_THROWS_AS(check(settings), UsageError);
        CHECK_THROWS_WITH(check(settings), Catch::Contains(message) && Catch::Contains(value));
    };
    refused("radius", "-1", "the radius must be 0 to 1e+18, or 'auto'");
    refused("radius", "wide", "found wide: give --radius such as 0.5");
    refused("steps", "0", "must be 1 to 1024");
    refused("steps", "1025", "must be 1 to 1024");
    refused("thickness", "nan", "the thickness must be");
    refused("depth-layout", "morton", "depth layout must be one of: linear, tiled");
    refused("depth-bytes", "3", "one of: 2, 4");
    PathSettings unknown;
    unknown.parameters.set("raduis", "1");
    CHECK_THROWS_WITH(check(unknown), Catch::Contains("did you mean 'radius'?"));
}
