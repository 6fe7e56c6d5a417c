// raycache capture: scene -> trace file, package for GPUs.
#include "tools/jobs/capture_job.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

struct Options {
    SceneOptions scene;
    SamplingOptions sampling;
    ThreadOptions threads;
    std::string sequence = "sobol", strategy = "micro-jitter", output, gpu_package;
    std::uint64_t spp = 64;
};

Action plan(const std::shared_ptr<const Options>& o, const Command* command) {
    const CaptureJob job{o->scene,
                         o->sampling,
                         {tracer::parse_strategy_name(o->strategy), o->sequence, o->spp, {}, {}},
                         o->output,
                         o->gpu_package};
    if (job.output.empty() && job.gpu_package.empty())
        throw UsageError("a capture without an output; expected -o FILE.rct, --gpu-package DIR, or both");
    const tracer::CaptureSettings settings = capture_settings(job.scene, job.sampling, job.strategy);
    return [o, command, job, settings] {
        warn_of_idle(*command, {&settings, 1});
        const auto limit = o->threads.apply();
        Progress progress("capture");
        run(job, progress);
    };
}

}  // namespace

void add_capture(Program& program) {
    auto o = std::make_shared<Options>();
    Command* command = program.add_subcommand(
        "capture", "Trace a scene in warps and write every access to a trace file, or its rays to a package for GPUs");
    o->scene.add_name(*command);
    command->add_option("-o,--output", o->output, "trace to write, or - for stdout")->type_name("FILE.rct");
    command
        ->add_option("--gpu-package", o->gpu_package,
                     "folder for the BVH, the rays and where each of them ends, which tools/gpu/ walks on a GPU "
                     "(docs/gpu_package.md)")
        ->type_name("DIR");
    command
        ->add_option(
            "--strategy", o->strategy,
            "decorrelation (see 'raycache list strategies'); NAME+wavefront or NAME+ORDER runs it as a wavefront, "
            "NAME@MAP with that thread map")
        ->check(strategy_name_check());
    command->add_option("--sequence", o->sequence, "sequence (see 'raycache list sequences')")
        ->choices("sequence", sequence_names());
    add_spp(*command, o->spp, "N, the size of the sample set; it sets mu");
    o->threads.add(*command);
    o->scene.add_view(*command);
    o->sampling.add_launches(*command);
    o->sampling.add_execution(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    command->examples(
        {"raycache capture courtyard --strategy micro-jitter --spp 1024 -o mj.rct",
         "raycache capture sponza.glb --strategy cranley-patterson --sequence halton --spp 1024 "
         "--trace-samples 4 -o cp.rct",
         "raycache capture courtyard --strategy cranley-patterson --execution wavefront --order meister "
         "-o wave.rct",
         "raycache capture courtyard --strategy micro-jitter --k 1 --layout cwbvh8 --gpu-package mj-gpu"});
    command->plan([o, command] { return plan(o, command); });
}

}  // namespace raycache::tools
