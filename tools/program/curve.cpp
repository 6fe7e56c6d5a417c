// raycache curve: hit rates and traffic by size of a cache, and which size another strategy would need.
#include <fmt/format.h>

#include "tools/jobs/baseline.hpp"
#include "tools/jobs/curve_job.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/gpu_options.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/inputs.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "tools/program/table_output.hpp"
#include "tracer/strategy_groups.hpp"

namespace raycache::tools {
namespace {

constexpr tracer::StrategyParts curve_parts{.order = false};

struct CurveArguments {
    InputOptions inputs;
    SceneOptions scene;
    std::vector<std::string> strategies{"cranley-patterson", "micro-jitter"};
    std::string sequence = "sobol", baseline;
    std::vector<std::uint64_t> spp{64};
    SamplingOptions sampling;
    GpuOptions gpu;
    std::string level = "all";
    std::vector<std::uint64_t> sets;
    std::vector<std::string> sizes, policies;
    TableOutput output;
    double rate = 1;
    ThreadOptions threads;
};

void publish(const CurveArguments& o, CurveResult result, const std::vector<std::uint64_t>& sizes) {
    const std::string baseline = baseline_strategy(result.series, o.baseline);
    const cachesim::CurveReport report = cachesim::make_curve_report(std::move(result.series), baseline, sizes);
    o.output.publish(report, result.subject);
}

Action plan(const std::shared_ptr<CurveArguments>& o, const Command* command) {
    const Inputs inputs = o->inputs.sorted(*command);
    o->scene.source = inputs.scene;
    o->output.check();
    CurveJob job;
    job.gpu = o->gpu;
    job.sets = o->sets;
    job.policies = o->policies;
    job.rate = o->rate;
    for (const std::string& size : o->sizes) job.sizes.push_back(read_size(size, "--sizes"));
    if (o->level != "all") job.levels = {static_cast<std::size_t>(o->level[1] - '1')};
    job.launches.traces = inputs.traces;
    if (!job.launches.of_traces()) {
        job.launches.scene = o->scene;
        job.launches.sampling = o->sampling;
        for (const std::uint64_t spp : o->spp)
            for (const std::string& strategy : tracer::expand_groups(o->strategies))
                job.launches.cases.push_back(
                    {tracer::parse_strategy_name(strategy, curve_parts), o->sequence, spp, {}, {}});
    }
    const cachesim::Gpu gpu = o->gpu.load_one({}, "curve");
    job.check(gpu);
    return [o, command, job, gpu] {
        if (job.launches.of_traces())
            for (const std::string& line : idle_on_traces(*command)) warn(line);
        else
            warn_of_idle(*command, job.launches.captures());
        check_outputs({}, warn);
        const auto limit = o->threads.apply();
        Progress progress("curve");
        publish(*o, run(job, gpu, progress), job.sizes);
    };
}

}  // namespace

void add_curve(Program& program) {
    auto o = std::make_shared<CurveArguments>();
    Command* command = program.add_subcommand(
        "curve", "Hit rates and traffic by size of a cache, and the size that another strategy would need");
    o->inputs.add(*command, "trace files");
    o->gpu.add_names(*command, "GPU preset or FILE.toml (see 'raycache list gpus')")->required()->count(1);
    o->gpu.add_changes(*command);
    add_strategies(*command, o->strategies, curve_parts);
    command->add_option("--sequence", o->sequence, "with a scene: the sequence of all")
        ->choices("sequence", sequence_names())
        ->about_scene();
    add_spps(*command, o->spp, "with a scene: sizes N of the sample set, separated by commas");
    o->threads.add(*command);
    command->group("Curve");
    command
        ->add_option("--level", o->level,
                     "caches of which level: l1, l2 or l3, each behind the GPU's own caches above it, or all")
        ->choices("level", {"all", "l1", "l2", "l3"});
    command
        ->add_option("--sizes", o->sizes,
                     "sizes of the table, each a whole number of ways; a number of bytes, or with a unit: 96KiB. "
                     "Default: the GPU's own size and others by factors of two")
        ->type_name("SIZE,...")
        ->check([](std::string& size) { read_size(size, "--sizes"); });
    command
        ->add_option("--sets", o->sets,
                     "also with so many sets (of each slice), beside the GPU's own and full associativity")
        ->range(std::uint64_t{1}, std::uint64_t{1} << 20);
    command
        ->add_option("--policy", o->policies,
                     "beside lru, with the GPU's own sets at --sizes or a quarter to four times the own size; belady: "
                     "the optimum, which knows the future")
        ->choices("policy", CurveJob::policy_names());
    command
        ->add_option("--sampled", o->rate,
                     "estimates from this share of all lines, such as 0.05, for large caches (SHARDS): of full "
                     "associativity, and of at least 2048 lines")
        ->range(1e-6, 1.0)
        ->default_text("1: exact")
        ->excludes({"--sets", "--policy"});
    command
        ->add_option("--baseline", o->baseline,
                     "strategy whose equivalent sizes are found; default: cranley-patterson where it is among them")
        ->check(strategy_name_check());
    o->output.add(*command);
    command->group("");
    o->scene.add_view(*command);
    o->sampling.add_launches(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    command->examples(
        {"raycache curve courtyard --strategy cranley-patterson,micro-jitter --spp 256 --k 1 --gpu rtx-3070",
         "raycache curve cp.rct mj.rct --gpu rtx-3070 --level l1 --sizes 64KiB,96KiB,128KiB --csv",
         "raycache curve cp.rct --gpu rtx-3070 --level l1 --policy fifo,random,belady",
         "raycache curve mj.rct --gpu h100 --level l2 --l1-kib 128 --json",
         "raycache curve courtyard --gpu gtx-980-ti --level l1 --sets 1,16,64"});
    command->plan([o, command] { return plan(o, command); });
}

}  // namespace raycache::tools
