// A strategy whose blocks of sample indices are traced in windows.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/jobs/launches.hpp"
#include "tools/jobs/windows/window_plan.hpp"
#include "tracer/capture.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::tools {

struct WindowedStrategy {
    tracer::CaptureSettings capture;
    tracer::StrategyName given;  ///< as the user named it, for tables
    std::string layout = tracer::default_layout;
};
std::vector<WindowedStrategy> strategies_of(const LaunchSettings&);
/// Sample indices that blocks of all of them are multiples of: as many as the largest launch has.
std::uint32_t common_indices(const std::vector<WindowedStrategy>&);

struct WindowedCase {
    std::string name;
    WindowPlan plan;
    std::vector<std::uint32_t> first;  ///< sample index of each block
    std::unique_ptr<tracer::Capture> capture;

    std::uint32_t first_launch(std::size_t block) const { return static_cast<std::uint32_t>(block * plan.launches()); }
    /// trace_json(), with the sample indices of the first `blocks` blocks.
    Json subject(std::uint32_t blocks) const;
};

/// `drawing`: another number, other blocks and places of the same samples. `grain`: common_indices() of all strategies.
WindowedCase make_case(const tracer::PreparedScene&, const WindowedStrategy&, const WindowSizes&, std::uint64_t drawing,
                       std::uint32_t blocks, std::uint32_t grain);

}  // namespace raycache::tools
