// The points that all pixels together take in two dimensions of a sampling strategy, and what is known about them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tracer/sampling/measures/union_density.hpp"
#include "tracer/sampling/sampling_strategy.hpp"

namespace raycache::tools {

struct SampleUnion {
    tracer::StrategySettings strategy;
    std::uint32_t first_dimension = 0, second_dimension = 1, copies = 1;
    std::string parameters;  ///< such as "K=2.5 s=2 mu=0.0781"
    std::vector<std::string> warnings;

    std::vector<tracer::FixedPoint2> base;    ///< N points of the sequence
    std::vector<tracer::FixedPoint2> points;  ///< of pixel 0, then of pixel 1, …
    std::optional<double> mu;                 ///< width of the jitter's window; none where it has no window

    double base_hole = 0, union_hole = 0;  ///< side of the largest empty square, torus (see largest_hole.hpp)
    double hole_free_k = 0;                ///< for s = 2
    std::optional<double> discrepancy;     ///< star discrepancy of the base points; none for too many
    std::optional<tracer::UnionDensity>
        density;  ///< in the limit of many pixels; none without a window, and for mu = 0

    /// (N * D*)^(1/2).
    std::optional<double> k_from_discrepancy() const;
};

inline constexpr std::uint64_t max_union_points = std::uint64_t{1} << 22;

/// Pixels 0 … copies-1 of the smallest square picture that holds them. Throws UsageError for no copy, for more than
/// `max_union_points` points, for a dimension that the sequence lacks, and as SamplingStrategy does.
SampleUnion make_sample_union(tracer::StrategySettings, std::uint32_t first_dimension, std::uint32_t second_dimension,
                              std::uint64_t copies);

/// What a person wants to know first, as a text; everything except the points as JSON; the points as CSV.
std::string to_text(const SampleUnion&);
std::string to_json(const SampleUnion&);
std::string to_csv(const SampleUnion&);

}  // namespace raycache::tools
