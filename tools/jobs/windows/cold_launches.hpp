// Whole launches beside an estimate of the steady state: the same strategies, each launch from cold caches to its last
// warp.
#pragma once

#include <cstdint>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/report/cold_figures.hpp"
#include "tools/jobs/observer.hpp"
#include "tools/jobs/windows/windowed_case.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::tools {

/// Throws UsageError where a strategy has fewer launches than `count`.
void check_cold_launches(const std::vector<WindowedStrategy>&, std::uint64_t count);

/// Tells the observer what they will take.
void expect_cold_launches(const std::vector<WindowedStrategy>&, std::uint64_t count, const std::vector<cachesim::Gpu>&,
                          bool timed, Observer&);

/// `count` launches of each strategy, of the sample indices that whole launches alone would be of (choose_launches()),
/// through every GPU; strategies first. In time, too, where that is asked for and the GPU's is predicted. The stage of
/// the observer is "cold launches".
std::vector<cachesim::ColdLaunches> replay_cold_launches(const tracer::PreparedScene&,
                                                         const std::vector<WindowedStrategy>&, std::uint64_t count,
                                                         const std::vector<cachesim::Gpu>&, bool timed, Observer&);

}  // namespace raycache::tools
