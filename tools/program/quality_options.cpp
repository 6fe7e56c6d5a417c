#include "tools/program/quality_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "tools/jobs/costs.hpp"
#include "tools/program/console.hpp"
#include "tools/program/idle_options.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

namespace {

std::vector<std::string> independent_strategies() {
    std::vector<std::string> names;
    for (const auto& entry : tracer::decorrelations())
        if (entry.independent_pixels) names.push_back(entry.name);
    return names;
}

}  // namespace

void QualityOptions::add(Command& command, bool require_gpu) {
    scene.add_name(command);
    command.group("Reference");
    command.add_option("--reference-spp", reference_spp, "samples per pixel of the reference")
        ->range(std::uint64_t{2}, std::uint64_t{1} << 32);
    command
        .add_option("--reference-strategy", reference_strategy,
                    "how the reference is sampled: random, or another that is unbiased and independent from pixel to "
                    "pixel, such as cranley-patterson, which needs fewer samples")
        ->choices("strategy", strategy_names());
    command
        .add_option("--reference", reference_file,
                    "picture that keeps the reference; default: a file in the user's cache folder, found by scene and "
                    "settings")
        ->type_name("FILE.exr");
    command.group("");
    command.add_option("--clamp", clamp,
                       "radiance that no channel of a sample exceeds, in pictures and reference alike: fireflies then "
                       "do not decide; default: none");
    command.add_option("--repeats", repeats, "pictures of each strategy, with seeds one after the other")
        ->range(std::uint64_t{1}, std::uint64_t{1024});
    command
        .add_option("--baseline", baseline,
                    "strategy that ratios refer to; default: cranley-patterson where it is compared")
        ->choices("strategy", strategy_names());
    json.add(command);
    width.add(command);
    command.add_flag("--csv", csv, "print CSV")->excludes({"--json"});
    threads.add(command);
    gpu.add_names(command, "GPU preset or FILE.toml whose time is predicted (see 'raycache list gpus')")
        ->count(1)
        ->required(require_gpu);
    gpu.add_changes(command);
    scene.add_view(command);
    sampling.add_launches(command);
    sampling.add_picture(command);
    sampling.add_strategy(command);
}

std::string QualityOptions::baseline_of(const std::vector<std::string>& strategies) const {
    const std::string usual = "cranley-patterson";
    if (!baseline.empty()) return baseline;
    return std::find(strategies.begin(), strategies.end(), usual) != strategies.end() ? usual : "";
}

QualityReport QualityOptions::measure(const Command& command, QualityRequest request, const FileNames& outputs,
                                      Deliveries& deliveries, Progress& progress) const {
    if (json && csv) throw UsageError("--json and --csv together; expected one of them");
    if (!gpu.names.empty()) {
        request.gpu = gpu.load_one(outputs, command.name());
        gpu.check_timed({*request.gpu});
    }
    request.repeats = repeats;
    request.clamp = clamp;
    check(request);
    tracer::check_clamp(clamp);
    if (reference_spp < 2) throw UsageError(fmt::format("--reference-spp {}; expected 2 or more", reference_spp));
    if (!reference_file.empty() && !reference_file.ends_with(".exr"))
        throw UsageError(fmt::format("--reference {}; expected a name that ends in .exr", reference_file));
    if (!tracer::find_decorrelation(reference_strategy).independent_pixels)
        throw UsageError(
            fmt::format("--reference-strategy {}; expected one without bias and without error that pixels share: {}",
                        reference_strategy, fmt::join(independent_strategies(), ", ")));
    tracer::StrategySettings reference_settings;
    reference_settings.decorrelation = reference_strategy;
    const tracer::SamplingStrategy valid(reference_settings,
                                         tracer::path_dimensions(request.cases.front().paths.bounces));
    warn_of_settings(command, request.cases, {request.gpu.has_value(), "without --gpu no time is predicted"});

    std::error_code error;
    check_outputs(outputs, warn);
    if (!std::filesystem::exists(reference_file, error)) check_outputs({reference_file}, warn);
    const auto limit = threads.apply();
    const tracer::CaptureSettings& first = request.cases.front();
    expect_stages(progress, request,
                  render_cost(std::uint64_t{first.width} * first.height * reference_spp, first.paths.bounces));
    const auto prepared = scene.prepare(outputs, progress);
    QualityReport result;
    tracer::Reference reference = find_reference(
        *prepared, {first.width, first.height, first.paths, reference_spp, reference_strategy, "sobol", clamp},
        reference_file, result.reference_path, deliveries, progress);
    result.scene = prepared->scene().name;
    result.baseline = request.baseline;
    result.gpu = request.gpu ? request.gpu->name : "";
    if (request.gpu) result.subject.gpus = {gpu_json(*request.gpu)};
    result.reference_spp = reference_spp;
    result.repeats = repeats;
    result.clamp = clamp;
    result.width = first.width;
    result.height = first.height;
    result.rows = measure_quality(*prepared, reference, request, progress);
    result.reference = std::move(reference.mean);
    add_notes(result);
    if (request.gpu)
        if (std::string note = cachesim::no_time_note(*request.gpu); !note.empty())
            result.notes.push_back(std::move(note));
    return result;
}

}  // namespace raycache::tools
