// Rays logged for other walkers: those of a capture, in its order, whatever the threads; and Embree's walks of them.
#include <catch2/catch.hpp>

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "test_rays.hpp"
#include "tracer/bvh/embree_walker.hpp"
#include "tracer/simt/ray_log.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

const PreparedScene& sunny_soup() {
    static const PreparedScene scene(
        [] {
            Scene soup_scene = soup(2000, 0.3F, 1);
            soup_scene.sky = {1, 1, 1};
            soup_scene.sun = Sun{{0, 1, 0}, {1, 1, 1}};
            soup_scene.cameras[0] = {"front", {0, 0, 3}, {0, 0, -1}, {0, 1, 0}, 45};
            return soup_scene;
        }(),
        {});
    return scene;
}

CaptureSettings small_picture(ThreadMap map = ThreadMap::tile) {
    CaptureSettings settings;
    settings.width = 77;  // warps that are not full
    settings.height = 50;
    settings.thread_map = map;
    settings.strategy.samples.spp = 64;
    settings.trace_samples = 2;
    return settings;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

RayLog log_with(unsigned threads, const Capture& capture) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return log_rays(capture, 1);
}

}  // namespace

TEST_CASE("ray log: its batches are the rays that a capture records, warp by warp") {
    for (const ThreadMap map : {ThreadMap::tile, ThreadMap::samples}) {
        const Capture capture(sunny_soup(), small_picture(map));
        const RayLog log = log_rays(capture, 0);
        const auto worker = capture.make_worker();
        std::vector<RayBatch> recorded;
        std::uint64_t rays = 0;
        traces::WarpTrace trace;
        for (std::uint32_t warp = 0; warp < capture.header().warps_per_launch; ++warp) {
            capture.trace_warp(*worker, 0, warp, trace);
            for (const traces::Record& record : trace.records) {
                if (record.is_access()) continue;
                recorded.push_back({warp, record.ray, record.bounce, record.lanes(), rays});
                rays += record.lanes();
            }
        }
        CHECK(log.batches == recorded);
        CHECK(log.rays.size() == rays);
        CHECK(log.ends.size() == rays);
        CHECK(std::any_of(recorded.begin(), recorded.end(), [](const RayBatch& b) { return b.any_hit(); }));
    }
}

TEST_CASE("ray log: byte-identical for one and for two threads") {
    const Capture capture(sunny_soup(), small_picture());
    const RayLog one = log_with(1, capture), two = log_with(2, capture);
    CHECK(one.batches == two.batches);
    CHECK(same_bytes(one.rays, two.rays));
    CHECK(same_bytes(one.ends, two.ends));
}

TEST_CASE("ray log: shuffled, every ray stays once and of its kind, and few stay where they were") {
    const RayLog log = log_rays(Capture(sunny_soup(), small_picture()), 0);
    const RayLog other = shuffled(log, 3);
    CHECK(other.batches == log.batches);
    CHECK(same_bytes(other.rays, shuffled(log, 3).rays));
    std::vector<float> before[2], after[2];
    std::size_t stayed = 0;
    for (const RayBatch& batch : log.batches)
        for (std::uint64_t i = batch.first; i < batch.first + batch.count; ++i) {
            before[batch.any_hit() ? 1 : 0].push_back(log.rays[i].direction.x + log.ends[i]);
            after[batch.any_hit() ? 1 : 0].push_back(other.rays[i].direction.x + other.ends[i]);
            stayed += std::memcmp(&log.rays[i], &other.rays[i], sizeof(Ray)) == 0 ? 1 : 0;
        }
    for (const int kind : {0, 1}) {
        std::sort(before[kind].begin(), before[kind].end());
        std::sort(after[kind].begin(), after[kind].end());
        CHECK(before[kind] == after[kind]);
    }
    CHECK(stayed < log.rays.size() / 100 + 10);
}

TEST_CASE("ray log: the part of a kind holds its batches and their rays") {
    const RayLog log = log_rays(Capture(sunny_soup(), small_picture()), 0);
    const auto is_shadow = [](const RayBatch& batch) { return batch.any_hit(); };
    const RayLog shadows = only(log, is_shadow), others = only(log, [&](const RayBatch&b) { return !is_shadow(b); });
    CHECK(shadows.rays.size() + others.rays.size() == log.rays.size());
    CHECK(shadows.batches.size() ==
          static_cast<std::size_t>(std::count_if(log.batches.begin(), log.batches.end(), is_shadow)));
    for (const float end : shadows.ends) CHECK((end == 0 || std::isinf(end)));
    std::uint64_t at = 0;
    for (const RayBatch& batch : others.batches) {
        CHECK(batch.first == at);
        at += batch.count;
    }
}

TEST_CASE("Embree's walker: single rays and packets of every width and flag end where the tracer's own walk ends") {
    const RayLog log = log_rays(Capture(sunny_soup(), small_picture()), 0);
    const EmbreeWalker walker(sunny_soup().scene(), sunny_soup().texels());
    const EmbreeFacts facts = embree_facts();
    std::size_t tried = 0;
    for (const WalkMode& mode : walk_modes()) {
        if (!facts.walks(mode)) continue;
        ++tried;
        std::vector<float> ends(log.rays.size(), -1);
        for (const RayBatch& batch : log.batches) {
            const std::span<const Ray> rays(&log.rays[batch.first], batch.count);
            if (batch.any_hit())
                walker.occluded(rays, mode, &ends[batch.first]);
            else
                walker.closest(rays, mode, &ends[batch.first]);
        }
        std::size_t other = 0;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const bool same = std::isinf(log.ends[i]) || std::isinf(ends[i]) ? log.ends[i] == ends[i]
                                                                             : std::fabs(ends[i] - log.ends[i]) < 1e-4F;
            other += same ? 0 : 1;
        }
        INFO(mode.name);
        CHECK(other <= log.rays.size() / 10000);
    }
    CHECK(tried >= 1);
}

TEST_CASE("Embree's walker: a ray that Embree cannot take meets nothing, alone or in a packet") {
    const EmbreeWalker walker(sunny_soup().scene(), sunny_soup().texels());
    const Ray good{{0, 0, 3}, {0, 0, -1}}, spoilt{{0, 0, 3}, {0, 0, std::nanf("")}};
    const EmbreeFacts facts = embree_facts();
    for (const WalkMode& mode : walk_modes()) {
        if (!facts.walks(mode)) continue;
        float ends[3] = {-1, -1, -1}, alone = -1;
        walker.closest(std::vector<Ray>{spoilt, good, spoilt}, mode, ends);
        walker.closest(std::vector<Ray>{good}, mode, &alone);
        CHECK(std::isinf(ends[0]));
        CHECK(ends[1] == alone);
        CHECK(std::isinf(ends[2]));
    }
}

TEST_CASE("Embree's walker: an unknown mode is answered with those there are") {
    CHECK(walk_mode("packet8-coherent").width == 8);
    try {
        walk_mode("packet9");
        FAIL("packet9 was taken");
    } catch (const UsageError& e) {
        CHECK(std::string(e.what()).find("did you mean 'packet") != std::string::npos);
    }
}
