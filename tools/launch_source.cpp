#include "tools/launch_source.hpp"

#include <utility>

#include "traces/read_launch.hpp"

namespace raycache::tools {

TraceFiles::TraceFiles(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) {
        readers.push_back(std::make_unique<traces::Reader>(path));
        const traces::Reader* reader = readers.back().get();
        sources.push_back({&reader->header(), [reader](std::uint32_t launch, const WarpSink& sink) {
                               traces::read_launch(*reader, launch, sink);
                           }});
    }
}

std::vector<LaunchSource> sources_of(const std::vector<std::unique_ptr<tracer::Capture>>& captures) {
    std::vector<LaunchSource> sources;
    for (const auto& owned : captures) {
        const tracer::Capture* capture = owned.get();
        sources.push_back({&capture->header(), [capture](std::uint32_t launch, const WarpSink& sink) {
                               const auto worker = capture->make_worker();
                               for (std::uint32_t warp = 0; warp < capture->header().warps_per_launch; ++warp) {
                                   traces::WarpTrace trace;
                                   capture->trace_warp(*worker, launch, warp, trace);
                                   sink(std::move(trace));
                               }
                           }});
    }
    return sources;
}

std::uint64_t count_rays(const traces::WarpTrace& warp) {
    std::uint64_t rays = 0;
    for (const traces::Record& record : warp.records)
        if (!record.is_access()) rays += record.lanes();
    return rays;
}

}  // namespace raycache::tools
