// Point sets drawn as the paper's Figure 2: all copies in one unit square, each sample index in a colour of its own.
#pragma once

#include <string>
#include <vector>

#include "tools/jobs/samples_union.hpp"
#include "tracer/image.hpp"

namespace raycache::tools {

struct SamplesPanel {
    std::string title;
    const SampleUnion* samples;
};

/// Panels in rows of two, x to the right, y upwards. The base points are black crosses. Below each panel: mu, and the
/// share of the square that no pixel ever samples.
tracer::ScreenImage draw_samples(const std::string& title, const std::vector<SamplesPanel>&);

}  // namespace raycache::tools
