#include "tools/jobs/quality_job.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "cachesim/report/traversal_note.hpp"
#include "cachesim/report/window_notes.hpp"
#include "tools/jobs/costs.hpp"
#include "tracer/render.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

std::vector<std::string> independent_strategies() {
    std::vector<std::string> names;
    for (const auto& entry : tracer::decorrelations())
        if (entry.independent_pixels) names.push_back(entry.name);
    return names;
}

void check_reference(const QualityJob& job, const QualityRequest& request) {
    tracer::check_clamp(job.clamp);
    if (job.reference_spp < 2)
        throw UsageError(fmt::format("--reference-spp {}; expected 2 or more", job.reference_spp));
    if (!job.reference_file.empty() && !job.reference_file.ends_with(".exr"))
        throw UsageError(fmt::format("--reference {}; expected a name that ends in .exr", job.reference_file));
    if (!tracer::find_decorrelation(job.reference_strategy).independent_pixels)
        throw UsageError(
            fmt::format("--reference-strategy {}; expected one without bias and without error that pixels share: {}",
                        job.reference_strategy, fmt::join(independent_strategies(), ", ")));
    tracer::StrategySettings settings;
    settings.decorrelation = job.reference_strategy;
    const tracer::SamplingStrategy valid(settings, tracer::sample_dimensions(request.cases.front().paths));
}

}  // namespace

QualityRequest QualityJob::request() const {
    QualityRequest request;
    request.cases = capture_settings(scene, sampling, cases);
    request.baseline = baseline;
    request.repeats = repeats;
    request.pairs = pairs;
    request.equal_time = equal_time;
    request.clamp = clamp;
    request.estimate = estimate;
    request.estimate.baseline = baseline;
    if (!time_resolution.empty()) {
        const Resolution size = parse_resolution(time_resolution);
        request.time_width = size.width;
        request.time_height = size.height;
    }
    estimate.check();
    const auto is_wavefront = [](const tracer::CaptureSettings& c) {
        return c.execution.execution != tracer::Execution::megakernel;
    };
    if (estimate.windows && std::any_of(request.cases.begin(), request.cases.end(), is_wavefront))
        throw UsageError("windows of wavefronts; expected --execution megakernel");
    check(request);
    return request;
}

QualityResult run(const QualityJob& job, const std::optional<cachesim::Gpu>& gpu, Observer& observer,
                  Deliveries& deliveries, const FileNames& outputs) {
    QualityRequest request = job.request();
    request.gpu = gpu;
    check_reference(job, request);
    warn_of_strategies(request.cases, observer);
    FileNames written = outputs;
    written.push_back(job.reference_file);
    refuse_same_outputs(written);
    std::error_code error;
    if (!std::filesystem::exists(job.reference_file, error)) check_outputs({job.reference_file}, observer.warning());

    const tracer::CaptureSettings& first = request.cases.front();
    const std::uint64_t pixels = std::uint64_t{first.width} * first.height;
    expect_stages(observer, request, render_cost(pixels * job.reference_spp, first.paths.bounces));
    const auto scene = job.scene.prepare(outputs, observer);
    QualityResult result;
    QualityReport& report = result.report;
    tracer::Reference reference = find_reference(
        *scene, {first.width, first.height, first.paths, job.reference_spp, job.reference_strategy, "sobol", job.clamp},
        job.reference_file, report.reference_path, deliveries, observer);
    report.scene = scene->scene().name;
    report.baseline = job.baseline;
    report.gpu = gpu ? gpu->name : "";
    if (gpu && !job.time_resolution.empty()) report.time_resolution = job.time_resolution;
    if (gpu) report.subject.gpus = {gpu_json(*gpu)};
    report.reference_spp = job.reference_spp;
    report.repeats = job.repeats;
    report.clamp = job.clamp;
    report.width = first.width;
    report.height = first.height;
    report.rows = measure_quality(*scene, reference, request, observer, result.pictures);
    result.pictures.reference = std::move(reference.mean);
    add_notes(report);
    if (const auto& timing = report.rows.front().timing; timing && timing->windows)
        report.notes.push_back("predicted times: " + cachesim::window_note(*timing->windows));
    if (gpu)
        if (std::string note = cachesim::no_time_note(*gpu); !note.empty()) report.notes.push_back(std::move(note));
    if (gpu && gpu->traversal == cachesim::Traversal::rt_unit)
        report.notes.push_back("predicted times: " + cachesim::traversal_note({gpu->name}, false));
    return result;
}

QualityResult run(const QualityJob& job, Observer& observer, Deliveries& deliveries, const FileNames& outputs) {
    std::optional<cachesim::Gpu> gpu;
    if (!job.gpu.names.empty()) {
        gpu = job.gpu.load_one(outputs, "quality");
        job.gpu.check_timed({*gpu});
    }
    return run(job, gpu, observer, deliveries, outputs);
}

}  // namespace raycache::tools
