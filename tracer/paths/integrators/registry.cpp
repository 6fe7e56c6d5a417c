// The list of integrators. To add one: write a file in this folder that defines `IntegratorEntry NAME_integrator()` in
// namespace raycache::tracer, and add X(NAME) below.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tracer/paths/integrators/integrator.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

#define RAYCACHE_INTEGRATORS(X) X(path) X(ao) X(ssao)

namespace raycache::tracer {

#define X(name) IntegratorEntry name##_integrator();
RAYCACHE_INTEGRATORS(X)
#undef X

const std::vector<IntegratorEntry>& integrators() {
#define X(name) name##_integrator(),
    static const std::vector<IntegratorEntry> all{RAYCACHE_INTEGRATORS(X)};
#undef X
    return all;
}

const IntegratorEntry& integrator_entry(const std::string& name) {
    std::vector<std::string> valid;
    for (const IntegratorEntry& entry : integrators()) {
        if (entry.name == name) return entry;
        valid.push_back(entry.name);
    }
    throw UsageError(fmt::format("unknown integrator '{}'; expected one of: {}{}", name, fmt::join(valid, ", "),
                                 did_you_mean(name, valid)));
}

bool IntegratorEntry::has_parameter(const std::string& parameter) const {
    return std::any_of(parameters.begin(), parameters.end(), [&](const auto& p) { return parameter == p.name; });
}

const std::vector<ParameterEntry>& integrator_parameters() {
    static const std::vector<ParameterEntry> all = [] {
        std::vector<ParameterEntry> found;
        for (const IntegratorEntry& entry : integrators())
            for (const ParameterEntry& p : entry.parameters)
                if (std::none_of(found.begin(), found.end(),
                                 [&](const auto& other) { return std::string(other.name) == p.name; }))
                    found.push_back(p);
        return found;
    }();
    return all;
}

const ParameterEntry& integrator_parameter(const std::string& name) {
    std::vector<std::string> valid;
    for (const ParameterEntry& p : integrator_parameters()) {
        if (name == p.name) return p;
        valid.emplace_back(p.name);
    }
    throw UsageError(fmt::format("integrator: unknown parameter '{}'; expected one of: {}{}", name,
                                 fmt::join(valid, ", "), did_you_mean(name, valid)));
}

std::uint32_t sample_dimensions(const PathSettings& settings) {
    return integrator_entry(settings.integrator).dimensions(settings);
}

}  // namespace raycache::tracer
