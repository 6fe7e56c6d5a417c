// raycache capture: scene -> trace file.
#include <fmt/format.h>

#include "tools/jobs/costs.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/interruption.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "tracer/capture.hpp"

namespace raycache::tools {
namespace {

struct Options {
    SceneOptions scene;
    SamplingOptions sampling;
    ThreadOptions threads;
    std::string sequence = "sobol", decorrelation = "micro-jitter", output;
    std::uint64_t spp = 64;
};

Action plan(const std::shared_ptr<const Options>& o, const Command* command) {
    const tracer::CaptureSettings settings = o->sampling.capture(o->scene, o->sequence, o->decorrelation, o->spp);
    return [o, command, settings] {
        warn_of_settings(*command, {&settings, 1});
        check_outputs({o->output}, warn);
        advise_if_interrupted("a capture cannot go on where it ended: run the same command again");
        const auto limit = o->threads.apply();
        Progress progress("capture");
        progress.expect("trace", Work::trace, trace_cost(settings));
        const auto scene = o->scene.prepare({o->output}, progress);
        const tracer::Capture capture(*scene, settings);
        const Stage stage(progress, "trace",
                          std::uint64_t{capture.header().warps_per_launch} * capture.header().launches.size(), "rays");
        tracer::write_capture(capture, o->output,
                              [&](std::uint64_t warps, std::uint64_t rays) { stage.add(warps, rays); });
    };
}

}  // namespace

void add_capture(Program& program) {
    auto o = std::make_shared<Options>();
    Command* command =
        program.add_subcommand("capture", "Trace a scene in warps and write every access to a trace file");
    o->scene.add_name(*command);
    command->add_option("-o,--output", o->output, "trace to write, or - for stdout")->required()->type_name("FILE.rct");
    command
        ->add_option(
            "--strategy", o->decorrelation,
            "decorrelation (see 'raycache list strategies'); NAME+wavefront or NAME+ORDER runs it as a wavefront")
        ->check([](std::string& name) { check_strategy_name(name, true); });
    command->add_option("--sequence", o->sequence, "sequence (see 'raycache list sequences')")
        ->choices("sequence", sequence_names());
    add_spp(*command, o->spp, "N, the size of the sample set; it sets mu");
    o->threads.add(*command);
    o->scene.add_view(*command);
    o->sampling.add_launches(*command);
    o->sampling.add_execution(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    command->examples({"raycache capture courtyard --strategy micro-jitter --spp 1024 -o mj.rct",
                       "raycache capture sponza.glb --strategy cranley-patterson --sequence halton --spp 1024 "
                       "--trace-samples 4 -o cp.rct",
                       "raycache capture courtyard --strategy cranley-patterson --execution wavefront --order meister "
                       "-o wave.rct"});
    command->plan([o, command] { return plan(o, command); });
}

}  // namespace raycache::tools
