// From traces to series: every launch of every trace, through every GPU. A trace is a file, or a capture made on the
// fly; both hand the same warps to the same replay, so both give the same numbers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/timed_report.hpp"
#include "tracer/capture.hpp"

namespace raycache::tools {

/// One series per file and GPU, files first. Throws Error as traces::Reader does.
std::vector<cachesim::Series> replay_files(const std::vector<std::string>& paths, const std::vector<cachesim::Gpu>&);

/// The same in time.
std::vector<cachesim::TimedSeries> replay_files_timed(const std::vector<std::string>& paths,
                                                      const std::vector<cachesim::Gpu>&,
                                                      const cachesim::Idealised& = {});

/// replay_files() without files: captures and replays launch by launch.
std::vector<cachesim::Series> replay_captures(const std::vector<std::unique_ptr<tracer::Capture>>&,
                                              const std::vector<cachesim::Gpu>&);
std::vector<cachesim::TimedSeries> replay_captures_timed(const std::vector<std::unique_ptr<tracer::Capture>>&,
                                                         const std::vector<cachesim::Gpu>&,
                                                         const cachesim::Idealised& = {});

}  // namespace raycache::tools
