// Heat maps as a picture with titles, scales and units.
#pragma once

#include <string>

#include "tools/heat_map.hpp"
#include "tracer/image.hpp"

namespace raycache::tools {

/// Three rows of three panels: base, other, and how they differ (other minus base, blurred). The first two share one
/// scale for each quantity, from the 1st to the 99th percentile of both. Both maps have the same size.
/// `title`: one line above all.
tracer::ScreenImage draw(const std::string& title, const HeatMap& base, const HeatMap& other);

}  // namespace raycache::tools
