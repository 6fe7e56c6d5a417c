#include "tools/jobs/costs.hpp"

#include <algorithm>

#include "cachesim/report/explanation.hpp"

namespace raycache::tools {
namespace {

constexpr double trace_ray = 1.8e-6, replay_ray = 2e-6, timed_ray = 40e-6;  ///< seconds

/// Of a path in a scene that is neither open nor closed: camera ray, then bounce rays with their shadow rays.
double rays_of(double paths, std::uint32_t bounces) { return paths * (1 + 1.25 * std::min(bounces, 16U)); }

double rays_of(const tracer::CaptureSettings& s) {
    const std::uint64_t paths = std::uint64_t{s.width} * s.height * std::min(s.trace_samples, s.strategy.samples.spp);
    return rays_of(static_cast<double>(paths), s.paths.bounces);
}

}  // namespace

double load_cost(std::uint64_t file_bytes, std::uint64_t triangles) {
    return 0.01 + 30e-9 * static_cast<double>(file_bytes) + 1.5e-6 * static_cast<double>(triangles);
}

double read_cost(std::uint64_t trace_bytes) { return 30e-9 * static_cast<double>(trace_bytes); }

double render_cost(std::uint64_t paths, std::uint32_t bounces) {
    return 1.0e-6 * rays_of(static_cast<double>(paths), bounces);
}

double trace_cost(const tracer::CaptureSettings& settings) { return trace_ray * rays_of(settings); }

double replay_cost(const tracer::CaptureSettings& settings, bool timed) {
    return (timed ? timed_ray : replay_ray) * rays_of(settings);
}

double window_cost(std::uint32_t bounces, double traced, double replayed, double timed) {
    return trace_ray * rays_of(traced, bounces) + replay_ray * rays_of(replayed, bounces) +
           timed_ray * rays_of(timed, bounces);
}

double explain_cost(const tracer::CaptureSettings& settings, bool timed) {
    const auto replays = static_cast<double>(cachesim::idealised_replays().size());
    return 2 * replay_cost(settings, false) + (timed ? replays * replay_cost(settings, true) : 0);
}

}  // namespace raycache::tools
