// Heat maps as a picture with titles, scales and units.
#pragma once

#include "tools/heat_map.hpp"
#include "tracer/image.hpp"

namespace raycache::tools {

/// Three rows of three panels: base, other, and how they differ (other minus base, blurred). The first two share one
/// scale for each quantity, from the 1st to the 99th percentile of both. Both maps have the same size.
tracer::ScreenImage draw(const HeatMap& base, const HeatMap& other);

}  // namespace raycache::tools
