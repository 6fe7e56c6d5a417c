// raycache compare: strategies side by side, from trace files or straight from a scene.
#include <fmt/format.h>

#include <limits>
#include <set>

#include "tools/jobs/replay_job.hpp"
#include "tools/jobs/windows/fidelity.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/equivalent_option.hpp"
#include "tools/program/estimate_options.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/inputs.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "tools/program/report_options.hpp"
#include "tools/program/steady_options.hpp"
#include "tracer/strategy_groups.hpp"

namespace raycache::tools {
namespace {

struct CompareArguments {
    InputOptions inputs;
    SceneOptions scene;
    std::vector<std::string> strategies{"coherent", "cranley-patterson", "micro-jitter"};
    std::vector<std::string> sequences{"sobol"};
    std::vector<std::uint64_t> spp{64};
    std::vector<std::string> ks{""};  ///< empty: that of `sampling`
    std::vector<std::string> layouts{tracer::default_layout};
    SamplingOptions sampling;
    EstimateOptions estimate;
    SteadyOptions steady;
    ReportOptions report;
    ThreadOptions threads;
    bool equivalent = false;
};

/// One for each sequence, N, strategy, K and layout; a strategy without K once, one that names a layout in that alone.
std::vector<CaseSettings> cases_of(const CompareArguments& o) {
    std::vector<CaseSettings> all;
    std::set<std::string> seen;
    for (const std::string& sequence : o.sequences)
        for (const std::uint64_t spp : o.spp)
            for (const std::string& strategy : tracer::expand_groups(o.strategies))
                for (const std::string& k : o.ks)
                    for (const std::string& layout : o.layouts) {
                        CaseSettings one{tracer::parse_strategy_name(strategy), sequence, spp, k, {}};
                        if (!one.strategy.layout && layout != tracer::default_layout) one.strategy.layout = layout;
                        const auto settings = capture_settings(o.scene, o.sampling, one);
                        const tracer::SamplingStrategy made(settings.strategy,
                                                            tracer::sample_dimensions(settings.paths));
                        if ((o.ks.size() == 1 && o.layouts.size() == 1) ||
                            seen.insert(fmt::format("{} {} {} {}", sequence, spp, to_string(one.strategy),
                                                    made.parameters()))
                                .second)
                            all.push_back(one);
                    }
    return all;
}

Action plan(const std::shared_ptr<CompareArguments>& o, const Command* command) {
    const Inputs inputs = o->inputs.sorted(*command);
    o->scene.source = inputs.scene;
    o->report.timed = o->steady.in_time(o->report.timed);
    ReplayJob job = o->report.job();
    job.launches.traces = inputs.traces;
    const auto gpus = o->report.load_gpus(inputs.traces);
    if (!job.launches.of_traces()) {
        job.launches.scene = o->scene;
        job.launches.sampling = o->sampling;
        job.launches.cases = cases_of(*o);
        if (o->report.baseline.empty()) o->report.baseline = tracer::baseline_of_groups(o->strategies).value_or("");
    }
    std::string why_exact;
    job.estimate = o->estimate.settings(*command, job.launches, why_exact);
    job.estimate.baseline = o->report.baseline;
    job.estimate.across_gpus = o->report.across_gpus;
    if (o->equivalent) check_whole_launches(job.estimate);
    o->steady.apply(job);
    check_fidelity(job.estimate, gpus, job.timed);
    return [o, command, job, gpus, why_exact] {
        if (job.launches.of_traces())
            for (const std::string& line : idle_on_traces(*command)) warn(line);
        else
            warn_of_idle(*command, job.launches.captures());
        const FileNames outputs = o->report.outputs();
        check_outputs(outputs, warn);
        if (!why_exact.empty()) warn(why_exact);
        if (job.estimate.fidelity == Fidelity::exact && command->find_option("--target-error")->given())
            warn("--target-error has no effect: --fidelity exact replays all of the picture");
        const auto limit = o->threads.apply();
        Progress progress("compare");
        std::vector<std::string> remarks;
        if (o->equivalent) remarks = cache_equivalents(job.launches, gpus, o->report.baseline, progress);
        o->report.run_and_publish(job, gpus, progress, remarks);
    };
}

}  // namespace

void add_compare(Program& program) {
    auto o = std::make_shared<CompareArguments>();
    Command* command =
        program.add_subcommand("compare", "Compare strategies, straight from a scene or from trace files");
    o->inputs.add(*command, "trace files");
    add_strategies(*command, o->strategies, {});
    add_sequences(*command, o->sequences);
    add_spps(*command, o->spp, "sizes N of the sample set, separated by commas");
    o->threads.add(*command);
    o->report.add(*command, true);
    add_cache_equivalent(*command, o->equivalent, {"--counters", "--csv"});
    o->estimate.add(*command, "with --timed: of every speed-up");
    o->steady.add(*command);
    o->scene.add_view(*command);
    o->sampling.add_launches(*command);
    o->sampling.add_execution(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    command->remove_option("--k");  // of one strategy; here it is a list
    command->remove_option("--layout");
    command->group("Scene", true);
    add_layouts(*command, o->layouts);
    command->group("Sampling", true);
    command
        ->add_option("--k", o->ks,
                     "K of micro-jitter's mu = min(1, K * N^(-1/s)), or 'discrepancy': (N * D*_N)^(1/s); several, "
                     "separated by commas, make a row each")
        ->range(0.0, std::numeric_limits<double>::max())
        ->number_or("discrepancy")
        ->default_text("2.5");
    command->group("");
    command->examples(
        {"raycache compare courtyard --strategy coherent,cranley-patterson,micro-jitter --spp 16,256,1024 "
         "--gpu gtx-980-ti",
         "raycache compare cp.rct mj.rct coherent.rct --gpu gtx-980-ti --gpu h100",
         "raycache compare sponza.glb --sequence sobol,halton --gpu h100 --by bounce --csv",
         "raycache compare courtyard --strategy cranley-patterson,cranley-patterson+wavefront,"
         "cranley-patterson+meister,micro-jitter --gpu h100",
         "raycache compare courtyard --strategy cranley-patterson,cranley-patterson@classes,interleaved --gpu h100",
         "raycache compare sponza.glb --strategy cranley-patterson,micro-jitter --layout bvh2,cwbvh8 --spp 1024 "
         "--gpu rtx-3070 --timed",
         "raycache compare sponza.glb --strategy cranley-patterson,micro-jitter --spp 1024 --gpu rtx-3070 "
         "--l1-kib 128,256 --across-gpus",
         "raycache compare sponza.glb --spp 1024 --gpu rtx-3070 --fidelity auto --target-error 2%",
         "raycache compare courtyard --spp 64 --gpu rtx-3070 --timed --cold-launches 1 --resolution 320x180",
         "raycache compare sponza.glb --strategy cycles --spp 256 --gpu rtx-3070 --timed",
         "raycache compare courtyard --strategy owen@samples,scrambling-distance:mu=0.2@rows,cranley-patterson@tile "
         "--gpu rtx-3070"});
    command->plan([o, command] { return plan(o, command); });
}

}  // namespace raycache::tools
