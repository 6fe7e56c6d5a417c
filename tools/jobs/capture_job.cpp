#include "tools/jobs/capture_job.hpp"

#include <atomic>
#include <optional>

#include "tools/jobs/costs.hpp"
#include "tools/jobs/gpu_package.hpp"
#include "tracer/capture.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

CaptureResult run(const CaptureJob& job, Observer& observer) {
    if (job.output.empty() && job.gpu_package.empty())
        throw UsageError("a capture without an output; expected the name of a file, or of a folder for a GPU package");
    const tracer::CaptureSettings settings = capture_settings(job.scene, job.sampling, job.strategy);
    warn_of_strategies({settings}, observer);
    std::optional<GpuPackageFolder> package;
    if (!job.gpu_package.empty()) {
        check_gpu_package(settings);
        package.emplace(job.gpu_package);
    }
    const std::string last = package ? package->last_file() : std::string();
    check_outputs({job.output, last}, observer.warning());
    observer.resumable("a capture cannot go on where it ended: run the same command again");
    if (!job.output.empty()) observer.expect("trace", Work::trace, trace_cost(settings));
    if (!job.gpu_package.empty()) observer.expect("package", Work::trace, trace_cost(settings));
    const auto scene = of_case(job.scene, job.strategy).prepare({job.output, last}, observer);
    const tracer::Capture capture(*scene, settings);
    const traces::Header& header = capture.header();
    CaptureResult result;
    result.warps = std::uint64_t{header.warps_per_launch} * header.launches.size();
    result.trace = trace_json(header, job.output);
    if (!job.output.empty()) {
        const Stage stage(observer, "trace", result.warps, "rays");
        std::atomic<std::uint64_t> traced{0};
        tracer::write_capture(capture, job.output, [&](std::uint64_t warps, std::uint64_t rays) {
            stage.add(warps, rays);
            traced += rays;
        });
        result.rays = traced;
    }
    if (package) {
        const Stage stage(observer, "package", result.warps, "rays");
        result.rays = package->write(capture, trace_json(header, ""), stage);
    }
    return result;
}

}  // namespace raycache::tools
