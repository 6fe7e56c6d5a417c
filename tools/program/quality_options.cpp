#include "tools/program/quality_options.hpp"

#include <algorithm>

#include "tools/program/console.hpp"
#include "tools/program/idle_options.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

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
    command
        .add_option("--time-resolution", time_resolution,
                    "picture whose time is predicted, where it is larger than those whose error is measured: a small "
                    "one does not fill a GPU; default: --resolution")
        ->type_name("WxH")
        ->default_text("");
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

QualityJob QualityOptions::job() const {
    QualityJob job;
    job.scene = scene;
    job.sampling = sampling;
    job.gpu = gpu;
    job.time_resolution = time_resolution;
    job.reference_spp = reference_spp;
    job.reference_strategy = reference_strategy;
    job.reference_file = reference_file;
    job.repeats = repeats;
    job.clamp = clamp;
    return job;
}

QualityResult QualityOptions::measure(const Command& command, const QualityJob& job, const FileNames& outputs,
                                      Deliveries& deliveries, Progress& progress) const {
    if (json && csv) throw UsageError("--json and --csv together; expected one of them");
    if (gpu.names.empty() && !time_resolution.empty())
        throw UsageError("--time-resolution without --gpu; expected both: without a GPU no time is predicted");
    std::optional<cachesim::Gpu> loaded;
    if (!gpu.names.empty()) {
        loaded = gpu.load_one(outputs, command.name());
        gpu.check_timed({*loaded});
    }
    warn_of_idle(command, job.request().cases, {loaded.has_value(), "without --gpu no time is predicted"});
    check_outputs(outputs, warn);
    const auto limit = threads.apply();
    return run(job, loaded, progress, deliveries, outputs);
}

}  // namespace raycache::tools
