#include "tracer/sampling/decorrelation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>

#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {

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

bool DecorrelationEntry::has_parameter(const std::string& parameter) const {
    return std::any_of(parameters.begin(), parameters.end(), [&](const auto& p) { return parameter == p.name; });
}

bool DecorrelationEntry::reads_parameter(const std::string& parameter, const Parameters& given) const {
    if (!reads) return has_parameter(parameter);
    const std::vector<std::string> all = reads(given);
    return std::find(all.begin(), all.end(), parameter) != all.end();
}

std::vector<std::string> parameter_names() {
    std::vector<std::string> names;
    for (const DecorrelationEntry& entry : decorrelations())
        for (const ParameterEntry& p : entry.parameters)
            if (std::find(names.begin(), names.end(), p.name) == names.end()) names.emplace_back(p.name);
    return names;
}

const ParameterEntry& find_parameter(const std::string& name) {
    for (const DecorrelationEntry& entry : decorrelations())
        for (const ParameterEntry& p : entry.parameters)
            if (name == p.name) return p;
    const std::vector<std::string> names = parameter_names();
    throw UsageError(fmt::format("sampling: unknown parameter '{}'; expected one of: {}{}", name,
                                 fmt::join(names, ", "), did_you_mean(name, names)));
}

void check_parameters(const Parameters& given) {
    for (const auto& [name, value] : given.given()) check_parameter(find_parameter(name), value);
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

std::unique_ptr<Decorrelation> make_decorrelation(const std::string& name, const Parameters& parameters,
                                                  const SampleSet& samples, const Sequence& sequence) {
    const DecorrelationEntry& entry = find_decorrelation(name);
    check_spp(samples.spp);
    check_parameters(parameters);
    return entry.make(parameters, samples, sequence);
}

std::unique_ptr<Decorrelation> make_decorrelation(const std::string& name, const Parameters& parameters,
                                                  const SampleSet& samples) {
    return make_decorrelation(name, parameters, samples, *make_sequence("sobol"));
}

}  // namespace raycache::tracer
