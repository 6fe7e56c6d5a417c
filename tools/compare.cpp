// raycache compare: strategies side by side, from trace files or straight from a scene.
#include <fmt/format.h>

#include <set>

#include "tools/commands.hpp"
#include "tools/console.hpp"
#include "tools/costs.hpp"
#include "tools/idle_options.hpp"
#include "tools/interruption.hpp"
#include "tools/options.hpp"
#include "tools/report_options.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

struct Options {
    std::vector<std::string> traces;
    SceneOptions scene;
    std::vector<std::string> strategies{"coherent", "cranley-patterson", "micro-jitter"};
    std::vector<std::string> sequences{"sobol"};
    std::vector<std::uint64_t> spp{64};
    std::vector<std::string> ks{"2.5"};
    SamplingOptions sampling;
    ReportOptions report;
    ThreadOptions threads;
};

/// One for each sequence, N, strategy and K; a strategy without K once.
std::vector<tracer::CaptureSettings> settings_of(const Options& o) {
    std::vector<tracer::CaptureSettings> all;
    std::set<std::string> seen;
    for (const std::string& sequence : o.sequences)
        for (const std::uint64_t spp : o.spp)
            for (const std::string& strategy : o.strategies)
                for (const std::string& k : o.ks) {
                    SamplingOptions sampling = o.sampling;
                    sampling.k = k;
                    const auto settings = sampling.capture(o.scene, sequence, strategy, spp);
                    const tracer::SamplingStrategy made(settings.strategy,
                                                        tracer::path_dimensions(settings.paths.bounces));
                    if (o.ks.size() == 1 ||
                        seen.insert(fmt::format("{} {} {} {}", sequence, spp, strategy, made.parameters())).second)
                        all.push_back(settings);
                }
    return all;
}

void compare_fused(const Options& o, const CLI::App& command, const std::vector<cachesim::Gpu>& gpus,
                   Progress& progress) {
    const std::vector<tracer::CaptureSettings> settings = settings_of(o);
    warn_of_settings(command, settings);
    advise_if_interrupted(
        "nothing can be resumed: run the same command again, or keep traces with 'raycache capture' and compare those");
    double seconds = 0;
    for (const auto& s : settings)
        seconds += trace_cost(s) + static_cast<double>(gpus.size()) * replay_cost(s, o.report.timed);
    progress.expect("replay", o.report.timed ? Work::timed_replay : Work::replay, seconds);
    const auto scene = o.scene.prepare(o.report.outputs(), progress);
    std::vector<std::unique_ptr<tracer::Capture>> captures;
    captures.reserve(settings.size());
    for (const auto& s : settings) captures.push_back(std::make_unique<tracer::Capture>(*scene, s));
    o.report.replay_and_publish(sources_of(captures), {}, gpus, progress);
}

void run(const Options& o, const CLI::App& command) {
    if (o.traces.empty() == o.scene.source.empty())
        throw UsageError("nothing to compare; expected either trace files or --scene, not both");
    if (!o.traces.empty())
        for (const std::string& line : idle_on_traces(command)) warn(line);
    const auto gpus = o.report.load_gpus(o.traces);
    const auto limit = o.threads.apply();
    Progress progress("compare");
    if (o.traces.empty()) return compare_fused(o, command, gpus, progress);
    const TraceFiles files(o.traces);
    o.report.replay_and_publish(files.sources, o.traces, gpus, progress);
}

}  // namespace

void add_compare(CLI::App& app) {
    auto o = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("compare", "Compare strategies, from trace files or (fused, no files) from a scene");
    command->add_option("TRACES", o->traces, "trace files");
    o->scene.add(*command, false);
    command
        ->add_option(
            "--strategy", o->strategies,
            "decorrelations, separated by commas; NAME+wavefront or NAME+ORDER runs one as a wavefront, without "
            "sorting or with its rays sorted so")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    command->add_option("--sequence", o->sequences, "sequences, separated by commas")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    command->add_option("--spp", o->spp, "sizes N of the sample set, separated by commas")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    o->sampling.add_launches(*command);
    o->sampling.add_execution(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    command->remove_option(command->get_option("--k"));  // of one strategy; here it is a list
    command
        ->add_option("--k", o->ks,
                     "K of micro-jitter's mu = min(1, K * N^(-1/s)), or 'discrepancy': (N * D*_N)^(1/s); several, "
                     "separated by commas, make a row each")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    o->report.add(*command, true);
    o->threads.add(*command);
    command->footer(
        "Examples:\n"
        "  raycache compare cp.rct mj.rct coherent.rct --gpu gtx-980-ti --gpu h100\n"
        "  raycache compare --scene courtyard --strategy coherent,cranley-patterson,micro-jitter --spp 16,256,1024 "
        "--gpu gtx-980-ti\n"
        "  raycache compare --scene sponza.glb --sequence sobol,halton --gpu h100 --by bounce --csv\n"
        "  raycache compare --scene courtyard --strategy cranley-patterson,cranley-patterson+wavefront,"
        "cranley-patterson+meister,micro-jitter --gpu h100");
    command->callback([o, command] { run(*o, *command); });
}

}  // namespace raycache::tools
