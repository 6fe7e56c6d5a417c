// What `raycache samples` prints of one strategy's samples.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/samples_picture.hpp"
#include "tracer/sampling/measures/coverage.hpp"
#include "tracer/sampling/sampling_strategy.hpp"

namespace raycache::tools {

struct SamplesRequest {
    tracer::StrategySettings strategy;
    std::uint32_t copies = 150;           ///< pixels whose samples are taken
    std::uint32_t first = 0, second = 1;  ///< dimensions
};
/// Points of all copies together.
inline constexpr std::uint64_t max_shown_samples = std::uint64_t{1} << 20;

struct SamplesReport {
    tracer::StrategySettings strategy;
    std::uint32_t copies = 0, first = 0, second = 0;
    std::string parameters, warning;
    double star_discrepancy = 0;  ///< of the base points
    double base_hole = 0;         ///< side of the largest empty square between the base points, modulo 1
    double copies_hole = 0;       ///< the same between the samples of all copies
    /// For strategies that keep each sample in a window around its base point: side of the window, and how the windows
    /// cover the square (where N is small enough to say).
    std::optional<double> mu;
    std::optional<tracer::Coverage> coverage;
    SamplePanel panel;  ///< base points and samples

    /// Of the base points: the least that leaves no hole, and (N D*)^(1/2) as the paper's eq. 2 may be read.
    double hole_free_k() const { return tracer::hole_free_k(base_hole, strategy.parameters.spp, 2); }
    double discrepancy_k() const;
};

/// Throws UsageError for settings out of range.
SamplesReport sample(const SamplesRequest&);

std::string to_text(const SamplesReport&);
std::string to_json(const SamplesReport&);
/// "copy,index,x,y" and a line for every sample.
std::string to_csv(const SamplesReport&);

}  // namespace raycache::tools
