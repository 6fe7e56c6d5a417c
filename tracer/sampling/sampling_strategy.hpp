// A sampling strategy = sequence x decorrelation: the number that pixel p gets for dimension d of sample i.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/sequence.hpp"

namespace raycache::tracer {

/// [0, 1) from 32-bit fixed point. Drops 8 bits: (float)u * 2^-32 would round 128 inputs up to 1.
inline float to_unit_float(std::uint32_t u) { return static_cast<float>(u >> 8) * 0x1p-24F; }

struct StrategySettings {
    std::string sequence = "sobol";
    std::string decorrelation = "micro-jitter";
    SampleSet samples;
    Parameters parameters;  ///< of the decorrelation
    /// q: dimensions 2q and 2q + 1 get what `random` would give them, to see what error a pair of dimensions causes.
    std::optional<std::uint32_t> independent_pair{};
};

class SamplingStrategy {
public:
    /// Fixes the strategy for paths of at most `dimensions` dimensions. Throws UsageError as its parts do, and where
    /// the sequence has too few dimensions or points. Strategies that depend on a pixel's place need samples.width.
    SamplingStrategy(const StrategySettings&, std::uint32_t dimensions);

    /// The base point x_i of one sample index, all dimensions: compute it once per launch, not once per pixel.
    /// Throws UsageError unless index < N.
    std::vector<std::uint32_t> base_point(std::uint64_t index) const;

    /// `base_point(index)[dimension]` moved to where pixel `pixel` wants it.
    std::uint32_t value(std::uint32_t base, std::uint32_t pixel, std::uint32_t index, std::uint32_t dimension) const {
        return decorrelation_->apply(base, pixel, index, dimension);
    }
    const StrategySettings& settings() const { return settings_; }
    std::string parameters() const { return decorrelation_->parameters(); }
    /// Lines for the user about settings that were adjusted or that waste what the sequence offers, such as an N
    /// between two powers of two.
    std::vector<std::string> warnings() const;
    std::uint32_t dimensions() const { return dimensions_; }

private:
    StrategySettings settings_;
    std::uint32_t dimensions_;
    std::unique_ptr<Sequence> sequence_;
    std::unique_ptr<Decorrelation> decorrelation_;
};

/// `count` distinct sample indices out of 0 … spp-1, ascending: a seeded random subset, the same for every strategy.
/// count >= spp gives all of them. Throws UsageError for spp = 0 or above 2^32, for count = 0, and where more than 2^20
/// indices would come out.
std::vector<std::uint32_t> choose_sample_indices(std::uint64_t spp, std::uint64_t count, std::uint64_t seed);

}  // namespace raycache::tracer
