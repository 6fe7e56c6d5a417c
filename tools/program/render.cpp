// raycache render: a picture of a scene, to see that it is what one thinks it is.
#include <fmt/format.h>

#include "tools/jobs/render_job.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/options.hpp"
#include "tools/program/program.hpp"
#include "tracer/image.hpp"

namespace raycache::tools {
namespace {

struct RenderArguments {
    SceneOptions scene;
    SamplingOptions sampling;
    ThreadOptions threads;
    std::string sequence = "sobol", strategy = "cranley-patterson", output;
    std::uint64_t spp = 64;
    std::optional<float> exposure, clamp;
};

Action plan(const std::shared_ptr<const RenderArguments>& o, const Command* command) {
    const RenderJob job{o->scene,    o->sampling, {{o->strategy}, o->sequence, o->spp, {}, {}},
                        o->exposure, o->clamp,    o->output};
    const tracer::CaptureSettings settings = job.capture();
    return [o, command, job, settings] {
        warn_of_idle(*command, {&settings, 1}, {false, "a picture is rendered without the BVH and warps of a trace"});
        if (o->exposure && !tracer::is_tone_mapped(o->output))
            warn(fmt::format("--exposure has no effect: {} holds linear values", o->output));
        const auto limit = o->threads.apply();
        Progress progress("render");
        run(job, progress);
    };
}

}  // namespace

void add_render(Program& program) {
    auto o = std::make_shared<RenderArguments>();
    Command* command = program.add_subcommand("render", "Render a picture of a scene (PNG, JPEG, EXR, HDR)");
    o->scene.add_name(*command);
    command->add_option("-o,--output", o->output, "picture to write: .png .jpg (tone mapped), .exr .hdr (linear)")
        ->required()
        ->type_name("FILE");
    command->add_option("--strategy", o->strategy, "decorrelation (see 'raycache list strategies')")
        ->choices("strategy", strategy_names());
    command->add_option("--sequence", o->sequence, "sequence (see 'raycache list sequences')")
        ->choices("sequence", sequence_names());
    add_spp(*command, o->spp, "samples per pixel");
    command->add_option("--exposure", o->exposure, "stops; default: chosen from the picture's log-average luminance");
    command->add_option("--clamp", o->clamp, "radiance that no channel of a sample exceeds; default: none");
    o->threads.add(*command);
    o->scene.add_view(*command);
    o->sampling.add_picture(*command);
    o->sampling.add_strategy(*command);
    command->examples({"raycache render courtyard --spp 16 -o courtyard.png",
                       "raycache render sponza.glb --camera gallery --resolution 1280x720 --spp 256 -o sponza.exr"});
    command->plan([o, command] { return plan(o, command); });
}

}  // namespace raycache::tools
