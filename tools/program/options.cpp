#include "tools/program/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <thread>

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/pixel_place.hpp"
#include "tracer/sampling/sequence.hpp"
#include "tracer/scene/scene_name.hpp"
#include "tracer/simt/orders/ray_order.hpp"
#include "tracer/strategy_groups.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

template <class Entries>
std::vector<std::string> names_of(const Entries& entries) {
    std::vector<std::string> names;
    for (const auto& entry : entries) names.push_back(entry.name);
    return names;
}

/// Far above any scene; the scene itself says what it can be built of.
constexpr std::uint64_t most_triangles = std::uint64_t{1} << 32;
/// Of a pixel: the sampling library's own limit.
constexpr std::uint64_t most_samples = std::uint64_t{1} << 32;

}  // namespace

std::vector<std::string> strategy_names() { return names_of(tracer::decorrelations()); }
std::vector<std::string> sequence_names() { return names_of(tracer::sequences()); }

std::function<void(std::string&)> strategy_name_check(tracer::StrategyParts parts) {
    return [parts](std::string& text) { tracer::check_strategy_name(tracer::parse_strategy_name(text, parts)); };
}

Option* add_strategies(Command& command, std::vector<std::string>& strategies, tracer::StrategyParts parts) {
    std::string help = "decorrelations, separated by commas (see 'raycache list strategies')";
    if (parts.order)
        help += "; NAME+wavefront or NAME+ORDER runs one as a wavefront, without sorting or with its rays sorted so";
    if (parts.thread_map) help += "; NAME@MAP has a thread map of its own";
    if (parts.layout) help += "; NAME/LAYOUT walks a BVH in a layout of its own";
    if (parts.parameters) help += "; NAME:PARAMETER=VALUE has a parameter of its own";
    const bool groups = parts.thread_map && parts.parameters;
    if (groups) help += "; or a group of them (see 'raycache list groups')";
    return command.add_option("--strategy", strategies, help)
        ->check([one = strategy_name_check(parts), groups](std::string& text) {
            if (groups && tracer::expand_groups({text}) != std::vector{text}) return;
            one(text);
        })
        ->about_scene();
}

Option* add_sequences(Command& command, std::vector<std::string>& sequences) {
    return command
        .add_option("--sequence", sequences, "sequences, separated by commas (see 'raycache list sequences')")
        ->choices("sequence", sequence_names())
        ->about_scene();
}

Option* add_spps(Command& command, std::vector<std::uint64_t>& spp, const std::string& help) {
    return command.add_option("--spp", spp, help)->range(std::uint64_t{1}, most_samples)->about_scene();
}

Option* add_spp(Command& command, std::uint64_t& spp, const std::string& help) {
    return command.add_option("--spp", spp, help)->range(std::uint64_t{1}, most_samples);
}

Option* add_layouts(Command& command, std::vector<std::string>& layouts) {
    return command
        .add_option(
            "--layout", layouts,
            "how the BVH lies in memory (see 'raycache list layouts'); several, separated by commas, make a row "
            "of each strategy each")
        ->choices("layout", names_of(tracer::bvh_layouts()));
}

void SceneOptions::add_name(Command& command) {
    command
        .add_option("SCENE,--scene", source, "a .glb or .gltf file, or a built-in scene (see 'raycache list scenes')")
        ->check([](std::string& name) { tracer::check_scene_name(name); })
        ->required();
}

void SceneOptions::add_view(Command& command) {
    command.group("Scene", true);
    command.add_option("--detail", detail, "triangles wanted of a built-in scene; default: the scene's own")
        ->range(std::uint64_t{1}, most_triangles)
        ->default_text("");
    command.add_option("--camera", camera, "camera of the scene by NAME or INDEX; default: the first");
    command.add_option("--eye", eye, "the eye, instead of a camera of the file; needs --look-at")->type_name("X,Y,Z");
    command.add_option("--look-at", look_at, "the point that the eye looks at")->type_name("X,Y,Z");
    command.add_option("--fov", fov, "vertical field of view in degrees; default: the camera's")
        ->range(0.001, 179.999)
        ->default_text("");
    command.add_option("--sky", sky, "constant sky and a sun: auto (where the scene has no light of its own), on, off")
        ->choices("sky", {"auto", "on", "off"})
        ->type_name("WHEN");
    command.add_flag("--spatial-splits", spatial_splits, "build the BVH with spatial splits");
    command.add_option("--layout", layout, "how the BVH lies in memory (see 'raycache list layouts')")
        ->choices("layout", names_of(tracer::bvh_layouts()));
    if (const char* folder = std::getenv("RAYCACHE_BVH_CACHE")) bvh_cache = folder;
    command
        .add_option("--bvh-cache", bvh_cache,
                    "folder that keeps BVHs once built, for the next command on the scene; default: "
                    "$RAYCACHE_BVH_CACHE, or none. Results do not depend on it")
        ->type_name("DIR")
        ->default_text("");
    command.group("");
}

void SamplingOptions::add_picture(Command& command) {
    command.group("Paths", true);
    command.add_option("--resolution", resolution, "of the picture, in pixels")->type_name("WIDTHxHEIGHT");
    command.add_option("--bounces", bounces, "bounce rays of a path")->range(std::uint64_t{0}, tracer::max_bounces);
    command
        .add_option("--bounces-diffuse", bounces_diffuse,
                    "at most so many of them reflections, diffuse or glossy; default: all")
        ->range(std::uint64_t{0}, tracer::max_bounces);
    command
        .add_option("--bounces-transmission", bounces_transmission,
                    "at most so many of them through surfaces or inside glass; default: all")
        ->range(std::uint64_t{0}, tracer::max_bounces);
    command
        .add_option("--lights", lights,
                    "how lights are found: auto (nee on diffuse surfaces, mis on others), bsdf (bounce rays), nee "
                    "(shadow rays), mis (both, weighted)")
        ->choices("way to find lights", {"auto", "bsdf", "nee", "mis"})
        ->type_name("HOW");
    command
        .add_option("--integrator", integrator,
                    "what is computed along the rays of a pixel (see 'raycache list integrators')")
        ->choices("integrator", names_of(tracer::integrators()));
    command.add_flag("--russian-roulette", russian_roulette,
                     "end dim paths early at random; breaks lock-step comparisons");
    add_integrator_parameters(command);
    command.group("");
}

void SamplingOptions::add_integrator_parameters(Command& command) {
    for (const tracer::ParameterEntry& p : tracer::integrator_parameters()) {
        std::vector<std::string> readers;
        for (const tracer::IntegratorEntry& entry : tracer::integrators())
            if (entry.has_parameter(p.name)) readers.push_back(entry.name);
        Option* option =
            command.add_option(fmt::format("--{}", p.name), integrator_parameters[p.name],
                               fmt::format("of integrator {}: {}", fmt::join(readers, ", "), p.description));
        option->default_text(p.fallback);
        if (p.has_choices())
            option->choices(p.label, p.choice_names());
        else if (p.check)
            option->check([check = p.check](std::string& word) { check(word); });
        else if (p.whole)
            option->range(static_cast<std::uint64_t>(p.least), static_cast<std::uint64_t>(p.most))->whole_or(p.word);
        else if (*p.word)
            option->range(p.least, p.most)->number_or(p.word);
        else
            option->range(p.least, p.most)->number();
    }
}

void SamplingOptions::add_strategy(Command& command) {
    command.group("Sampling", true);
    command.add_option("--k", k, "K of micro-jitter's mu = min(1, K * N^(-1/s)), or 'discrepancy': (N * D*_N)^(1/s)")
        ->range(0.0, std::numeric_limits<double>::max())
        ->number_or("discrepancy");
    command.add_option("--s", s, "s of the same formula: dimensions sampled jointly, or 'full': all of a path")
        ->range(std::uint64_t{1}, std::numeric_limits<unsigned>::max())
        ->whole_or("full");
    command
        .add_option("--mu", mu,
                    "mu itself, 0 to 1, of micro-jitter and scrambling-distance; instead of --k and --s, or of "
                    "--cycles-...")
        ->check([](std::string& word) {
            if (word == "cycles")
                throw UsageError(
                    "--mu 'cycles': expected a number from 0 to 1: Blender's automatic distance is --strategy "
                    "scrambling-distance, with --cycles-multiplier, --cycles-min-samples and "
                    "--cycles-noise-threshold");
        })
        ->range(0.0, std::numeric_limits<double>::max())
        ->number();
    command
        .add_option("--cycles-multiplier", cycles_multiplier,
                    "Blender's Scrambling Distance Multiplier, of scrambling-distance: d = multiplier * 4 / "
                    "sqrt(samples), off from 1 on; Blender reads it with the pattern Tabulated Sobol only, not with "
                    "its default")
        ->range(0.0, std::numeric_limits<double>::max());
    command.add_option(
        "--cycles-min-samples", cycles_min_samples,
        "Blender's Min Samples: samples = min(N, this); 0: max(4, ceil(16 / threshold^0.3)), 64 by default");
    command
        .add_option("--cycles-noise-threshold", cycles_noise_threshold,
                    "Blender's Noise Threshold, 0 to 1, 0: max(0.001, 1/N); off: no adaptive sampling, samples = N")
        ->range(0.0, 1.0)
        ->number_or("off");
    command
        .add_option("--interleave", interleave,
                    "M of the M x M pixel classes of interleaved, net-micro-jitter-fast and the thread map classes")
        ->range(std::uint64_t{1}, tracer::max_interleave);
    command
        .add_option("--share", share,
                    "pairs of dimensions whose leading bits net-micro-jitter shares between pixels, joined by +: "
                    "first-bounce, light0, camera, or the first dimension of a pair; or sets: of all dimensions, in "
                    "sets of 4")
        ->type_name("PAIRS")
        ->check([](std::string& word) { tracer::check_parameter(tracer::find_parameter("share"), word); });
    command.add_option("--share-bits", share_bits, "bits that it shares; default: as many as are free of shared error")
        ->range(std::uint64_t{0}, std::uint64_t{256});
    command
        .add_option("--param", parameters,
                    "any parameter of a strategy by its name; rules over the option of the same name")
        ->repeated()
        ->type_name("NAME=VALUE")
        ->check([](std::string& word) {
            const std::size_t at = word.find('=');
            if (at == std::string::npos)
                throw UsageError(fmt::format("--param '{}'; expected NAME=VALUE such as mu=0.1", word));
            tracer::check_parameter(tracer::find_parameter(word.substr(0, at)), word.substr(at + 1));
        });
    command.add_option("--seed", seed, "seed of jitter, random numbers and the choice of sample indices");
    command.group("");
}

void SamplingOptions::add_launches(Command& command) {
    command.group("Launches", true);
    command
        .add_option("--trace-samples", trace_samples,
                    "how many of the N sample indices are traced: a seeded random subset, the same for every strategy")
        ->range(std::uint64_t{1}, std::numeric_limits<std::uint64_t>::max());
    command
        .add_option("--thread-map", thread_map,
                    "tile: a warp = 8x4 pixels, one sample index; samples: a warp = one pixel, 32 sample indices; "
                    "classes: tiles of pixels of one class (--interleave). Default: classes for strategies with pixel "
                    "classes, else tile")
        ->choices("thread map", names_of(tracer::thread_maps()));
    command.group("");
}

void SamplingOptions::add_execution(Command& command) {
    command.group("Launches", true);
    command
        .add_option("--execution", execution,
                    "megakernel: a warp keeps its paths to the end; wavefront: a kernel per bounce and stage, over the "
                    "rays that are left")
        ->choices("execution", {"megakernel", "wavefront"});
    command
        .add_option("--order", order,
                    "how a wavefront sorts the rays of a bounce before they form warps (see 'raycache list orders')")
        ->choices("ray order", names_of(tracer::ray_orders()));
    command.group("");
}

void ThreadOptions::add(Command& command) {
    command.add_option("--threads", threads, "worker threads; default: all cores. Results do not depend on it")
        ->range(std::uint64_t{1}, std::uint64_t{1024})
        ->default_text("");
}

std::shared_ptr<void> ThreadOptions::apply() const {
    const unsigned wanted = threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
    return std::make_shared<tbb::global_control>(tbb::global_control::max_allowed_parallelism, wanted);
}

}  // namespace raycache::tools
