// The generator matrices of the Sobol sequence, for every sequence built on it.
#pragma once

#include <vector>

#include "tracer/sampling/digital_net.hpp"

namespace raycache::tracer {

/// Direction numbers of dimensions 0 … 1023, from the table of S. Joe and F. Y. Kuo (2008), file new-joe-kuo-6.
/// Dimension 0 is the van der Corput sequence in base 2. Computed once.
const std::vector<DirectionNumbers>& sobol_directions();

}  // namespace raycache::tracer
