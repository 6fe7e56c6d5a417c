// A picture by the same integrator and sampling that captures use; Embree walks the rays, for nothing is recorded.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "tracer/image.hpp"
#include "tracer/paths/path_settings.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/sampling/sampling_strategy.hpp"

namespace raycache::tracer {

struct RenderSettings {
    std::uint32_t width = 512, height = 512;  ///< pixels
    PathSettings paths;
    StrategySettings strategy;  ///< all N = strategy.samples.spp samples are taken
    /// No channel of one sample's radiance above this: brighter samples are scaled down, their colour kept. None: no
    /// clamp. It biases the picture, darker, and takes fireflies away.
    std::optional<float> clamp{};
};

/// Throws UsageError unless there is no clamp or it is finite and above 0.
void check_clamp(std::optional<float>);

/// Runs on all threads of the current TBB arena; the picture does not depend on their number. `progress` is called from
/// any thread with the number of paths finished since the last call.
Image render(const PreparedScene&, const RenderSettings&, const std::function<void(std::uint64_t paths)>& progress);

}  // namespace raycache::tracer
