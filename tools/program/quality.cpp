// raycache quality: how good the pictures of sampling strategies are.
#include <fmt/format.h>

#include "tools/jobs/quality_pictures.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/estimate_options.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/program.hpp"
#include "tools/program/quality_options.hpp"
#include "tracer/drawing.hpp"
#include "tracer/strategy_groups.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

constexpr tracer::StrategyParts quality_parts{.order = false, .layout = false};

struct QualityArguments {
    QualityOptions common;
    EstimateOptions estimate;
    std::vector<std::string> strategies{"coherent", "cranley-patterson", "micro-jitter", "random"};
    std::vector<std::string> sequences{"sobol"};
    std::vector<std::uint64_t> spp{64};
    bool pairs = false;
    std::string output, crop;
};

Action plan(const std::shared_ptr<const QualityArguments>& o, const Command* command) {
    QualityJob job = o->common.job();
    for (const std::string& sequence : o->sequences)
        for (const std::uint64_t spp : o->spp)
            for (const std::string& strategy : tracer::expand_groups(o->strategies))
                job.cases.push_back({tracer::parse_strategy_name(strategy, quality_parts), sequence, spp, {}, {}});
    job.baseline = o->common.baseline_of(o->strategies);
    if (const auto of_group = tracer::baseline_of_groups(o->strategies); job.baseline.empty() && of_group)
        job.baseline = tracer::parse_strategy_name(*of_group).decorrelation;
    for (const char* option : {"--target-error", "--time-budget", "--windows"})
        if (command->find_option(option)->given()) {
            LaunchSettings launches{{}, job.scene, job.sampling, job.cases};
            std::string why_exact;  // never: these are megakernels alone
            job.estimate = o->estimate.settings(*command, launches, why_exact);
        }
    job.pairs = o->pairs;
    job.equal_time = !o->output.empty() && !o->common.gpu.names.empty();
    const auto captures = capture_settings(job.scene, job.sampling, job.cases);
    std::optional<Crop> crop;
    if (!o->crop.empty()) {
        if (o->output.empty()) throw UsageError("--crop without --output; expected both");
        crop = parse_crop(o->crop, captures.front().width, captures.front().height);
    }
    job.request();  // checked
    return [o, command, job, captures, crop] {
        FileNames pictures;
        if (!o->output.empty()) {
            check_picture_folder(o->output);
            tracer::check_drawing();
            pictures = quality_picture_names(o->output, captures);
        }
        Deliveries deliveries;
        Progress progress("quality");
        const QualityResult result = o->common.measure(*command, job, pictures, deliveries, progress);
        const QualityReport& report = result.report;
        deliveries.attempt([&] {
            print(o->common.json  ? o->common.json.document(to_json(report), report.subject)
                  : o->common.csv ? to_csv(report)
                                  : to_text(report, o->common.width.columns()));
        });
        if (!o->output.empty()) write_quality_pictures(o->output, report, result.pictures, crop, deliveries);
        deliveries.finish(say_failure);
    };
}

}  // namespace

void add_quality(Program& program) {
    auto o = std::make_shared<QualityArguments>();
    Command* command = program.add_subcommand(
        "quality", "Measure the error of strategies' pictures: its size, how much of it neighbours share, and bias");
    add_strategies(*command, o->strategies, quality_parts);
    add_sequences(*command, o->sequences);
    add_spps(*command, o->spp, "samples per pixel N, separated by commas");
    command->add_flag("--pairs", o->pairs,
                      "find the pair of sample dimensions that causes most shared error: one more picture per pair");
    command
        ->add_option("-o,--output", o->output,
                     "folder for pictures: index.png shows all, with --gpu also at equal predicted time")
        ->type_name("DIR");
    command->add_option("--crop", o->crop, "the part that index.png shows; default: where blocks err most")
        ->type_name("X,Y,SIDE");
    o->common.add(*command, false);
    o->estimate.add(*command, "with --gpu: of every predicted speed-up; times are then of the steady state");
    command->examples(
        {"raycache quality courtyard --strategy coherent,cranley-patterson,micro-jitter --spp 64",
         "raycache quality cornell_box.glb --resolution 256x256 --spp 16,64,256 --reference-spp 4096 --csv",
         "raycache quality sponza.glb --spp 64 --gpu gtx-980-ti --output pictures",
         "raycache quality cornell_box.glb --resolution 64x64 --repeats 4 --strategy "
         "cranley-patterson,owen,blue-noise,micro-jitter,net-micro-jitter --spp 16,64,256 --gpu rtx-3070 "
         "--time-resolution 512x512 --windows 64 --json > quality.json && tools/plot_quality quality.json -o "
         "quality.png",
         "raycache quality cornell_box.glb --strategy cranley-patterson,micro-jitter --repeats 8 --pairs"});
    command->plan([o, command] { return plan(o, command); });
}

}  // namespace raycache::tools
