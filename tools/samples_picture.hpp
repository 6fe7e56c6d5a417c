// The paper's Figure 2 for any strategy: where the samples of many pixels lie.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tracer/image.hpp"
#include "tracer/sampling/measures/star_discrepancy.hpp"

namespace raycache::tools {

/// The unit square with the samples of all copies in it.
struct SamplePanel {
    std::string title, subtitle;
    std::vector<tracer::FixedPoint2> points;
    std::vector<std::uint32_t> index;       ///< sample index of each point
    std::vector<tracer::FixedPoint2> base;  ///< middles of the windows
    double mu = 1;                          ///< side of the windows; what none of them covers is shaded as a hole
};

/// Panels side by side, two in a row. Points are coloured by sample index, of `n`.
tracer::ScreenImage draw_samples(const std::vector<SamplePanel>&, std::uint64_t n);

}  // namespace raycache::tools
