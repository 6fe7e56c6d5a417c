#include "tools/jobs/capture_job.hpp"

#include <atomic>

#include "tools/jobs/costs.hpp"
#include "tracer/capture.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

CaptureResult run(const CaptureJob& job, Observer& observer) {
    if (job.output.empty()) throw UsageError("a capture without an output; expected the name of a file");
    const tracer::CaptureSettings settings = capture_settings(job.scene, job.sampling, job.strategy);
    warn_of_strategies({settings}, observer);
    check_outputs({job.output}, observer.warning());
    observer.resumable("a capture cannot go on where it ended: run the same command again");
    observer.expect("trace", Work::trace, trace_cost(settings));
    const auto scene = of_case(job.scene, job.strategy).prepare({job.output}, observer);
    const tracer::Capture capture(*scene, settings);
    const traces::Header& header = capture.header();
    CaptureResult result;
    result.warps = std::uint64_t{header.warps_per_launch} * header.launches.size();
    const Stage stage(observer, "trace", result.warps, "rays");
    std::atomic<std::uint64_t> traced{0};
    tracer::write_capture(capture, job.output, [&](std::uint64_t warps, std::uint64_t rays) {
        stage.add(warps, rays);
        traced += rays;
    });
    result.rays = traced;
    result.trace = trace_json(header, job.output);
    return result;
}

}  // namespace raycache::tools
