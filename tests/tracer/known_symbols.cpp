// The symbols that the traversal keeps are as good as those the trace writer would search for.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "test_rays.hpp"
#include "tracer/capture.hpp"
#include "traces/error.hpp"
#include "traces/reader.hpp"
#include "traces/writer.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

PreparedScene holed_soup() {
    Scene scene = soup(2000, 0.3F, 1);
    scene.sun = Sun{{0, 1, 0}, {1, 1, 1}};
    scene.sky = {1, 1, 1};
    scene.cameras[0] = {"front", {0, 0, 3}, {0, 0, -1}, {0, 1, 0}, 45};
    return with_holes(std::move(scene));
}

CaptureSettings picture() {
    CaptureSettings settings;
    settings.width = 80;
    settings.height = 56;
    settings.trace_samples = 2;
    settings.strategy.samples.spp = 64;
    return settings;
}

struct Traced {
    std::vector<traces::WarpTrace> warps;
    std::vector<traces::WarpSymbols> symbols;
};

Traced trace(const Capture& capture) {
    Traced out;
    const auto worker = capture.make_worker();
    for (std::uint32_t warp = 0; warp < capture.header().warps_per_launch; ++warp) {
        capture.trace_warp(*worker, 0, warp, out.warps.emplace_back());
        capture.last_symbols(*worker, out.symbols.emplace_back());
    }
    return out;
}

/// Writes a trace of one launch and reads it back.
std::vector<traces::WarpTrace> read_back(traces::Header header, const Traced& traced, bool with_symbols) {
    const auto path =
        std::filesystem::temp_directory_path() / ("raycache_symbols_" + std::to_string(getpid()) + ".rct");
    header.launches.resize(1);
    traces::Writer writer(path.string(), header);
    writer.append(with_symbols ? traces::encode_block(header, traced.warps, traced.symbols)
                               : traces::encode_block(header, traced.warps));
    writer.finish();
    std::vector<traces::WarpTrace> warps;
    traces::Reader(path.string()).read_block(0, warps);
    std::filesystem::remove(path);
    return warps;
}

}  // namespace

TEST_CASE("symbols: with them a trace holds the records that were traced, also where rays read texels on their way") {
    const PreparedScene scene = holed_soup();
    for (const std::uint32_t bounces : {0U, 3U}) {
        CaptureSettings settings = picture();
        settings.paths.bounces = bounces;
        const Capture capture(scene, settings);
        const Traced traced = trace(capture);
        std::size_t texels = 0, literals = 0;
        for (const auto& warp : traced.warps)
            for (const traces::Record& r : warp.records) texels += r.region == Bvh2::region_count;
        for (const auto& symbols : traced.symbols)
            literals += static_cast<std::size_t>(std::count(symbols.begin(), symbols.end(), traces::symbol::literal));
        CHECK(texels > 300);
        CHECK(literals > 1000);
        CHECK(read_back(capture.header(), traced, true) == traced.warps);
        CHECK(read_back(capture.header(), traced, false) == traced.warps);
    }
}

TEST_CASE("symbols: a block written with them is no larger") {
    const PreparedScene scene = holed_soup();
    const Capture capture(scene, picture());
    const Traced traced = trace(capture);
    const std::size_t searched = traces::encode_block(capture.header(), traced.warps).bytes.size();
    const std::size_t known = traces::encode_block(capture.header(), traced.warps, traced.symbols).bytes.size();
    CHECK(static_cast<double>(known) < 1.01 * static_cast<double>(searched));
}

TEST_CASE("symbols: a scene of one leaf has none, and is written all the same") {
    const PreparedScene scene(mesh({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {0, 1, 2}), {});
    const Capture capture(scene, picture());
    const Traced traced = trace(capture);
    for (const auto& symbols : traced.symbols) CHECK(symbols.empty());
    CHECK(read_back(capture.header(), traced, true) == traced.warps);
}

TEST_CASE("symbols: those that do not fit the records are refused") {
    const PreparedScene scene = holed_soup();
    const Capture capture(scene, picture());
    const auto refused = [&](auto change, const char* why) {
        Traced bad = trace(capture);
        change(bad.warps[5], bad.symbols[5]);
        CHECK_THROWS_WITH(traces::encode_block(capture.header(), bad.warps, bad.symbols), Catch::Contains(why));
    };
    using Warp = traces::WarpTrace;
    using Symbols = traces::WarpSymbols;
    refused([](Warp&, Symbols& s) { s.pop_back(); }, "symbols, found");
    refused([](Warp&, Symbols& s) { s.back() = traces::symbol::literal; }, "after each literal");
    refused([](Warp& w, Symbols&) { w.records[0].ray = traces::RayType{9}; }, "ray type");
    refused([](Warp& w, Symbols&) { w.records.erase(w.records.begin()); }, "ray starts before accesses");
    refused(
        [](Warp& w, Symbols&) {
            for (std::size_t i = 0, e = 0; i < w.records.size(); ++i) {
                if (!w.records[i].is_access()) continue;
                if (w.records[i].region == Bvh2::region_count) w.elements[e] = 1U << 29U;
                e += w.records[i].lanes();
            }
        },
        "elements of region 2 below");
}
