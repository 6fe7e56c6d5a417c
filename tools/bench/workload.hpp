// What all benchmarks run on: one scene, 512x512, 3 bounces, one sample index, one thread.
#pragma once

#include <memory>
#include <string>

#include "tracer/capture.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::bench {

/// Chosen once by --scene=FILE|NAME; default courtyard.
void choose_scene(const std::string& source);
const std::string& scene_name();
const tracer::PreparedScene& scene();

/// One sample index out of N = 1024.
std::unique_ptr<tracer::Capture> make_capture(const std::string& strategy);

/// Seconds of CPU time of this thread: a busy neighbour counts less than on the wall clock.
double thread_seconds();

}  // namespace raycache::bench
