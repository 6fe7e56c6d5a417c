// raycache explain: why one trace is kinder to a GPU's caches than another.
#include <fmt/format.h>

#include "tools/jobs/explain_job.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/equivalent_option.hpp"
#include "tools/program/estimate_options.hpp"
#include "tools/program/gpu_options.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/inputs.hpp"
#include "tools/program/json_output.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "tools/program/width_option.hpp"
#include "tracer/drawing.hpp"
#include "tracer/strategy_groups.hpp"

namespace raycache::tools {
namespace {

constexpr tracer::StrategyParts parts{.order = false};

struct ExplainArguments {
    InputOptions inputs;
    SceneOptions scene;
    std::vector<std::string> strategies{"cranley-patterson", "micro-jitter"};
    std::string sequence = "sobol";
    std::uint64_t spp = 64;
    SamplingOptions sampling;
    GpuOptions gpu;
    std::string by = "none", heat_map;
    JsonOption json;
    WidthOption width;
    bool counts_only = false, equivalent = false;
    EstimateOptions estimate;
    ThreadOptions threads;
};

std::string samples_text(std::size_t count) {
    return count == 1 ? "1 sample index" : fmt::format("{} sample indices", count);
}

void publish(const ExplainArguments& o, const ExplainResult& result) {
    const cachesim::Explanation& e = result.explanation;
    Deliveries deliveries;
    deliveries.attempt([&] {
        print(o.json ? o.json.document(cachesim::to_json(e), result.subject) : cachesim::to_text(e, o.width.columns()));
    });
    if (!result.maps.empty())
        write_heat_maps(
            o.heat_map,
            fmt::format("{}, N {}, {}, GPU {}", e.scene, e.spp, samples_text(e.base.launches.size()), e.gpu),
            result.maps[0], result.maps[1], deliveries);
    deliveries.finish(say_failure);
}

Action plan(const std::shared_ptr<ExplainArguments>& o, const Command* command) {
    const Inputs inputs = o->inputs.sorted(*command);
    o->scene.source = inputs.scene;
    if (!o->heat_map.empty()) check_heat_map_name(o->heat_map);
    const FileNames outputs = heat_map_files(o->heat_map);
    ExplainJob job;
    job.gpu = o->gpu;
    job.by = o->by == "bounce" ? cachesim::GroupBy::bounce
             : o->by == "ray"  ? cachesim::GroupBy::ray
                               : cachesim::GroupBy::none;
    job.timed = !o->counts_only;
    job.pixels = !o->heat_map.empty();
    const cachesim::Gpu gpu = o->gpu.load_one(outputs, "explain");
    if (gpu.timing && job.timed) o->gpu.check_timed({gpu});
    job.launches.traces = inputs.traces;
    if (!job.launches.of_traces()) {
        job.launches.scene = o->scene;
        job.launches.sampling = o->sampling;
        for (const std::string& strategy : tracer::expand_groups(o->strategies))
            job.launches.cases.push_back({tracer::parse_strategy_name(strategy, parts), o->sequence, o->spp, {}, {}});
    }
    std::string why_exact;
    job.estimate = o->estimate.settings(*command, job.launches, why_exact);
    job.check();
    if (o->equivalent) check_whole_launches(job.estimate);
    refuse_overwriting(inputs.traces, outputs);
    return [o, command, job, gpu, outputs, why_exact] {
        if (job.launches.of_traces())
            for (const std::string& line : idle_on_traces(*command)) warn(line);
        else
            warn_of_idle(*command, job.launches.captures());
        check_outputs(outputs, warn);
        if (!why_exact.empty()) warn(why_exact);
        if (job.pixels) tracer::check_drawing();
        const auto limit = o->threads.apply();
        Progress progress("explain");
        std::vector<std::string> equivalents;
        if (o->equivalent) equivalents = cache_equivalents(job.launches, {gpu}, std::nullopt, progress);
        ExplainResult result = run(job, gpu, progress, outputs);
        result.explanation.cache_equivalents = std::move(equivalents);
        publish(*o, result);
    };
}

}  // namespace

void add_explain(Program& program) {
    auto o = std::make_shared<ExplainArguments>();
    Command* command = program.add_subcommand(
        "explain",
        "Explain why one strategy causes more cache traffic than another, factor by factor and miss by miss");
    o->inputs.add(*command, "two trace files: BASE and OTHER");
    o->gpu.add_names(*command, "GPU preset or FILE.toml (see 'raycache list gpus')")->required()->count(1);
    o->gpu.add_changes(*command);
    add_strategies(*command, o->strategies, parts)->type_name("BASE,OTHER");
    command->add_option("--sequence", o->sequence, "with a scene: the sequence of both")
        ->choices("sequence", sequence_names())
        ->about_scene();
    add_spp(*command, o->spp, "with a scene: size N of the sample set")->about_scene();
    command
        ->add_option("--by", o->by,
                     "the factors also for each: none, bounce (path vertex), ray (camera, bounce, shadow)")
        ->choices("grouping", {"none", "bounce", "ray"})
        ->type_name("WHAT");
    o->json.add(*command);
    o->width.add(*command);
    command->add_flag("--counts-only", o->counts_only, "no predicted times: several times as fast");
    command
        ->add_option("--heatmap", o->heat_map,
                     "DRAM bytes, L1 visit miss rate and active lanes of each pixel; FILE.png shows them. Takes whole "
                     "launches, as --exact")
        ->type_name("FILE.exr")
        ->excludes({"--windows", "--target-error", "--time-budget"});
    o->threads.add(*command);
    add_cache_equivalent(*command, o->equivalent, {});
    o->estimate.add(*command, "of the predicted speed-up, with --counts-only of bytes");
    o->scene.add_view(*command);
    o->sampling.add_launches(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    command->examples({"raycache explain courtyard --strategy cranley-patterson,coherent --spp 64 --gpu h100",
                       "raycache explain cp.rct mj.rct --gpu gtx-980-ti",
                       "raycache explain cp.rct mj.rct --gpu gtx-980-ti --by bounce --heatmap why.exr"});
    command->plan([o, command] { return plan(o, command); });
}

}  // namespace raycache::tools
