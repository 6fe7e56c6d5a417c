// The steady state itself, of a picture so small that all of it can be replayed: every sample index, launch after
// launch, through one replay that is never cleared.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "tools/jobs/observer.hpp"
#include "tools/jobs/replay_launches.hpp"
#include "tools/jobs/windows/launch_extent.hpp"
#include "tools/jobs/windows/windowed_case.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::tools {

/// Modelled seconds of CPU.
double steady_cost(const std::vector<WindowedStrategy>&, const std::vector<cachesim::Gpu>&);
/// Tells the observer what it will take.
void expect_steady(const std::vector<WindowedStrategy>&, const std::vector<cachesim::Gpu>&, Observer&);

/// What a walk through a steady state calls.
struct SteadyWalk {
    std::function<void(std::uint32_t launch, std::uint32_t warps)> push;  ///< the first `warps` of that launch
    std::function<void()> count_from_here, count_until_here;
};
/// Calls them in order: the last launches uncounted (six, or as many as make nine waves), all of the picture (in several
/// rounds where that is less than four waves), and a wave that keeps the GPU busy. `wave`: wave_warps().
void walk_steady(const LaunchExtent&, std::uint32_t wave, const SteadyWalk&);

struct SteadyState {
    Predicted result;
    std::vector<Json> traces;  ///< trace_json() of each strategy
};

/// Both replays of all N sample indices of each strategy, walk_steady() through every GPU; strategies first. Each
/// series has one "launch", all N together, and WindowSample::all_indices. The stage of the observer is "all samples".
/// Throws Error as both replays do.
SteadyState replay_steady(const tracer::PreparedScene&, const std::vector<WindowedStrategy>&,
                          const std::vector<cachesim::Gpu>&, Observer&);

}  // namespace raycache::tools
