// The steady state itself, of a picture so small that all of it can be replayed: every sample index, launch after
// launch, through one replay that is never cleared.
#pragma once

#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "tools/jobs/observer.hpp"
#include "tools/jobs/replay_launches.hpp"
#include "tools/jobs/windows/windowed_case.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::tools {

/// Modelled seconds of CPU.
double steady_cost(const std::vector<WindowedStrategy>&, const std::vector<cachesim::Gpu>&);
/// Tells the observer what it will take.
void expect_steady(const std::vector<WindowedStrategy>&, const std::vector<cachesim::Gpu>&, Observer&);

struct SteadyState {
    Predicted result;
    std::vector<Json> traces;  ///< trace_json() of each strategy
};

/// Both replays of all N sample indices of each strategy, through every GPU; strategies first. Each series has one
/// "launch", all N together (where they are less than four waves, in several rounds), and WindowSample::all_indices. Before anything is counted come the last launches: six, or
/// as many as make nine waves. Behind the last one a wave keeps the GPU busy. The stage of the observer is "all
/// samples". Throws Error as both replays do.
SteadyState replay_steady(const tracer::PreparedScene&, const std::vector<WindowedStrategy>&,
                          const std::vector<cachesim::Gpu>&, Observer&);

}  // namespace raycache::tools
