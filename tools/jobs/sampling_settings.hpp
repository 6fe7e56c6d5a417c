// Which paths a job traces, and by which samples.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/jobs/scene_settings.hpp"
#include "tracer/capture.hpp"
#include "tracer/strategy_name.hpp"

namespace raycache::tools {

/// Paths and samples of all cases of a job, as a user types them.
struct SamplingSettings {
    std::string resolution = "512x512";
    std::uint32_t bounces = 3;
    std::optional<std::uint32_t> bounces_diffuse, bounces_transmission;  ///< absent: all
    std::string lights = "auto";                                         ///< auto, bsdf, nee, mis
    bool russian_roulette = false;
    std::string integrator = tracer::default_integrator;  ///< a name of integrators()
    /// Of integrator_parameters(), by name; empty: not given.
    std::map<std::string, std::string> integrator_parameters;

    std::string k = "2.5";  ///< or "discrepancy"
    std::string s = "2";    ///< or "full"
    std::string mu;         ///< empty: from k and s
    double cycles_multiplier = 1;
    std::uint64_t cycles_min_samples = 0;
    std::string cycles_noise_threshold = "0.01";  ///< or "off"
    unsigned interleave = 8;
    std::string share = "first-bounce";       ///< of net-micro-jitter
    std::optional<std::uint32_t> share_bits;  ///< absent: as many as are free
    std::vector<std::string> parameters;      ///< "NAME=VALUE" of any parameter; rule over the members above
    std::uint64_t seed = 1;

    std::uint64_t trace_samples = 8;
    std::string thread_map;                                ///< of a case whose strategy names none; empty: its own
    std::string execution = "megakernel", order = "none";  ///< of a case whose strategy names no order

    /// Throws UsageError for values out of range.
    tracer::PathSettings paths() const;
    tracer::StrategySettings strategy(const std::string& sequence, const std::string& decorrelation,
                                      std::uint64_t spp) const;
};

/// One of the cases that a job compares.
struct CaseSettings {
    tracer::StrategyName strategy;
    std::string sequence = "sobol";
    std::uint64_t spp = 64;  ///< N
    std::string k, mu;       ///< instead of SamplingSettings'; empty: those
};

/// The scene, in the case's layout where it names one.
SceneSettings of_case(SceneSettings, const CaseSettings&);
/// What all cases have in common, with what this one has instead.
SamplingSettings of_case(SamplingSettings, const CaseSettings&);

/// What the tracer is asked for. Throws UsageError for a name that is none and values out of range.
tracer::CaptureSettings capture_settings(const SceneSettings&, const SamplingSettings&, const CaseSettings&);
std::vector<tracer::CaptureSettings> capture_settings(const SceneSettings&, const SamplingSettings&,
                                                      const std::vector<CaseSettings>&);

/// Warns of what the strategies have to say about their settings, such as "mu 1.58 clamped to 1 …"
/// (SamplingStrategy::warnings()), each line once.
void warn_of_strategies(const std::vector<tracer::CaptureSettings>&, Observer&);

struct Resolution {
    std::uint32_t width, height;
};
/// "512x512". Throws UsageError.
Resolution parse_resolution(const std::string&);

}  // namespace raycache::tools
