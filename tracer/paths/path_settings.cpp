#include "tracer/paths/path_settings.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "tracer/paths/integrators/integrator.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {

namespace {
constexpr std::array light_sampling_names{std::pair{"auto", LightSampling::automatic},
                                          std::pair{"bsdf", LightSampling::bsdf}, std::pair{"nee", LightSampling::nee},
                                          std::pair{"mis", LightSampling::mis}};
}  // namespace

LightSampling light_sampling_from(const std::string& name) {
    for (const auto& [known, value] : light_sampling_names)
        if (name == known) return value;
    throw UsageError(fmt::format("--lights '{}'; expected one of: auto, bsdf, nee, mis", name));
}

std::string to_string(LightSampling lights) {
    for (const auto& [known, value] : light_sampling_names)
        if (lights == value) return known;
    return {};
}

void check(const PathSettings& settings) {
    const auto limit = [](std::uint32_t bounces, const char* option) {
        if (bounces > max_bounces)
            throw UsageError(fmt::format("{} {}: too many bounces; expected 0 to {}", option, bounces, max_bounces));
    };
    limit(settings.bounces, "--bounces");
    limit(settings.bounces_diffuse, "--bounces-diffuse");
    limit(settings.bounces_transmission, "--bounces-transmission");
    integrator_entry(settings.integrator);
    for (const auto& [name, value] : settings.parameters.given()) check_parameter(integrator_parameter(name), value);
}

}  // namespace raycache::tracer
