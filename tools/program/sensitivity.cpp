// raycache sensitivity: how far predicted speed-ups hang on what presets assume.
#include <fmt/format.h>

#include "cachesim/report/sensitivity_report.hpp"
#include "tools/jobs/sensitivity_job.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/estimate_options.hpp"
#include "tools/program/gpu_options.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "tools/program/table_output.hpp"
#include "tracer/strategy_groups.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

struct SensitivityArguments {
    SceneOptions scene;
    std::vector<std::string> strategies{"cranley-patterson", "micro-jitter"};
    std::string sequence = "sobol", baseline;
    std::uint64_t spp = 64;
    SamplingOptions sampling;
    GpuOptions gpu;
    std::uint32_t windows = 16, varied_windows = 8, sms = 0, samples = 32;
    std::uint64_t hypercube_seed = 1;
    TableOutput output;
    ThreadOptions threads;
};

SensitivityJob job_of(const SensitivityArguments& o, const Command& command) {
    SensitivityJob job;
    job.launches.scene = o.scene;
    job.launches.sampling = o.sampling;
    job.whole_launches = command.find_option("--trace-samples")->given();
    if (!job.whole_launches && !command.find_option("--resolution")->given())
        job.launches.sampling.resolution = window_resolution;
    for (const std::string& strategy : tracer::expand_groups(o.strategies))
        job.launches.cases.push_back({tracer::parse_strategy_name(strategy), o.sequence, o.spp, {}, {}});
    job.gpus = o.gpu.names;
    job.changes = o.gpu.changes;
    job.baseline = o.baseline;
    job.variations = {o.samples, o.hypercube_seed, o.sms};
    job.windows = o.windows;
    job.varied_windows =
        command.find_option("--varied-windows")->given() ? o.varied_windows : std::min(o.varied_windows, o.windows);
    return job;
}

void publish(const SensitivityArguments& o, const SensitivityJob& job, SensitivityResult result) {
    cachesim::SensitivityReport report;
    report.rows = std::move(result.rows);
    report.sample = job.whole_launches
                        ? fmt::format("{} whole launches", job.launches.sampling.trace_samples)
                        : fmt::format("{} windows, {} with other values", job.windows, job.varied_windows);
    if (job.variations.sms != 0) report.model = fmt::format("scale model of {} SMs", job.variations.sms);
    o.output.publish(report, result.subject);
}

Action plan(const std::shared_ptr<SensitivityArguments>& o, const Command* command) {
    o->output.check();
    const SensitivityJob job = job_of(*o, *command);
    job.check();
    return [o, command, job] {
        warn_of_idle(*command, job.launches.captures());
        check_outputs({}, warn);
        const auto limit = o->threads.apply();
        Progress progress("sensitivity");
        publish(*o, job, run(job, progress));
    };
}

}  // namespace

void add_sensitivity(Program& program) {
    auto o = std::make_shared<SensitivityArguments>();
    Command* command = program.add_subcommand(
        "sensitivity", "How far predicted speed-ups hang on values of GPUs that no one has measured");
    o->scene.add_name(*command);
    o->gpu.add_names(*command, "GPU preset or FILE.toml (see 'raycache list gpus')")->required();
    add_strategies(*command, o->strategies, {});
    command->add_option("--sequence", o->sequence, "the sequence of all")->choices("sequence", sequence_names());
    add_spp(*command, o->spp, "size N of the sample set");
    o->threads.add(*command);
    command->group("Variation");
    command
        ->add_option("--windows", o->windows,
                     "windows in time of each strategy by which the speed-up with the file's values is told: runs of "
                     "neighbouring warps at random places of random sample indices")
        ->range(std::uint64_t{2}, std::uint64_t{512})
        ->excludes({"--trace-samples"});
    command
        ->add_option("--varied-windows", o->varied_windows,
                     "how many of them are replayed with other values; default: 8, or all where they are fewer")
        ->range(std::uint64_t{2}, std::uint64_t{512})
        ->default_text("")
        ->excludes({"--trace-samples"});
    command
        ->add_option("--sms", o->sms,
                     "ask a scale model of so many SMs, with their share of L2 and DRAM, how values change the "
                     "speed-up: as much faster as it is smaller")
        ->range(std::uint64_t{1}, std::uint64_t{4096})
        ->default_text("all")
        ->excludes({"--trace-samples"});
    command->add_option("--samples", o->samples, "points of the Latin hypercube, in which all values change at once")
        ->range(std::uint64_t{0}, std::uint64_t{4096});
    command->add_option("--hypercube-seed", o->hypercube_seed, "another number: other points of it")
        ->range(std::uint64_t{0}, std::uint64_t{1} << 32);
    command
        ->add_option("--baseline", o->baseline,
                     "strategy that speed-ups are held against; default: cranley-patterson where it is among them")
        ->check(strategy_name_check());
    command->add_option("--set", o->gpu.changes, "KEY=VALUE: another value of every GPU, which is then not varied")
        ->repeated()
        ->type_name("KEY=VALUE");
    o->output.add(*command, "print CSV: a line for each point");
    command->group("");
    o->scene.add_view(*command);
    o->sampling.add_launches(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    command->examples(
        {"raycache sensitivity courtyard --gpu rtx-3070 --spp 1024 --k 1 --windows 8 --sms 4",
         "raycache sensitivity sponza.glb --gpu gtx-980-ti,rtx-3070 --spp 1024 --k 1 --csv",
         "raycache sensitivity courtyard --gpu gtx-980-ti --trace-samples 2 --resolution 64x64 --samples 8"});
    command->plan([o, command] { return plan(o, command); });
}

}  // namespace raycache::tools
