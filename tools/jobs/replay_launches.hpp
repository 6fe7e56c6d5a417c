// From traces to series: every launch of every trace, through every GPU. A trace is a file, or a capture made on the
// fly; both hand the same warps to the same replay, so both give the same numbers.
#pragma once

#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "cachesim/report/profiler.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/timed_report.hpp"
#include "tools/jobs/launch_source.hpp"
#include "tools/jobs/observer.hpp"

namespace raycache::tools {

/// What a series of this source and GPU is of.
cachesim::Origin origin_of(const LaunchSource&, const cachesim::Gpu&);

/// One series per source and GPU, sources first. The stage of the observer is "replay". Throws Error as traces::Reader
/// does.
std::vector<cachesim::Series> replay(const std::vector<LaunchSource>&, const std::vector<cachesim::Gpu>&, Observer&);

/// Both replays of the same warps, series by series in the same order.
struct Predicted {
    std::vector<cachesim::TimedSeries> times;
    std::vector<cachesim::Series> traffic;
};
Predicted predict(const std::vector<LaunchSource>&, const std::vector<cachesim::Gpu>&, Observer&);

/// With what a profiler's metrics need; `timed`: in time, too.
std::vector<cachesim::ProfiledSeries> profile(const std::vector<LaunchSource>&, const std::vector<cachesim::Gpu>&,
                                              bool timed, Observer&);

/// In time alone.
std::vector<cachesim::TimedSeries> replay_timed(const std::vector<LaunchSource>&, const std::vector<cachesim::Gpu>&,
                                                Observer&, const cachesim::Idealised& = {});

}  // namespace raycache::tools
