#include "tracer/simt/ray_log.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <memory>
#include <random>

#include "tracer/simt/make_traversal.hpp"
#include "traces/shuffle.hpp"

namespace raycache::tracer {
namespace {

constexpr float never = std::numeric_limits<float>::infinity();

/// Writes down every ray that another traversal walks.
class LoggingTraversal final : public Traversal {
public:
    explicit LoggingTraversal(const PreparedScene& scene) : walk_(make_traversal(scene, nothing_)) {}

    /// Where the next warp goes; must outlive its walk.
    void begin(RayLog& log, std::uint32_t warp) {
        log_ = &log;
        warp_ = warp;
    }

    void closest(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays, Hit* hits) override {
        walk_->closest(mask, type, bounce, rays, hits);
        add(mask, type, bounce, rays, [&](unsigned l) { return hits[l].found() ? hits[l].t : never; });
    }
    std::uint32_t occluded(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays) override {
        const std::uint32_t blocked = walk_->occluded(mask, type, bounce, rays);
        add(mask, type, bounce, rays, [&](unsigned l) { return (blocked >> l & 1U) != 0 ? 0 : never; });
        return blocked;
    }
    void read_texels(std::uint32_t, traces::RayType, std::uint8_t, const std::uint32_t*) override {}

private:
    template <class End>
    void add(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays, const End& end) {
        log_->batches.push_back(
            {warp_, type, bounce, static_cast<std::uint32_t>(std::popcount(mask)), log_->rays.size()});
        for (; mask != 0; mask &= mask - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(mask));
            log_->rays.push_back(rays[l]);
            log_->ends.push_back(end(l));
        }
    }

    NullRecorder nothing_;
    std::unique_ptr<Traversal> walk_;
    RayLog* log_ = nullptr;
    std::uint32_t warp_ = 0;
};

struct LogWorker {
    explicit LogWorker(const Capture& capture)
        : traversal(capture.scene()),
          integrator(
              integrator_entry(capture.settings().paths.integrator)
                  .make({capture.scene().scene(), capture.camera(), capture.scene().lights(), capture.scene().texels(),
                         capture.strategy(), capture.settings().paths, traversal, capture.integrator_data()})) {}
    LogWorker(const LogWorker&) = delete;  // its parts point at each other

    LoggingTraversal traversal;
    std::unique_ptr<Integrator> integrator;
};

void append(RayLog& log, const RayLog& part) {
    const std::uint64_t first = log.rays.size();
    log.rays.insert(log.rays.end(), part.rays.begin(), part.rays.end());
    log.ends.insert(log.ends.end(), part.ends.begin(), part.ends.end());
    for (RayBatch batch : part.batches) {
        batch.first += first;
        log.batches.push_back(batch);
    }
}

}  // namespace

RayLog log_rays(const Capture& capture, std::uint32_t launch) {
    constexpr std::uint32_t part_warps = 64;
    const std::uint32_t warps = capture.header().warps_per_launch;
    std::vector<RayLog> parts((warps + part_warps - 1) / part_warps);
    tbb::enumerable_thread_specific<std::unique_ptr<LogWorker>> workers(
        [&] { return std::make_unique<LogWorker>(capture); });
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
        LogWorker& worker = *workers.local();
        const auto first = static_cast<std::uint32_t>(part) * part_warps;
        const std::uint32_t end = std::min(first + part_warps, warps);
        for (std::uint32_t warp = first; warp != end; ++warp) {
            std::array<PathLane, traces::warp_lanes> jobs;
            std::array<Vec3, traces::warp_lanes> radiance;
            worker.traversal.begin(parts[part], warp);
            const std::uint32_t mask = capture.lane_jobs(launch, warp, jobs);
            if (mask != 0) worker.integrator->trace(mask, jobs, radiance);
        }
    });
    RayLog log;
    std::size_t rays = 0, batches = 0;
    for (const RayLog& part : parts) {
        rays += part.rays.size();
        batches += part.batches.size();
    }
    log.rays.reserve(rays);
    log.ends.reserve(rays);
    log.batches.reserve(batches);
    for (RayLog& part : parts) {
        append(log, part);
        part = {};
    }
    return log;
}

RayLog only(const RayLog& log, const std::function<bool(const RayBatch&)>& is_wanted) {
    RayLog out;
    for (RayBatch batch : log.batches) {
        if (!is_wanted(batch)) continue;
        const auto first = static_cast<std::ptrdiff_t>(batch.first), end = first + batch.count;
        batch.first = out.rays.size();
        out.batches.push_back(batch);
        out.rays.insert(out.rays.end(), log.rays.begin() + first, log.rays.begin() + end);
        out.ends.insert(out.ends.end(), log.ends.begin() + first, log.ends.begin() + end);
    }
    return out;
}

RayLog shuffled(const RayLog& log, std::uint64_t seed) {
    std::vector<std::uint64_t> places[2];
    for (const RayBatch& batch : log.batches)
        for (std::uint64_t i = 0; i < batch.count; ++i) places[batch.any_hit() ? 1 : 0].push_back(batch.first + i);
    RayLog out = log;
    std::mt19937_64 random(seed);
    for (const auto& from : places) {
        std::vector<std::uint64_t> to = from;
        shuffle_by(to, [&](std::size_t n) { return random() % n; });
        for (std::size_t i = 0; i < from.size(); ++i) {
            out.rays[to[i]] = log.rays[from[i]];
            out.ends[to[i]] = log.ends[from[i]];
        }
    }
    return out;
}

}  // namespace raycache::tracer
