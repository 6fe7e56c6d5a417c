#include "tracer/sampling/decorrelation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "tracer/sampling/measures/star_discrepancy.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {

namespace {

void check_nonnegative(const char* name, double value, const char* example) {
    if (!std::isfinite(value) || value < 0) {
        throw UsageError(fmt::format("sampling: {} must be a number of 0 or more, found {}: give {} such as {}", name,
                                     value, name, example));
    }
}

}  // namespace

void check_settings(const DecorrelationSettings& settings) {
    check_nonnegative("K", settings.k, "2.5");
    if (settings.s == 0) {
        throw UsageError(
            "sampling: the dimension s of mu = K * N^(-1/s) must be 1 or more, found 0: give s = 2, the default");
    }
    if (settings.interleave == 0 || settings.interleave > max_interleave) {
        throw UsageError(fmt::format(
            "sampling: the M of M x M pixel classes must be 1 to {}, found {}: give --interleave 8, the default",
            max_interleave, settings.interleave));
    }
    if (settings.mu) check_nonnegative("mu", *settings.mu, "0.1");
    check_cycles(settings.cycles);
}

double requested_mu(const DecorrelationSettings& settings, std::uint64_t spp) {
    if (settings.mu) return *settings.mu;
    const auto n = static_cast<double>(spp);
    // The two common cases need no pow(), whose last digit depends on the C library and processor.
    if (settings.s == 1) return settings.k / n;
    if (settings.s == 2) return settings.k / std::sqrt(n);
    return settings.k / std::pow(n, 1.0 / settings.s);
}

double scrambling_distance(const DecorrelationSettings& settings, std::uint64_t spp) {
    return settings.mu ? *settings.mu : cycles_distance(settings.cycles, spp);
}

double effective_mu(const DecorrelationSettings& settings, std::uint64_t spp) {
    return std::min(1.0, requested_mu(settings, spp));
}

DecorrelationSettings resolve_k_and_s(const DecorrelationSettings& settings, const SampleSet& samples,
                                      const Sequence& sequence) {
    DecorrelationSettings resolved = settings;
    if (settings.full_s) {
        if (samples.dimensions == 0)
            throw UsageError(
                "sampling: s = full needs the number of dimensions of a path, found none: give s as a number");
        resolved.s = samples.dimensions;
    }
    if (settings.k_from_discrepancy) {
        if (samples.spp > max_star_discrepancy_points) {
            throw UsageError(fmt::format(
                "sampling: K from the star discrepancy is computed exactly, for N up to {}, found N = {}: give K as a "
                "number such as 2.5",
                max_star_discrepancy_points, samples.spp));
        }
        std::vector<FixedPoint2> points;
        for (std::uint32_t i = 0; i < samples.spp; ++i)
            points.push_back({sequence.sample(i, 0), sequence.sample(i, 1)});
        resolved.k = std::pow(static_cast<double>(samples.spp) * star_discrepancy(points), 1.0 / resolved.s);
    }
    return resolved;
}

void require_net(const std::string& decorrelation, const Sequence& sequence, unsigned s) {
    const auto fits = [s](const Sequence& q) { return q.net_dimensions() != 0 && q.net_dimensions() % s == 0; };
    if (fits(sequence)) return;
    std::string names;
    for (const auto& entry : sequences())
        if (fits(*make_sequence(entry.name))) names += (names.empty() ? "" : ", ") + entry.name;
    throw UsageError(fmt::format(
        "sampling: {} moves points inside the cells of a net in base 2 in {} dimension{} jointly, found sequence '{}', "
        "which is none: choose one of {}",
        decorrelation, s, s == 1 ? "" : "s", sequence.name(), names));
}

unsigned require_power_of_two(const std::string& decorrelation, std::uint64_t spp) {
    if (std::has_single_bit(spp)) return static_cast<unsigned>(std::countr_zero(spp));
    throw UsageError(
        fmt::format("sampling: {} needs a whole net, so N must be a power of two, found {}: give N = {} or {}",
                    decorrelation, spp, std::bit_floor(spp), std::bit_ceil(spp)));
}

const char* to_string(Parameter parameter) {
    switch (parameter) {
        case Parameter::sequence:
            return "sequence";
        case Parameter::seed:
            return "seed";
        case Parameter::k:
            return "k";
        case Parameter::s:
            return "s";
        case Parameter::mu:
            return "mu";
        case Parameter::interleave:
            return "interleave";
        case Parameter::cycles_multiplier:
            return "cycles-multiplier";
        case Parameter::cycles_min_samples:
            return "cycles-min-samples";
        case Parameter::cycles_noise_threshold:
            return "cycles-noise-threshold";
    }
    return "";
}

bool DecorrelationEntry::reads_parameter(Parameter parameter, const DecorrelationSettings& settings) const {
    const std::vector<Parameter> all = reads(settings);
    return std::find(all.begin(), all.end(), parameter) != all.end();
}

const DecorrelationEntry& find_decorrelation(const std::string& name) {
    const auto& all = decorrelations();
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.name == name; });
    if (found == all.end()) {
        std::vector<std::string> names;
        for (const auto& entry : all) names.push_back(entry.name);
        throw UsageError(fmt::format("unknown strategy '{}'; expected one of: {}{}", name, fmt::join(names, ", "),
                                     did_you_mean(name, names)));
    }
    return *found;
}

std::unique_ptr<Decorrelation> make_decorrelation(const std::string& name, const DecorrelationSettings& settings,
                                                  const SampleSet& samples, const Sequence& sequence) {
    const DecorrelationEntry& entry = find_decorrelation(name);
    check_spp(samples.spp);
    check_settings(settings);
    return entry.make(settings, samples, sequence);
}

std::unique_ptr<Decorrelation> make_decorrelation(const std::string& name, const DecorrelationSettings& settings,
                                                  const SampleSet& samples) {
    return make_decorrelation(name, settings, samples, *make_sequence("sobol"));
}

}  // namespace raycache::tracer
