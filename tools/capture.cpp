// raycache capture: scene -> trace file.
#include <fmt/format.h>

#include "tools/commands.hpp"
#include "tools/console.hpp"
#include "tools/costs.hpp"
#include "tools/idle_options.hpp"
#include "tools/interruption.hpp"
#include "tools/options.hpp"
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

void run(const Options& o, const CLI::App& command) {
    const tracer::CaptureSettings settings = o.sampling.capture(o.scene, o.sequence, o.decorrelation, o.spp);
    warn_of_settings(command, {&settings, 1});
    check_outputs({o.output});
    advise_if_interrupted("a capture cannot go on where it ended: run the same command again");
    const auto limit = o.threads.apply();
    Progress progress("capture");
    progress.expect("trace", Work::trace, trace_cost(settings));
    const auto scene = o.scene.prepare({o.output}, progress);
    const tracer::Capture capture(*scene, settings);
    const auto stage = progress.begin(
        "trace", std::uint64_t{capture.header().warps_per_launch} * capture.header().launches.size(), "rays");
    tracer::write_capture(capture, o.output, [&](std::uint64_t warps, std::uint64_t rays) { stage.add(warps, rays); });
}

}  // namespace

void add_capture(CLI::App& app) {
    auto o = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("capture", "Trace a scene in warps and write every access to a trace file");
    o->scene.add(*command, true);
    command->add_option("-o,--output", o->output, "trace to write (.rct), or - for stdout")->required();
    command->add_option("--strategy", o->decorrelation, "decorrelation (see 'raycache list strategies')")
        ->capture_default_str();
    command->add_option("--sequence", o->sequence, "sequence (see 'raycache list sequences')")->capture_default_str();
    command->add_option("--spp", o->spp, "N, the size of the sample set; it sets mu")->capture_default_str();
    o->sampling.add_launches(*command);
    o->sampling.add_execution(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    o->threads.add(*command);
    command->footer(
        "Examples:\n"
        "  raycache capture courtyard --strategy micro-jitter --spp 1024 -o mj.rct\n"
        "  raycache capture sponza.glb --strategy cranley-patterson --sequence halton --spp 1024 --trace-samples 4 -o "
        "cp.rct\n"
        "  raycache capture courtyard --strategy cranley-patterson --execution wavefront --order meister -o wave.rct");
    command->callback([o, command] { run(*o, *command); });
}

}  // namespace raycache::tools
