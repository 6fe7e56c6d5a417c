// What a user sets about paths.
#pragma once

#include <cstdint>
#include <string>

#include "tracer/sampling/parameters.hpp"

namespace raycache::tracer {

inline constexpr std::uint32_t max_bounces = 64;

/// How a path finds emissive triangles and the sun. The constant sky is met by bounce rays in every mode. All modes
/// converge to the same picture; a sun of no size is dark for `bsdf`, since no ray meets it.
enum class LightSampling {
    automatic,  ///< `nee` on diffuse surfaces, `mis` on all others
    bsdf,       ///< bounce rays alone, no shadow rays
    nee,        ///< shadow rays; bounce rays count only behind perfect mirrors, clear glass and alpha
    mis,        ///< both, by the power heuristic (E. Veach, L. Guibas, SIGGRAPH 1995)
};
/// "auto", "bsdf", "nee", "mis". Throws UsageError for other names.
LightSampling light_sampling_from(const std::string& name);
std::string to_string(LightSampling);

inline constexpr const char* default_integrator = "path";

struct PathSettings {
    std::uint32_t bounces = 3;  ///< bounce rays of a path, 0 … 64
    /// Paths end early at random from the third vertex on, by throughput. Off for comparisons: it breaks lock step.
    bool russian_roulette = false;
    /// Limits on the bounces that are reflections, and on those that are transmissions: crossing a surface, or staying
    /// inside a solid. A path ends where the kind it draws is used up.
    std::uint32_t bounces_diffuse = max_bounces, bounces_transmission = max_bounces;
    LightSampling lights = LightSampling::automatic;
    std::string integrator = default_integrator;  ///< a name of integrators()
    Parameters parameters{};                      ///< of the integrator: what its entry states
};

/// Throws UsageError for more than `max_bounces` of any kind, for an unknown integrator, and for parameters that none
/// has or that may not be so.
void check(const PathSettings&);

}  // namespace raycache::tracer
