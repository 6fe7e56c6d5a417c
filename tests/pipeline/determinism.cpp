// Equal inputs give equal bytes, whatever the number of threads and whichever way the warps travel.
#include <tbb/global_control.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "measure.hpp"
#include "traces/reader.hpp"

namespace {

using namespace raycache;
using namespace raycache::test;

const tracer::PreparedScene& small_courtyard() {
    static const tracer::PreparedScene scene = [] {
        tracer::SceneRequest request;
        request.source = "courtyard";
        request.detail = 50'000;
        return tracer::PreparedScene(tracer::load_scene(request, [](const std::string&) {}), {});
    }();
    return scene;
}

tracer::CaptureSettings small_settings(const char* strategy) {
    auto settings = capture_settings(strategy, "halton", 64, 2);
    settings.width = 100;
    settings.height = 70;
    return settings;
}

/// A file that goes with the test.
class TemporaryTrace {
public:
    explicit TemporaryTrace(const tracer::Capture& capture)
        : path_(std::filesystem::temp_directory_path() / ("raycache_test_" + std::to_string(getpid()) + ".rct")) {
        tracer::write_capture(capture, path_.string(), {});
    }
    ~TemporaryTrace() { std::filesystem::remove(path_); }
    TemporaryTrace(const TemporaryTrace&) = delete;
    TemporaryTrace& operator=(const TemporaryTrace&) = delete;

    std::string path() const { return path_.string(); }
    std::string bytes() const {
        std::ifstream in(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

private:
    std::filesystem::path path_;
};

}  // namespace

TEST_CASE("one thread and two write the same trace, byte for byte", "[threads]") {
    const tracer::Capture capture(small_courtyard(), small_settings("micro-jitter"));
    std::string one, two;
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        one = TemporaryTrace(capture).bytes();
    }
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 2);
        two = TemporaryTrace(capture).bytes();
    }
    CHECK(one.size() > 10'000);
    CHECK(one == two);
}

TEST_CASE("a trace file holds the very warps that the fused path replays", "[threads]") {
    const tracer::Capture capture(small_courtyard(), small_settings("cranley-patterson"));
    const TemporaryTrace file(capture);
    const traces::Reader reader(file.path());
    CHECK(reader.header() == capture.header());
    const auto worker = capture.make_worker();
    std::vector<traces::WarpTrace> warps;
    std::size_t compared = 0;
    for (std::size_t b = 0; b < reader.blocks().size(); ++b) {
        reader.read_block(b, warps);
        for (const traces::WarpTrace& warp : warps) {
            traces::WarpTrace direct;
            capture.trace_warp(*worker, warp.launch, warp.warp, direct);
            REQUIRE(direct == warp);
            ++compared;
        }
    }
    CHECK(compared == std::size_t{2} * capture.header().warps_per_launch);
}

TEST_CASE("which lanes read is nothing to the caches: rotated masks give equal counters") {
    const tracer::Capture capture(small_courtyard(), small_settings("cranley-patterson"));
    const cachesim::Gpu gpu = cachesim::load_gpu("rtx-3070");  // whole warps go to the tag stage
    cachesim::Replay permuted(gpu, capture.header().regions, capture.header().launches[0]);
    const auto worker = capture.make_worker();
    for (std::uint32_t w = 0; w < capture.header().warps_per_launch; ++w) {
        auto trace = std::make_shared<traces::WarpTrace>();
        capture.trace_warp(*worker, 0, w, *trace);
        // Other lanes read the same elements in the same order: the caches cannot tell.
        for (traces::Record& record : trace->records)
            record.mask = record.lanes() == 32 ? record.mask : (record.mask >> 31) | (record.mask << 1);
        permuted.push(std::move(trace));
    }
    CHECK(permuted.finish() == replay_launch(capture, 0, gpu));
}
