// How bright to show a picture.
#pragma once

#include "tracer/image.hpp"

namespace raycache::tools {

/// Stops that bring the log-average luminance to middle grey (Reinhard et al. 2002, eq. 1), taken over means of 16x16
/// pixels: the black pixels of a noisy picture say nothing about its brightness.
float automatic_exposure(const tracer::Image&);

}  // namespace raycache::tools
