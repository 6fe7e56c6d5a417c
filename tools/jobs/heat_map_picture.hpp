// Heat maps as a picture with titles, scales and units.
#pragma once

#include <string>

#include "tools/jobs/heat_map.hpp"
#include "tracer/image.hpp"

namespace raycache::tools {

/// Three rows of three panels: base, other, and how they differ (other minus base, blurred). The first two share one
/// scale for each quantity, from the 1st to the 99th percentile of both. Both maps have the same size.
/// Under each scale stand its unit and, for a difference, which colour is better. `title`: above all. Texts are broken
/// into lines where they are too long.
tracer::ScreenImage draw(const std::string& title, const HeatMap& base, const HeatMap& other);

}  // namespace raycache::tools
