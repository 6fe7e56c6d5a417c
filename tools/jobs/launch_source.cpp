#include "tools/jobs/launch_source.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <utility>

#include "cachesim/report/origin.hpp"
#include "tools/jobs/make_ahead.hpp"
#include "traces/error.hpp"
#include "traces/read_launch.hpp"

namespace raycache::tools {
namespace {

using Warps = std::vector<traces::WarpTrace>;

auto hand_to(const WarpSink& sink) {
    return [&sink](Warps&& warps) {
        for (traces::WarpTrace& warp : warps) sink(std::move(warp));
    };
}

void read_ahead(const traces::Reader& reader, std::uint32_t launch, const WarpSink& sink) {
    const auto [begin, end] = traces::blocks_of(reader, launch);
    make_ahead(
        end - begin,
        [&reader, first = begin](std::size_t i) {
            Warps warps;
            reader.read_block(first + i, warps);
            return warps;
        },
        hand_to(sink));
}

/// Traces the warps of a launch kernel by kernel, in parts.
void trace_ahead(const tracer::Capture& capture, std::uint32_t launch, const WarpSink& sink) {
    constexpr std::uint32_t part_warps = 16;
    const auto wavefront = capture.is_wavefront() ? capture.begin_wavefront(launch) : nullptr;
    const traces::Header& header = capture.header();
    const std::uint32_t per_kernel = header.warps_per_kernel();
    tbb::enumerable_thread_specific<std::unique_ptr<tracer::Capture::Worker>> workers(
        [&capture] { return capture.make_worker(); });
    for (std::uint32_t first = 0; first < header.warps_per_launch; first += per_kernel) {
        if (wavefront && first != 0) wavefront->end_kernel();
        make_ahead((per_kernel + part_warps - 1) / part_warps,
                   [&](std::size_t part) {
                       tracer::Capture::Worker& worker = *workers.local();
                       const auto begin = static_cast<std::uint32_t>(part) * part_warps;
                       Warps warps(std::min(part_warps, per_kernel - begin));
                       for (std::uint32_t i = 0; i < warps.size(); ++i) {
                           const std::uint32_t warp = first + begin + i;
                           if (wavefront)
                               wavefront->trace_warp(worker, begin + i, warps[i]);
                           else
                               capture.trace_warp(worker, launch, warp, warps[i]);
                           warps[i].launch = launch;
                           warps[i].warp = warp;
                       }
                       return warps;
                   },
                   hand_to(sink));
    }
}

}  // namespace

TraceFiles::TraceFiles(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) {
        readers.push_back(std::make_unique<traces::Reader>(path));
        const traces::Reader* reader = readers.back().get();
        sources.push_back({&reader->header(), tracer::strategy_name(reader->header().provenance),
                           [reader](std::uint32_t launch, const WarpSink& sink) { read_ahead(*reader, launch, sink); },
                           cachesim::indices_per_launch(reader->header().provenance.thread_map)});
    }
}

std::vector<LaunchSource> sources_of(const std::vector<std::unique_ptr<tracer::Capture>>& captures) {
    std::vector<LaunchSource> sources;
    for (const auto& owned : captures) {
        const tracer::Capture* capture = owned.get();
        sources.push_back(
            {&capture->header(), tracer::strategy_name(capture->header().provenance),
             [capture](std::uint32_t launch, const WarpSink& sink) { trace_ahead(*capture, launch, sink); },
             cachesim::indices_per_launch(capture->header().provenance.thread_map)});
    }
    return sources;
}

JoinedLaunches::JoinedLaunches(LaunchSource of, std::uint32_t count) : header(*of.header), source(of) {
    const auto launches = static_cast<std::uint32_t>(header.launches.size());
    const std::uint32_t warps = header.warps_per_launch;
    header.launches.clear();
    for (std::uint32_t i = 0; i < launches; i += count) header.launches.push_back(of.header->launches[i]);
    header.warps_per_launch *= std::min(count, launches);
    header.kernels_per_launch *= std::min(count, launches);
    source.header = &header;
    source.indices = of.indices * count;
    source.deliver = [of = std::move(of), count, launches, warps](std::uint32_t launch, const WarpSink& sink) {
        const std::uint32_t begin = launch * count, end = std::min(begin + count, launches);
        for (std::uint32_t i = begin; i < end; ++i)
            of.deliver(i, [&](traces::WarpTrace&& warp) {
                warp.launch = launch;
                warp.warp += (i - begin) * warps;
                sink(std::move(warp));
            });
    };
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
