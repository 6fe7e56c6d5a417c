// The two strategies, or traces, of an explanation: whether one can be held against the other, and what tables call
// them.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/report/explanation.hpp"
#include "tracer/strategy_name.hpp"
#include "traces/header.hpp"

namespace raycache::tools {

struct ExplainedSide {
    const traces::Header* header = nullptr;
    tracer::StrategyName strategy;  ///< what tables call it
    std::string name;               ///< of the file or strategy, for messages
};
using ExplainedPair = std::array<ExplainedSide, 2>;  ///< base, other

/// All but what replays find. Throws Error unless the two are of the same scene, view and sample indices.
cachesim::Explanation begin_explanation(const ExplainedPair&, const cachesim::Gpu&, cachesim::GroupBy);

/// Makes room for all idealised replays of that number of launches, or says why no time is predicted.
void predict_speed_ups(cachesim::Explanation&, const cachesim::Gpu&, std::size_t launches);

}  // namespace raycache::tools
