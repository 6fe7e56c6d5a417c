#include "tools/jobs/sampling_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "tools/jobs/numbers.hpp"
#include "tools/jobs/version.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

/// The options that the strategy reads: another command with them would be warned of (idle_options.hpp).
std::string parameter_command(const SamplingSettings& sampling, const tracer::CaptureSettings& settings) {
    const tracer::DecorrelationEntry& entry = tracer::find_decorrelation(settings.strategy.decorrelation);
    const auto reads = [&](tracer::Parameter p) { return entry.reads_parameter(p, settings.strategy.parameters); };
    std::string text;
    if (reads(tracer::Parameter::k)) text += fmt::format(" --k {} --s {}", sampling.k, sampling.s);
    if (reads(tracer::Parameter::mu)) text += " --mu " + sampling.mu;
    if (reads(tracer::Parameter::cycles_multiplier) && sampling.cycles_multiplier != 1)
        text += fmt::format(" --cycles-multiplier {}", sampling.cycles_multiplier);
    if (reads(tracer::Parameter::cycles_min_samples) && sampling.cycles_min_samples != 0)
        text += fmt::format(" --cycles-min-samples {}", sampling.cycles_min_samples);
    if (reads(tracer::Parameter::cycles_noise_threshold) && sampling.cycles_noise_threshold != "0.01")
        text += " --cycles-noise-threshold " + sampling.cycles_noise_threshold;
    const bool classes = reads(tracer::Parameter::interleave) || settings.thread_map == tracer::ThreadMap::classes;
    if (classes && sampling.interleave != 8) text += fmt::format(" --interleave {}", sampling.interleave);
    return text;
}

/// Options of paths() that differ from the defaults.
std::string path_command(const SamplingSettings& sampling) {
    std::string text;
    if (sampling.bounces_diffuse) text += fmt::format(" --bounces-diffuse {}", *sampling.bounces_diffuse);
    if (sampling.bounces_transmission)
        text += fmt::format(" --bounces-transmission {}", *sampling.bounces_transmission);
    if (sampling.lights != "auto") text += " --lights " + sampling.lights;
    if (sampling.integrator != tracer::default_integrator) text += " --integrator " + sampling.integrator;
    if (sampling.russian_roulette) text += " --russian-roulette";
    return text;
}

}  // namespace

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

tracer::PathSettings SamplingSettings::paths() const {
    tracer::PathSettings settings;
    settings.bounces = bounces;
    settings.russian_roulette = russian_roulette;
    settings.bounces_diffuse = bounces_diffuse.value_or(settings.bounces_diffuse);
    settings.bounces_transmission = bounces_transmission.value_or(settings.bounces_transmission);
    settings.lights = tracer::light_sampling_from(lights);
    settings.integrator = integrator;
    tracer::check(settings);
    return settings;
}

tracer::StrategySettings SamplingSettings::strategy(const std::string& sequence, const std::string& decorrelation,
                                                    std::uint64_t spp) const {
    tracer::StrategySettings settings;
    settings.sequence = sequence;
    settings.decorrelation = decorrelation;
    tracer::DecorrelationSettings& p = settings.parameters;
    settings.samples.spp = spp;
    settings.samples.seed = seed;
    settings.samples.width = parse_resolution(resolution).width;
    p.interleave = interleave;
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

tracer::CaptureSettings capture_settings(const SceneSettings& scene, const SamplingSettings& common,
                                         const CaseSettings& one) {
    SamplingSettings sampling = common;
    if (!one.k.empty()) sampling.k = one.k;
    if (!one.mu.empty()) sampling.mu = one.mu;
    tracer::CaptureSettings settings;
    tracer::check_strategy_name(one.strategy);
    const std::string& decorrelation = one.strategy.decorrelation;
    settings.execution =
        tracer::execution_of(one.strategy, {tracer::execution_from(sampling.execution), sampling.order});
    const bool wavefront = settings.execution.execution == tracer::Execution::wavefront;
    const Resolution size = parse_resolution(sampling.resolution);
    settings.width = size.width;
    settings.height = size.height;
    settings.paths = sampling.paths();
    tracer::check_execution(settings.execution, tracer::integrator_entry(settings.paths.integrator));
    settings.strategy = sampling.strategy(one.sequence, decorrelation, one.spp);
    settings.trace_samples = sampling.trace_samples;
    settings.thread_map = tracer::thread_map_of(one.strategy, sampling.thread_map);
    settings.program = program_name;
    settings.command = fmt::format(
        "raycache capture {} --strategy {} --sequence {} --spp {} --trace-samples {} --resolution {}x{} --bounces {}{} "
        "--thread-map {}{} --seed {}{}",
        scene.command(), decorrelation, one.sequence, one.spp, std::min(sampling.trace_samples, one.spp), size.width,
        size.height, sampling.bounces, path_command(sampling), tracer::to_string(settings.thread_map),
        parameter_command(sampling, settings), sampling.seed,
        wavefront ? " --execution wavefront --order " + settings.execution.order : "");
    return settings;
}

std::vector<tracer::CaptureSettings> capture_settings(const SceneSettings& scene, const SamplingSettings& sampling,
                                                      const std::vector<CaseSettings>& cases) {
    std::vector<tracer::CaptureSettings> all;
    for (const CaseSettings& one : cases) all.push_back(capture_settings(scene, sampling, one));
    return all;
}

void warn_of_strategies(const std::vector<tracer::CaptureSettings>& cases, Observer& observer) {
    std::vector<std::string> said;
    for (const tracer::CaptureSettings& c : cases) {
        tracer::StrategySettings strategy = c.strategy;
        strategy.samples.width = c.width;
        const tracer::SamplingStrategy made(strategy, tracer::sample_dimensions(c.paths));
        for (const std::string& line : made.warnings()) {
            if (std::find(said.begin(), said.end(), line) != said.end()) continue;
            said.push_back(line);
            observer.warn(line);
        }
    }
}

}  // namespace raycache::tools
