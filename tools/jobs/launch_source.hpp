// Where launches come from: a trace file, or a capture made on the fly. Both hand over the same warps.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tracer/capture.hpp"
#include "tracer/strategy_name.hpp"
#include "traces/header.hpp"
#include "traces/reader.hpp"
#include "traces/record.hpp"

namespace raycache::tools {

/// Hands over the warps of one launch, in order, one at a time. They are decoded or traced ahead by threads of the TBB
/// arena that are free, so the sink may be called on another thread than the warp before.
using WarpSink = std::function<void(traces::WarpTrace&&)>;

struct LaunchSource {
    const traces::Header* header;
    tracer::StrategyName strategy;                                       ///< what tables call it
    std::function<void(std::uint32_t launch, const WarpSink&)> deliver;  ///< thread-safe
    std::uint32_t indices = 1;  ///< sample indices of every pixel in a launch (Origin::indices)
};

/// Opens trace files and keeps them open. Throws Error as traces::Reader does.
struct TraceFiles {
    explicit TraceFiles(const std::vector<std::string>& paths);
    std::vector<std::unique_ptr<traces::Reader>> readers;
    std::vector<LaunchSource> sources;
};

/// The captures must outlive their sources.
std::vector<LaunchSource> sources_of(const std::vector<std::unique_ptr<tracer::Capture>>&);

/// Each `count` launches of a source as one: the warps of one after those of the other, through the same caches, as
/// where a renderer launches so many sample indices in one go. The last has those that are left.
struct JoinedLaunches {
    JoinedLaunches(LaunchSource of, std::uint32_t count);
    JoinedLaunches(const JoinedLaunches&) = delete;
    JoinedLaunches& operator=(const JoinedLaunches&) = delete;

    traces::Header header;  ///< of the first launch of each
    LaunchSource source;    ///< valid as long as this object
};

/// Throws UsageError for a trace of more than one kernel: `command` follows warps through a whole launch.
void refuse_wavefront(const traces::Header&, const std::string& path, const char* command);

std::uint64_t count_rays(const traces::WarpTrace&);

}  // namespace raycache::tools
