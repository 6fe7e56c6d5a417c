#include "tools/jobs/launch_source.hpp"

#include <fmt/format.h>

#include <utility>

#include "traces/error.hpp"
#include "traces/read_launch.hpp"

namespace raycache::tools {

TraceFiles::TraceFiles(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) {
        readers.push_back(std::make_unique<traces::Reader>(path));
        const traces::Reader* reader = readers.back().get();
        sources.push_back(
            {&reader->header(), tracer::strategy_name(reader->header().provenance),
             [reader](std::uint32_t launch, const WarpSink& sink) { traces::read_launch(*reader, launch, sink); }});
    }
}

std::vector<LaunchSource> sources_of(const std::vector<std::unique_ptr<tracer::Capture>>& captures) {
    std::vector<LaunchSource> sources;
    for (const auto& owned : captures) {
        const tracer::Capture* capture = owned.get();
        sources.push_back({&capture->header(), tracer::strategy_name(capture->header().provenance),
                           [capture](std::uint32_t launch, const WarpSink& sink) {
                               const auto worker = capture->make_worker();
                               capture->trace_launch(*worker, launch, sink);
                           }});
    }
    return sources;
}

void refuse_wavefront(const traces::Header& header, const std::string& path, const char* command) {
    if (header.kernels_per_launch == 1) return;
    throw UsageError(
        fmt::format("{}: trace of a wavefront ({} kernels a launch); 'raycache {}' expects one of a megakernel, whose "
                    "warps keep their rays from the camera on; use replay or compare, or capture it with --execution "
                    "megakernel",
                    path, header.kernels_per_launch, command));
}

std::uint64_t count_rays(const traces::WarpTrace& warp) {
    std::uint64_t rays = 0;
    for (const traces::Record& record : warp.records)
        if (!record.is_access()) rays += record.lanes();
    return rays;
}

}  // namespace raycache::tools
