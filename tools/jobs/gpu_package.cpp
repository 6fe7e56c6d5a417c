#include "tools/jobs/gpu_package.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "tools/gpu/package/package.hpp"
#include "tracer/bvh/layouts/memory.hpp"
#include "tracer/simt/ray_log.hpp"
#include "traces/error.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::tools {
namespace {

/// A launch as sections of its file.
struct PackedLaunch {
    std::vector<gpu::Batch> batches;
    std::vector<gpu::PackedRay> rays;
    std::vector<gpu::Hit> hits;
    std::vector<std::uint32_t> hole_firsts, hole_triangles;
};

static_assert(gpu::no_triangle == tracer::no_triangle);

PackedLaunch pack(const tracer::RayLog& log, const tracer::RayHits& hits) {
    PackedLaunch packed;
    packed.batches.reserve(log.batches.size());
    for (std::size_t b = 0; b < log.batches.size(); ++b) {
        const tracer::RayBatch& batch = log.batches[b];
        packed.batches.push_back({hits.masks[b], static_cast<std::uint32_t>(batch.first), batch.warp,
                                  static_cast<std::uint8_t>(batch.type), batch.bounce, 0});
    }
    packed.rays.reserve(log.rays.size());
    packed.hits.reserve(log.rays.size());
    packed.hole_firsts.reserve(log.rays.size() + 1);
    packed.hole_firsts.push_back(0);
    auto hole = hits.holes.begin();
    for (std::size_t i = 0; i < log.rays.size(); ++i) {
        const tracer::Ray& ray = log.rays[i];
        packed.rays.push_back({{ray.origin.x, ray.origin.y, ray.origin.z},
                               ray.t_min,
                               {ray.direction.x, ray.direction.y, ray.direction.z},
                               ray.t_max});
        packed.hits.push_back({log.ends[i], hits.triangles[i]});
        for (; hole != hits.holes.end() && hole->ray == i; ++hole) packed.hole_triangles.push_back(hole->triangle);
        packed.hole_firsts.push_back(static_cast<std::uint32_t>(packed.hole_triangles.size()));
    }
    return packed;
}

void check_room(const tracer::RayLog& log, const tracer::RayHits& hits, const std::string& scene) {
    constexpr std::uint64_t most = 0xffffffff;
    if (log.rays.size() > most || hits.holes.size() > most)
        throw Error(
            fmt::format("{}: a replay package: expected fewer than 2^32 rays a launch, found {}; choose a "
                        "smaller resolution",
                        scene, log.rays.size()));
    MemoryBudget().check(log.bytes() + hits.bytes() + log.rays.size() * 64, scene, "the rays of a launch");
}

}  // namespace

void check_gpu_package(const tracer::CaptureSettings& settings) {
    if (!tracer::integrator_entry(settings.paths.integrator).walks_bvh)
        throw UsageError(
            fmt::format("--gpu-package with integrator {}: it sends no ray through a BVH; expected another "
                        "--integrator",
                        settings.paths.integrator));
}

GpuPackageFolder::GpuPackageFolder(std::string folder) : folder_(std::move(folder)) {
    std::error_code error;
    made_ = std::filesystem::create_directory(folder_, error);
    if (error || !std::filesystem::is_directory(folder_, error))
        throw Error(
            fmt::format("{}: a replay package: expected a folder or room for a new one, found {}; name another "
                        "folder",
                        folder_, error ? fmt::format("\"{}\"", error.message()) : std::string("a file")));
}

GpuPackageFolder::~GpuPackageFolder() {
    std::error_code error;
    if (made_ && !filled_) std::filesystem::remove(folder_, error);  // if it is empty
}

std::string GpuPackageFolder::last_file() const { return gpu::package_files(folder_, 0).back(); }

std::uint64_t GpuPackageFolder::write(const tracer::Capture& capture, const Json& trace, const Stage& stage) {
    const tracer::PreparedScene& scene = capture.scene();
    const traces::Header& header = capture.header();
    const tracer::LayoutMemory memory = tracer::layout_memory(scene.bvh());
    const gpu::BvhPart bvh{memory.nodes, memory.triangles};
    gpu::PackageHead head;
    head.launches = static_cast<std::uint32_t>(header.launches.size());
    head.tree = gpu::tree_kind(memory.tree);
    head.wavefront = capture.is_wavefront();
    head.provenance = trace.dump();
    gpu::identify(head, bvh);
    std::uint64_t rays = 0;
    for (std::uint32_t launch = 0; launch < head.launches; ++launch) {
        tracer::RayHits hits;
        const tracer::RayLog log = tracer::log_rays(capture, launch, &hits);
        check_room(log, hits, scene.scene().name);
        const PackedLaunch packed = pack(log, hits);
        gpu::write_launch(
            folder_, head,
            {launch, header.launches[launch], head.wavefront ? header.warps_per_kernel() : header.warps_per_launch},
            {packed.batches, packed.rays, packed.hits, packed.hole_firsts, packed.hole_triangles});
        filled_ = true;
        stage.add(header.warps_per_launch, log.rays.size());
        rays += log.rays.size();
    }
    gpu::write_bvh_part(folder_, head, bvh);
    return rays;
}

}  // namespace raycache::tools
