// raycache measure: how long Embree takes on this processor for the rays of several strategies.
#include <fmt/format.h>

#include <ctime>

#include "tools/jobs/cpu_preset.hpp"
#include "tools/jobs/measure_report.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "tools/program/table_output.hpp"
#include "tracer/strategy_groups.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

/// Embree has a BVH of its own.
constexpr tracer::StrategyParts measure_parts{.order = false, .layout = false};

struct MeasureArguments {
    SceneOptions scene;
    std::vector<std::string> strategies{"coherent", "cranley-patterson", "micro-jitter"};
    std::vector<std::string> sequences{"sobol"};
    std::vector<std::uint64_t> spp{64};
    SamplingOptions sampling;
    std::string baseline = "cranley-patterson", by = "none";
    std::vector<std::string> modes;
    std::uint32_t repeats = 3;
    bool no_shuffled = false;
    TableOutput table;
    bool preset = false;
    std::string output;
    ThreadOptions threads;
};

RayGroups parse_groups(const std::string& text) {
    if (text == "ray") return RayGroups::ray;
    if (text == "bounce") return RayGroups::bounce;
    return text == "both" ? RayGroups::both : RayGroups::none;
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm date{};
    gmtime_r(&now, &date);
    return fmt::format("{:04}-{:02}-{:02}", date.tm_year + 1900, date.tm_mon + 1, date.tm_mday);
}

/// The file of this processor instead of a measurement of strategies.
Action plan_preset(const std::shared_ptr<MeasureArguments>& o, const Command* command) {
    if (!o->scene.source.empty())
        throw UsageError(fmt::format("--preset beside the scene '{}'; expected --preset alone", o->scene.source));
    if (o->table.json || o->table.csv)
        throw UsageError("--preset with --json or --csv; expected neither: it writes a GPU file");
    return [o, command] {
        for (const std::string& line : idle_besides(*command, {"--preset", "--output", "--threads"},
                                                    "--preset measures the processor, not strategies"))
            warn(line);
        check_outputs({o->output}, warn);
        const auto limit = o->threads.apply();
        const tracer::EmbreeFacts embree = tracer::embree_facts();
        const CpuTopology topology = cpu_topology();
        Progress progress("measure");
        const std::string text = cpu_preset(this_machine(), topology, measure_cpu(topology, progress),
                                            embree.widths.empty() ? 1 : embree.widths.back(), today());
        if (o->output.empty())
            print(text);
        else
            write_text(o->output, text);
    };
}

Action plan(const std::shared_ptr<MeasureArguments>& o, const Command* command) {
    if (o->preset) return plan_preset(o, command);
    if (o->scene.source.empty()) throw UsageError("SCENE is missing; see 'raycache measure --help'");
    o->table.check();
    if (!o->output.empty()) throw UsageError("--output without --preset; expected both");
    MeasureJob job;
    job.scene = o->scene;
    job.sampling = o->sampling;
    for (const std::string& sequence : o->sequences)
        for (const std::uint64_t spp : o->spp)
            for (const std::string& strategy : tracer::expand_groups(o->strategies))
                job.cases.push_back({tracer::parse_strategy_name(strategy, measure_parts), sequence, spp, {}, {}});
    job.baseline = o->baseline;
    job.modes = o->modes;
    job.shuffled = !o->no_shuffled;
    job.by = parse_groups(o->by);
    job.repeats = o->repeats;
    job.check();
    return [o, command, job] {
        warn_of_idle(*command, capture_settings(job.scene, job.sampling, job.cases));
        check_outputs({}, warn);
        const auto limit = o->threads.apply();
        Progress progress("measure");
        const MeasureReport report = make_measure_report(run(job, progress));
        for (const std::string& line : report.warnings) progress.warn(line);
        o->table.publish(report, report.result.subject);
    };
}

std::vector<std::string> mode_names() {
    std::vector<std::string> names;
    for (const tracer::WalkMode& mode : tracer::walk_modes()) names.push_back(mode.name);
    return names;
}

}  // namespace

void add_measure(Program& program) {
    auto o = std::make_shared<MeasureArguments>();
    Command* command = program.add_subcommand(
        "measure", "Measure on this processor: how long Embree takes for the rays of several strategies");
    o->scene.add_name(*command);
    command->find_option("SCENE")->required(false);
    add_strategies(*command, o->strategies, measure_parts);
    add_sequences(*command, o->sequences);
    add_spps(*command, o->spp, "sizes N of the sample set, separated by commas");
    o->threads.add(*command);
    command->group("Measurement");
    command
        ->add_option("--modes", o->modes,
                     "how Embree walks: single (rtcIntersect1), packet4, packet8, packet16, each packet also with "
                     "-coherent, the flag. Default: single, and the widest packets of this processor, both ways")
        ->choices("mode", mode_names());
    command->add_option("--repeats", o->repeats, "walks of each sample index; their median counts")
        ->range(std::uint64_t{1}, std::uint64_t{1000});
    command->add_flag("--no-shuffled", o->no_shuffled, "not also the same rays in shuffled order");
    command
        ->add_option("--by", o->by,
                     "also a row per: ray (camera, bounce, shadow), bounce (path vertex), both; each walked by itself")
        ->choices("grouping", {"none", "ray", "bounce", "both"})
        ->type_name("WHAT");
    command->add_option("--baseline", o->baseline, "strategy that speed-ups refer to, one of --strategy")
        ->check(strategy_name_check(measure_parts));
    command->add_flag("--preset", o->preset,
                      "instead: measure the caches of this processor and print it as a GPU file, for --gpu FILE.toml");
    command->add_option("-o,--output", o->output, "with --preset: the file")->type_name("FILE.toml");
    o->table.add(*command);
    command->group("");
    o->scene.add_view(*command);
    command->remove_option("--layout");
    o->sampling.add_launches(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    command->examples(
        {"raycache measure courtyard --strategy coherent,cranley-patterson,micro-jitter --spp 64,1024 --k 1",
         "raycache measure sponza.glb --resolution 256x256 --trace-samples 4 --modes single,packet8-coherent --by both",
         "raycache measure sponza.glb --strategy cranley-patterson,micro-jitter --repeats 5 --no-shuffled --json",
         "raycache measure --preset -o this-cpu.toml"});
    command->plan([o, command] { return plan(o, command); });
}

}  // namespace raycache::tools
