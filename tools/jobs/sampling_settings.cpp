#include "tools/jobs/sampling_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>

#include "tools/jobs/numbers.hpp"
#include "tools/jobs/version.hpp"
#include "tracer/sampling/pixel_place.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

/// Parameters with an option of their own.
const std::set<std::string> sampling_options{
    "k",          "s",     "mu",        "cycles-multiplier", "cycles-min-samples", "cycles-noise-threshold",
    "interleave", "share", "share-bits"};

/// The parameters that the strategy or its thread map reads: another command with them would be warned of
/// (idle_options.hpp). Those that have their default are left out, but for K and s.
std::string parameter_command(const tracer::CaptureSettings& settings) {
    const tracer::DecorrelationEntry& entry = tracer::find_decorrelation(settings.strategy.decorrelation);
    const tracer::Parameters& given = settings.strategy.parameters;
    std::string text;
    const auto add = [&](const std::string& name, const char* fallback) {
        if (!given.has(name) || given.text(name) == fallback) return;
        text += sampling_options.contains(name) ? fmt::format(" --{} {}", name, given.text(name))
                                                : fmt::format(" --param {}={}", name, given.text(name));
    };
    for (const char* always : {"k", "s", "mu"})
        if (entry.reads_parameter(always, given)) add(always, "");
    for (const std::string& name : tracer::parameter_names()) {
        if (name == "k" || name == "s" || name == "mu") continue;
        const bool of_map =
            name == tracer::interleave_parameter.name && settings.thread_map == tracer::ThreadMap::classes;
        if (of_map || entry.reads_parameter(name, given)) add(name, tracer::find_parameter(name).fallback);
    }
    return text;
}

/// Options of paths() that the integrator reads: --bounces, and those that differ from the defaults.
std::string path_command(const SamplingSettings& sampling) {
    const tracer::IntegratorEntry& entry = tracer::integrator_entry(sampling.integrator);
    std::string text;
    if (entry.follows_light) {
        text += fmt::format(" --bounces {}", sampling.bounces);
        if (sampling.bounces_diffuse) text += fmt::format(" --bounces-diffuse {}", *sampling.bounces_diffuse);
        if (sampling.bounces_transmission)
            text += fmt::format(" --bounces-transmission {}", *sampling.bounces_transmission);
        if (sampling.lights != "auto") text += " --lights " + sampling.lights;
    }
    if (sampling.integrator != tracer::default_integrator) text += " --integrator " + sampling.integrator;
    for (const tracer::ParameterEntry& p : entry.parameters) {
        const auto given = sampling.integrator_parameters.find(p.name);
        if (given == sampling.integrator_parameters.end() || given->second.empty() || given->second == p.fallback)
            continue;
        text += fmt::format(" --{} {}", p.name, given->second);
    }
    if (entry.follows_light && sampling.russian_roulette) text += " --russian-roulette";
    return text;
}

/// A parameter in the name that nothing reads is a mistake: two rows would be alike.
void check_own_parameters(const tracer::StrategyName& name, const tracer::Parameters& given) {
    const tracer::DecorrelationEntry& entry = tracer::find_decorrelation(name.decorrelation);
    for (const std::string& own : name.parameters) {
        const std::string parameter = own.substr(0, own.find('='));
        if (entry.reads_parameter(parameter, given)) continue;
        throw UsageError(
            fmt::format("strategy '{}': {} has no effect beside the other parameters given, which take its "
                        "place; leave out one of them",
                        to_string(name), parameter));
    }
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
    for (const auto& [name, value] : integrator_parameters)
        if (!value.empty()) settings.parameters.set(name, value);
    tracer::check(settings);
    if (!tracer::integrator_entry(integrator).follows_light) settings.bounces = 0;
    return settings;
}

tracer::StrategySettings SamplingSettings::strategy(const std::string& sequence, const std::string& decorrelation,
                                                    std::uint64_t spp) const {
    tracer::StrategySettings settings;
    settings.sequence = sequence;
    settings.decorrelation = decorrelation;
    settings.samples.spp = spp;
    settings.samples.seed = seed;
    settings.samples.width = parse_resolution(resolution).width;
    tracer::Parameters& p = settings.parameters;
    if (k != "discrepancy") read_real(k, "--k", {});
    p.set("k", k);
    if (s != "full") read_whole(s, "--s", {1, std::numeric_limits<unsigned>::max()});
    p.set("s", s);
    if (!mu.empty()) {
        read_real(mu, "--mu", {});
        p.set("mu", mu);
    }
    p.set("cycles-multiplier", cycles_multiplier);
    p.set("cycles-min-samples", cycles_min_samples);
    if (cycles_noise_threshold != "off") read_real(cycles_noise_threshold, "--cycles-noise-threshold", {0, 1});
    p.set("cycles-noise-threshold", cycles_noise_threshold);
    p.set("interleave", interleave);
    p.set("share", share);
    if (share_bits) p.set("share-bits", *share_bits);
    std::set<std::string> given;
    for (const std::string& one : parameters) {
        const std::size_t at = one.find('=');
        if (at == std::string::npos)
            throw UsageError(fmt::format("--param '{}'; expected NAME=VALUE such as mu=0.1", one));
        if (!given.insert(one.substr(0, at)).second)
            throw UsageError(fmt::format("--param '{}': {} is given twice; expected once", one, one.substr(0, at)));
        p.set(one.substr(0, at), one.substr(at + 1));
    }
    tracer::check_parameters(p);
    return settings;
}

SamplingSettings of_case(SamplingSettings sampling, const CaseSettings& one) {
    const auto replace = [&](const std::string& name, const std::string& value, std::string& member) {
        if (value.empty()) return;
        member = value;
        std::erase_if(sampling.parameters, [&](const std::string& given) { return given.starts_with(name + '='); });
    };
    replace("k", one.k, sampling.k);
    replace("mu", one.mu, sampling.mu);
    for (const std::string& own : one.strategy.parameters) {
        const std::string prefix = own.substr(0, own.find('=') + 1);
        std::erase_if(sampling.parameters, [&](const std::string& given) { return given.starts_with(prefix); });
        sampling.parameters.push_back(own);
    }
    return sampling;
}

SceneSettings of_case(SceneSettings scene, const CaseSettings& one) {
    scene.layout = one.strategy.layout.value_or(scene.layout);
    return scene;
}

tracer::CaptureSettings capture_settings(const SceneSettings& scene, const SamplingSettings& common,
                                         const CaseSettings& one) {
    const SamplingSettings sampling = of_case(common, one);
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
    check_own_parameters(one.strategy, settings.strategy.parameters);
    settings.trace_samples = sampling.trace_samples;
    settings.thread_map = tracer::thread_map_of(one.strategy, sampling.thread_map);
    settings.program = program_name;
    settings.command = fmt::format(
        "raycache capture {} --strategy {} --sequence {} --spp {} --trace-samples {} --resolution {}x{}{} "
        "--thread-map {}{} --seed {}{}",
        of_case(scene, one).command(), decorrelation, one.sequence, one.spp, std::min(sampling.trace_samples, one.spp),
        size.width, size.height, path_command(sampling), tracer::to_string(settings.thread_map),
        parameter_command(settings), sampling.seed,
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
