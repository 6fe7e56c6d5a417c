#include "tools/program/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <thread>

#include <limits>
#include <thread>
#include "tools/jobs/costs.hpp"
#include "tools/jobs/version.hpp"
#include "tools/program/console.hpp"

#include "tools/program/console.hpp"
#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/sequence.hpp"
#include "tracer/scene/scene_name.hpp"
#include "tracer/simt/orders/ray_order.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

tracer::Vec3 parse_vector(const std::string& text, const char* option) {
    tracer::Vec3 v;
    float* out[3] = {&v.x, &v.y, &v.z};
    const char* at = text.data();
    const char* end = at + text.size();
    for (int i = 0; i < 3; ++i) {
        const auto [stop, error] = std::from_chars(at, end, *out[i]);
        const bool last = i == 2;
        if (error != std::errc{} || !std::isfinite(*out[i]) || (last ? stop != end : stop == end || *stop != ','))
            throw UsageError(fmt::format("{} '{}'; expected three numbers X,Y,Z such as 1.5,2,-3", option, text));
        at = stop + 1;
    }
    return v;
}

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

tracer::SceneRequest::Sky parse_sky(const std::string& text) {
    if (text == "auto") return tracer::SceneRequest::Sky::automatic;
    if (text == "on") return tracer::SceneRequest::Sky::on;
    if (text == "off") return tracer::SceneRequest::Sky::off;
    throw UsageError(fmt::format("--sky '{}'; expected one of: auto, on, off", text));
}

}  // namespace

std::vector<std::string> settings_warnings(const tracer::CaptureSettings& settings) {
    tracer::StrategySettings strategy = settings.strategy;
    strategy.parameters.width = settings.width;
    return tracer::SamplingStrategy(strategy, tracer::path_dimensions(settings.paths.bounces)).warnings();
}

Resolution parse_resolution(const std::string& text) {
    Resolution r{};
    const char* end = text.data() + text.size();
    const auto [cross, error] = std::from_chars(text.data(), end, r.width);
    const bool separated = error == std::errc{} && cross != end && *cross == 'x';
    const auto [stop, second_error] = separated ? std::from_chars(cross + 1, end, r.height)
                                                : std::from_chars_result{cross, std::errc::invalid_argument};
    if (second_error != std::errc{} || stop != end || r.width == 0 || r.height == 0 ||
        r.width > tracer::max_resolution || r.height > tracer::max_resolution)
        throw UsageError(fmt::format("--resolution '{}'; expected WIDTHxHEIGHT such as 512x512, each 1 to {}", text,
                                     tracer::max_resolution));
    return r;
}

std::vector<std::string> strategy_names() { return names_of(tracer::decorrelations()); }
std::vector<std::string> sequence_names() { return names_of(tracer::sequences()); }

void check_strategy_name(const std::string& name, bool execution) {
    const std::size_t plus = execution ? name.find('+') : std::string::npos;
    tracer::find_decorrelation(name.substr(0, plus));
    if (plus == std::string::npos) return;
    std::vector<std::string> valid = names_of(tracer::ray_orders());
    valid.emplace_back("wavefront");
    const std::string suffix = name.substr(plus + 1);
    if (std::find(valid.begin(), valid.end(), suffix) == valid.end())
        throw UsageError(fmt::format("strategy '{}': unknown ray order '{}'; expected one of: {}{}", name, suffix,
                                     fmt::join(valid, ", "), did_you_mean(suffix, valid)));
}

Option* add_strategies(Command& command, std::vector<std::string>& strategies, bool execution) {
    const std::string more =
        "; NAME+wavefront or NAME+ORDER runs one as a wavefront, without sorting or with its rays sorted so";
    return command
        .add_option("--strategy", strategies,
                    "decorrelations, separated by commas (see 'raycache list strategies')" + (execution ? more : ""))
        ->check([execution](std::string& name) { check_strategy_name(name, execution); })
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
    command.group("");
}

std::unique_ptr<tracer::PreparedScene> SceneOptions::prepare(const FileNames& outputs, Progress& progress) const {
    if (!tracer::find_builtin_scene(source)) refuse_overwriting({source}, outputs);  // before anything takes time
    std::error_code unknown;
    const std::uintmax_t bytes = std::filesystem::file_size(source, unknown);
    constexpr std::uint64_t usual_triangles = 300000;
    progress.expect("load", Work::prepare,
                    unknown ? load_cost(0, detail != 0 ? detail : usual_triangles) : load_cost(bytes, bytes / 100));
    const Stage stage(progress, "load");
    tracer::SceneRequest request;
    request.source = source;
    request.detail = detail;
    request.sky = parse_sky(sky);
    request.camera = camera;
    if (!eye.empty()) request.eye = parse_vector(eye, "--eye");
    if (!look_at.empty()) request.look_at = parse_vector(look_at, "--look-at");
    if (fov != 0) request.vertical_fov = fov;
    tracer::BvhSettings bvh;
    bvh.spatial_splits = spatial_splits;
    tracer::Scene scene = tracer::load_scene(request, warn);
    refuse_overwriting(scene.files, outputs);
    return std::make_unique<tracer::PreparedScene>(std::move(scene), bvh);
}

std::string SceneOptions::command() const {
    std::string text = source;
    if (detail != 0) text += fmt::format(" --detail {}", detail);
    if (!camera.empty()) text += " --camera " + camera;
    if (!eye.empty()) text += " --eye " + eye;
    if (!look_at.empty()) text += " --look-at " + look_at;
    if (fov != 0) text += fmt::format(" --fov {}", fov);
    text += " --sky " + sky;
    if (spatial_splits) text += " --spatial-splits";
    return text;
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
    command.add_flag("--russian-roulette", russian_roulette,
                     "end dim paths early at random; breaks lock-step comparisons");
    command.group("");
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
        ->choices("thread map", {"tile", "samples", "classes"});
    command.group("");
}

tracer::PathSettings SamplingOptions::paths() const {
    tracer::PathSettings settings;
    settings.bounces = bounces;
    settings.russian_roulette = russian_roulette;
    settings.bounces_diffuse = bounces_diffuse.value_or(settings.bounces_diffuse);
    settings.bounces_transmission = bounces_transmission.value_or(settings.bounces_transmission);
    settings.lights = tracer::light_sampling_from(lights);
    tracer::check(settings);
    return settings;
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

tracer::StrategySettings SamplingOptions::strategy(const std::string& sequence, const std::string& decorrelation,
                                                   std::uint64_t spp) const {
    tracer::StrategySettings settings;
    settings.sequence = sequence;
    settings.decorrelation = decorrelation;
    tracer::DecorrelationSettings& p = settings.parameters;
    p.spp = spp;
    p.seed = seed;
    p.interleave = interleave;
    p.width = parse_resolution(resolution).width;
    p.k_from_discrepancy = k == "discrepancy";
    if (!p.k_from_discrepancy) p.k = read_real(k, "--k", {});
    p.full_s = s == "full";
    if (!p.full_s) p.s = static_cast<unsigned>(read_whole(s, "--s", {1, std::numeric_limits<unsigned>::max()}));
    if (!mu.empty()) p.mu = read_real(mu, "--mu", {});
    p.cycles.multiplier = cycles_multiplier;
    p.cycles.min_samples = cycles_min_samples;
    p.cycles.noise_threshold.reset();
    if (cycles_noise_threshold != "off")
        p.cycles.noise_threshold = read_real(cycles_noise_threshold, "--cycles-noise-threshold", {0, 1});
    return settings;
}

/// The options that the strategy reads: another command with them would be warned of (idle_options.hpp).
std::string SamplingOptions::parameter_command(const tracer::CaptureSettings& settings) const {
    const tracer::DecorrelationEntry& entry = tracer::find_decorrelation(settings.strategy.decorrelation);
    const auto reads = [&](tracer::Parameter p) { return entry.reads_parameter(p, settings.strategy.parameters); };
    std::string text;
    if (reads(tracer::Parameter::k)) text += fmt::format(" --k {} --s {}", k, s);
    if (reads(tracer::Parameter::mu)) text += " --mu " + mu;
    if (reads(tracer::Parameter::cycles_multiplier) && cycles_multiplier != 1)
        text += fmt::format(" --cycles-multiplier {}", cycles_multiplier);
    if (reads(tracer::Parameter::cycles_min_samples) && cycles_min_samples != 0)
        text += fmt::format(" --cycles-min-samples {}", cycles_min_samples);
    if (reads(tracer::Parameter::cycles_noise_threshold) && cycles_noise_threshold != "0.01")
        text += " --cycles-noise-threshold " + cycles_noise_threshold;
    const bool classes = reads(tracer::Parameter::interleave) || settings.thread_map == tracer::ThreadMap::classes;
    if (classes && interleave != 8) text += fmt::format(" --interleave {}", interleave);
    return text;
}

/// Options of paths() that differ from the defaults.
std::string SamplingOptions::path_command() const {
    std::string text;
    if (bounces_diffuse) text += fmt::format(" --bounces-diffuse {}", *bounces_diffuse);
    if (bounces_transmission) text += fmt::format(" --bounces-transmission {}", *bounces_transmission);
    if (lights != "auto") text += " --lights " + lights;
    if (russian_roulette) text += " --russian-roulette";
    return text;
}

tracer::CaptureSettings SamplingOptions::capture(const SceneOptions& scene, const std::string& sequence,
                                                 const std::string& strategy_name, std::uint64_t spp) const {
    tracer::CaptureSettings settings;
    const std::size_t plus = strategy_name.find('+');
    const std::string decorrelation = strategy_name.substr(0, plus);
    const std::string suffix = plus == std::string::npos ? "" : strategy_name.substr(plus + 1);
    settings.execution.execution = suffix.empty() ? tracer::execution_from(execution) : tracer::Execution::wavefront;
    settings.execution.order = suffix.empty() ? order : suffix == "wavefront" ? "none" : suffix;
    tracer::check_execution(settings.execution);
    const bool wavefront = settings.execution.execution == tracer::Execution::wavefront;
    const Resolution size = parse_resolution(resolution);
    settings.width = size.width;
    settings.height = size.height;
    settings.paths = paths();
    settings.strategy = strategy(sequence, decorrelation, spp);
    settings.trace_samples = trace_samples;
    const std::string own_map = tracer::find_decorrelation(decorrelation).has_classes ? "classes" : "tile";
    settings.thread_map = tracer::thread_map_from(thread_map.empty() ? own_map : thread_map);
    settings.program = program_name;
    settings.command = fmt::format(
        "raycache capture {} --strategy {} --sequence {} --spp {} --trace-samples {} --resolution {}x{} --bounces {}{} "
        "--thread-map {}{} --seed {}{}",
        scene.command(), decorrelation, sequence, spp, std::min(trace_samples, spp), size.width, size.height, bounces,
        path_command(), tracer::to_string(settings.thread_map), parameter_command(settings), seed,
        wavefront ? " --execution wavefront --order " + settings.execution.order : "");
    return settings;
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
