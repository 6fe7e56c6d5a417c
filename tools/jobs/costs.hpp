// What work takes, roughly: how stages of a command compare with each other, for the time left. Only the ratios matter;
// the pace of the machine shows while it works. All in seconds of one thread, of scenes as the built-in ones.
#pragma once

#include <cstdint>

#include "tracer/capture.hpp"

namespace raycache::tools {

double load_cost(std::uint64_t file_bytes, std::uint64_t triangles);  ///< reading or making a scene, and its BVH
double read_cost(std::uint64_t trace_bytes);                          ///< checking a trace
double render_cost(std::uint64_t paths, std::uint32_t bounces);
double trace_cost(const tracer::CaptureSettings&);
double replay_cost(const tracer::CaptureSettings&, bool timed);  ///< through one GPU
/// Of that number of paths: traced, and replayed through one GPU without and with time.
double window_cost(std::uint32_t bounces, double traced, double replayed, double timed);
double explain_cost(const tracer::CaptureSettings&, bool timed);  ///< of one of the two traces

}  // namespace raycache::tools
