// How much longer a command takes: from what its stages were expected to take and what they have taken so far.
#pragma once

#include <span>

#include "tools/jobs/observer.hpp"

namespace raycache::tools {

struct StageState {
    Work work = Work::prepare;
    double expected = 0;   ///< seconds, by the costs of another machine and scene
    double done = 0;       ///< share of the stage, 0 to 1. Stages of preparing do not count: 0 until they are over
    double seconds = 0;    ///< taken so far
    bool running = false;  ///< not over, and not yet to come
};

/// Seconds left of all stages together, never negative. Each kind of work goes on at the pace it has shown, compared
/// with what was expected; a kind not seen yet goes at the pace of all others, of which preparing says nothing.
double time_left(std::span<const StageState> stages);

}  // namespace raycache::tools
