// raycache explain: why one trace is kinder to a GPU's caches than another.
#include <fmt/format.h>

#include "tools/commands.hpp"
#include "tools/console.hpp"
#include "tools/costs.hpp"
#include "tools/explain_job.hpp"
#include "tools/gpu_options.hpp"
#include "tools/heat_map.hpp"
#include "tools/idle_options.hpp"
#include "tools/json_output.hpp"
#include "tools/launch_source.hpp"
#include "tools/options.hpp"
#include "tools/width_option.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

struct Options {
    std::vector<std::string> traces;
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
    JsonSubject subject{{gpu}, {}};
    for (std::size_t i = 0; i < 2; ++i)
        subject.traces.push_back(settings_json(*sources[i].header, o.traces.empty() ? "" : o.traces[i]));
    deliveries.attempt([&] { print(o.json ? o.json.document(cachesim::to_json(e), subject) : cachesim::to_text(e, o.width.columns())); });
    if (request.pixels)
        write_heat_maps(
            o.heat_map,
            fmt::format("{}, N {}, {}, GPU {}", e.scene, e.spp, samples_text(e.base.launches.size()), e.gpu),
            make_heat_map(e.base.name, *sources[0].header, done.costs[0], gpu),
            make_heat_map(e.other.name, *sources[1].header, done.costs[1], gpu), deliveries);
    deliveries.finish();
}

void explain_scene(const Options& o, const CLI::App& command, const cachesim::Gpu& gpu, Progress& progress) {
    std::vector<tracer::CaptureSettings> settings;
    for (const std::string& strategy : o.strategies)
        settings.push_back(o.sampling.capture(o.scene, o.sequence, strategy, o.spp));
    warn_of_settings(command, settings);
    double seconds = 0;
    for (const auto& s : settings) seconds += trace_cost(s) + explain_cost(s, gpu.timing && !o.counts_only);
    progress.expect("explain", Work::replay, seconds);
    const auto scene = o.scene.prepare(heat_map_files(o.heat_map), progress);
    std::vector<std::unique_ptr<tracer::Capture>> captures;
    for (const auto& s : settings) captures.push_back(std::make_unique<tracer::Capture>(*scene, s));
    explain_and_print(o, gpu, sources_of(captures), o.strategies, progress);
}

void run(const Options& o, const CLI::App& command) {
    if (o.traces.empty() == o.scene.source.empty())
        throw UsageError("nothing to explain; expected either two trace files or --scene, not both");
    if (o.scene.source.empty() && o.traces.size() != 2)
        throw UsageError(fmt::format("{} trace files; expected two: BASE and OTHER", o.traces.size()));
    if (o.traces.empty() && o.strategies.size() != 2)
        throw UsageError(fmt::format("--strategy with {} names; expected two: BASE,OTHER", o.strategies.size()));
    if (!o.traces.empty())
        for (const std::string& line : idle_on_traces(command)) warn(line);
    if (!o.heat_map.empty()) check_heat_map_name(o.heat_map);
    const FileNames outputs = heat_map_files(o.heat_map);
    const auto gpus = o.gpu.load(outputs);
    const cachesim::Gpu& gpu = gpus.front();
    if (gpu.timing && !o.counts_only) o.gpu.check_timed(gpus);
    refuse_overwriting(o.traces, outputs);
    check_outputs(outputs);
    const auto limit = o.threads.apply();
    Progress progress("explain");
    if (o.traces.empty()) return explain_scene(o, command, gpu, progress);
    const TraceFiles files(o.traces);
    explain_and_print(o, gpu, files.sources, o.traces, progress);
}

}  // namespace

void add_explain(CLI::App& app) {
    auto o = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "explain", "Explain why one trace causes more cache traffic than another, factor by factor and miss by miss");
    command->add_option("TRACES", o->traces, "two trace files: BASE and OTHER");
    command->add_option("--gpu", o->gpu.names, "GPU preset or FILE.toml (see 'raycache list gpus')")
        ->required()
        ->expected(1);
    o->gpu.add_changes(*command);
    command
        ->add_option("--by", o->by,
                     "the factors also for each: none, bounce (path vertex), ray (camera, bounce, shadow)")
        ->check(CLI::IsMember({"none", "bounce", "ray"}))
        ->capture_default_str();
    o->json.add(*command);
    o->width.add(*command);
    command->add_flag("--counts-only", o->counts_only, "no predicted times: several times as fast");
    command->add_option("--heatmap", o->heat_map,
                        "FILE.exr: DRAM bytes, L1 visit miss rate and active lanes of each pixel; FILE.png shows them");
    o->scene.add(*command, false);
    command->add_option("--strategy", o->strategies, "with --scene: two decorrelations, BASE,OTHER")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    command->add_option("--sequence", o->sequence, "with --scene: the sequence of both")->capture_default_str();
    command->add_option("--spp", o->spp, "with --scene: size N of the sample set")->capture_default_str();
    o->sampling.add_launches(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    o->threads.add(*command);
    command->footer(
        "Examples:\n"
        "  raycache explain cp.rct mj.rct --gpu gtx-980-ti\n"
        "  raycache explain cp.rct mj.rct --gpu gtx-980-ti --by bounce --heatmap why.exr\n"
        "  raycache explain --scene courtyard --strategy cranley-patterson,coherent --spp 64 --gpu h100");
    command->callback([o, command] { run(*o, *command); });
}

}  // namespace raycache::tools
