// raycache explain: why one trace is kinder to a GPU's caches than another.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/jobs/costs.hpp"
#include "tools/jobs/explain_job.hpp"
#include "tools/jobs/heat_map.hpp"
#include "tools/jobs/launch_source.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/gpu_options.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/inputs.hpp"
#include "tools/program/json_output.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "tools/program/width_option.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

struct Options {
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
    bool counts_only = false;
    ThreadOptions threads;
};

std::string samples_text(std::size_t count) {
    return count == 1 ? "1 sample index" : fmt::format("{} sample indices", count);
}

void explain_and_print(const Options& o, const cachesim::Gpu& gpu, const std::vector<LaunchSource>& sources,
                       const std::vector<std::string>& names, Progress& progress) {
    for (std::size_t i = 0; i < 2; ++i) refuse_wavefront(*sources[i].header, names[i], "explain");
    ExplainRequest request;
    request.sources = {&sources[0], &sources[1]};
    request.names = {names[0], names[1]};
    request.gpu = gpu;
    request.by = o.by == "bounce" ? cachesim::GroupBy::bounce
                 : o.by == "ray"  ? cachesim::GroupBy::ray
                                  : cachesim::GroupBy::none;
    request.timed = !o.counts_only;
    request.pixels = !o.heat_map.empty();
    const Explained done = explain(request, progress);
    const cachesim::Explanation& e = done.explanation;
    Deliveries deliveries;
    Subject subject{{gpu_json(gpu)}, {}};
    for (std::size_t i = 0; i < 2; ++i)
        subject.traces.push_back(trace_json(*sources[i].header, o.scene.source.empty() ? names[i] : ""));
    deliveries.attempt([&] {
        print(o.json ? o.json.document(cachesim::to_json(e), subject) : cachesim::to_text(e, o.width.columns()));
    });
    if (request.pixels)
        write_heat_maps(
            o.heat_map,
            fmt::format("{}, N {}, {}, GPU {}", e.scene, e.spp, samples_text(e.base.launches.size()), e.gpu),
            make_heat_map(e.base.name, *sources[0].header, done.costs[0], gpu),
            make_heat_map(e.other.name, *sources[1].header, done.costs[1], gpu), deliveries);
    deliveries.finish(say_failure);
}

Action plan_scene(const std::shared_ptr<const Options>& o, const Command* command, const cachesim::Gpu& gpu) {
    if (o->strategies.size() != 2)
        throw UsageError(fmt::format("--strategy '{}': expected two names, BASE,OTHER, found {}",
                                     fmt::join(o->strategies, ","), o->strategies.size()));
    std::vector<tracer::CaptureSettings> settings;
    for (const std::string& strategy : o->strategies)
        settings.push_back(o->sampling.capture(o->scene, o->sequence, strategy, o->spp));
    return [o, command, gpu, settings] {
        warn_of_settings(*command, settings);
        check_outputs(heat_map_files(o->heat_map), warn);
        const auto limit = o->threads.apply();
        Progress progress("explain");
        double seconds = 0;
        for (const auto& s : settings) seconds += trace_cost(s) + explain_cost(s, gpu.timing && !o->counts_only);
        progress.expect("explain", Work::replay, seconds);
        const auto scene = o->scene.prepare(heat_map_files(o->heat_map), progress);
        std::vector<std::unique_ptr<tracer::Capture>> captures;
        for (const auto& s : settings) captures.push_back(std::make_unique<tracer::Capture>(*scene, s));
        explain_and_print(*o, gpu, sources_of(captures), o->strategies, progress);
    };
}

Action plan_traces(const std::shared_ptr<const Options>& o, const Command* command, const cachesim::Gpu& gpu,
                   const std::vector<std::string>& traces) {
    if (traces.size() != 2)
        throw UsageError(
            fmt::format("{} trace file{}; expected two: BASE and OTHER", traces.size(), traces.size() == 1 ? "" : "s"));
    refuse_overwriting(traces, heat_map_files(o->heat_map));
    return [o, command, gpu, traces] {
        for (const std::string& line : idle_on_traces(*command)) warn(line);
        check_outputs(heat_map_files(o->heat_map), warn);
        const auto limit = o->threads.apply();
        Progress progress("explain");
        const TraceFiles files(traces);
        explain_and_print(*o, gpu, files.sources, traces, progress);
    };
}

Action plan(const std::shared_ptr<Options>& o, const Command& command) {
    const Inputs inputs = o->inputs.sorted(command);
    o->scene.source = inputs.scene;
    if (!o->heat_map.empty()) check_heat_map_name(o->heat_map);
    const cachesim::Gpu gpu = o->gpu.load_one(heat_map_files(o->heat_map), "explain");
    if (gpu.timing && !o->counts_only) o->gpu.check_timed({gpu});
    return inputs.scene.empty() ? plan_traces(o, &command, gpu, inputs.traces) : plan_scene(o, &command, gpu);
}

}  // namespace

void add_explain(Program& program) {
    auto o = std::make_shared<Options>();
    Command* command = program.add_subcommand(
        "explain",
        "Explain why one strategy causes more cache traffic than another, factor by factor and miss by miss");
    o->inputs.add(*command, "two trace files: BASE and OTHER");
    o->gpu.add_names(*command, "GPU preset or FILE.toml (see 'raycache list gpus')")->required()->count(1);
    o->gpu.add_changes(*command);
    add_strategies(*command, o->strategies, false)->type_name("BASE,OTHER");
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
                     "DRAM bytes, L1 visit miss rate and active lanes of each pixel; FILE.png shows them")
        ->type_name("FILE.exr");
    o->threads.add(*command);
    o->scene.add_view(*command);
    o->sampling.add_launches(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    command->examples({"raycache explain courtyard --strategy cranley-patterson,coherent --spp 64 --gpu h100",
                       "raycache explain cp.rct mj.rct --gpu gtx-980-ti",
                       "raycache explain cp.rct mj.rct --gpu gtx-980-ti --by bounce --heatmap why.exr"});
    command->plan([o, command] { return plan(o, *command); });
}

}  // namespace raycache::tools
