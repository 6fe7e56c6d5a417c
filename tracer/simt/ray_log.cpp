#include "tracer/simt/ray_log.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <memory>
#include <random>
#include <utility>

#include "tracer/simt/make_traversal.hpp"
#include "traces/shuffle.hpp"

namespace raycache::tracer {
namespace {

constexpr float never = std::numeric_limits<float>::infinity();

struct LoggedPart {
    RayLog log;
    RayHits hits;
};

/// Writes down every ray that another traversal walks.
class LoggingTraversal final : public Traversal {
public:
    explicit LoggingTraversal(const PreparedScene& scene) : walk_(make_traversal(scene, recorder_)) {}

    /// Where the next warp goes; must outlive its walk.
    void begin(LoggedPart& part, std::uint32_t warp) {
        part_ = &part;
        warp_ = warp;
    }

    void closest(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays, Hit* hits) override {
        recorder_.holes.clear();
        walk_->closest(mask, type, bounce, rays, hits);
        add(mask, type, bounce, rays, [&](unsigned l) {
            return hits[l].found() ? std::pair(hits[l].t, hits[l].triangle) : std::pair(never, no_triangle);
        });
    }
    std::uint32_t occluded(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays) override {
        recorder_.holes.clear();
        const std::uint32_t blocked = walk_->occluded(mask, type, bounce, rays);
        add(mask, type, bounce, rays,
            [&](unsigned l) { return std::pair((blocked >> l & 1U) != 0 ? 0 : never, no_triangle); });
        return blocked;
    }
    void read_texels(std::uint32_t, traces::RayType, std::uint8_t, const std::uint32_t*) override {}

private:
    template <class End>
    void add(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays, const End& end) {
        RayLog& log = part_->log;
        RayHits& hits = part_->hits;
        const auto rank = [mask](std::uint32_t lane) {
            return static_cast<std::uint64_t>(std::popcount(mask & ((1U << lane) - 1)));
        };
        std::stable_sort(recorder_.holes.begin(), recorder_.holes.end(),
                         [](const auto& a, const auto& b) { return a.lane < b.lane; });
        for (const HoleRecorder::Passed& one : recorder_.holes)
            hits.holes.push_back({log.rays.size() + rank(one.lane), one.triangle});
        log.batches.push_back({warp_, type, bounce, static_cast<std::uint32_t>(std::popcount(mask)), log.rays.size()});
        hits.masks.push_back(mask);
        for (; mask != 0; mask &= mask - 1) {
            const auto l = static_cast<unsigned>(std::countr_zero(mask));
            const auto [t, triangle] = end(l);
            log.rays.push_back(rays[l]);
            log.ends.push_back(t);
            hits.triangles.push_back(triangle);
        }
    }

    HoleRecorder recorder_;
    std::unique_ptr<Traversal> walk_;
    LoggedPart* part_ = nullptr;
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

/// A worker of wavefronts, whose walks are logged instead of recorded.
struct WavefrontLogWorker {
    explicit WavefrontLogWorker(const Capture& capture) : worker(capture.make_worker()) {
        auto logging = std::make_unique<LoggingTraversal>(capture.scene());
        log = logging.get();
        unused_walk = std::exchange(worker->traversal, std::move(logging));
    }

    std::unique_ptr<Traversal> unused_walk;  ///< the integrator has a reference to it
    std::unique_ptr<Capture::Worker> worker;
    LoggingTraversal* log;
    traces::WarpTrace unused;
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

void append(RayHits& hits, const RayHits& part) {
    const std::uint64_t first = hits.triangles.size();
    hits.masks.insert(hits.masks.end(), part.masks.begin(), part.masks.end());
    hits.triangles.insert(hits.triangles.end(), part.triangles.begin(), part.triangles.end());
    for (const RayHits::Hole& hole : part.holes) hits.holes.push_back({hole.ray + first, hole.triangle});
}

/// Logs `warps` warps: log_warp(worker, part, warp). Parts are made in parallel and appended in order.
template <class Workers, class LogWarp>
void log_warps(std::uint32_t warps, Workers& workers, RayLog& log, RayHits* hits, const LogWarp& log_warp) {
    constexpr std::uint32_t part_warps = 64;
    std::vector<LoggedPart> parts((warps + part_warps - 1) / part_warps);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
        auto& worker = *workers.local();
        const auto first = static_cast<std::uint32_t>(part) * part_warps;
        const std::uint32_t end = std::min(first + part_warps, warps);
        for (std::uint32_t warp = first; warp != end; ++warp) log_warp(worker, parts[part], warp);
    });
    std::size_t rays = log.rays.size(), batches = log.batches.size();
    for (const LoggedPart& part : parts) {
        rays += part.log.rays.size();
        batches += part.log.batches.size();
    }
    log.rays.reserve(rays);
    log.ends.reserve(rays);
    log.batches.reserve(batches);
    for (LoggedPart& part : parts) {
        append(log, part.log);
        if (hits != nullptr) append(*hits, part.hits);
        part = {};
    }
}

}  // namespace

RayLog log_rays(const Capture& capture, std::uint32_t launch, RayHits* hits) {
    RayLog log;
    if (hits != nullptr) *hits = {};
    const traces::Header& header = capture.header();
    if (capture.is_wavefront()) {
        tbb::enumerable_thread_specific<std::unique_ptr<WavefrontLogWorker>> workers(
            [&] { return std::make_unique<WavefrontLogWorker>(capture); });
        const auto wavefront = capture.begin_wavefront(launch);
        for (std::uint32_t kernel = 0; kernel < header.kernels_per_launch; ++kernel) {
            log_warps(header.warps_per_kernel(), workers, log, hits,
                      [&](WavefrontLogWorker& worker, LoggedPart& part, std::uint32_t warp) {
                          worker.log->begin(part, warp);
                          wavefront->trace_warp(*worker.worker, warp, worker.unused);
                      });
            wavefront->end_kernel();
        }
        return log;
    }
    tbb::enumerable_thread_specific<std::unique_ptr<LogWorker>> workers(
        [&] { return std::make_unique<LogWorker>(capture); });
    log_warps(header.warps_per_launch, workers, log, hits,
              [&](LogWorker& worker, LoggedPart& part, std::uint32_t warp) {
                  std::array<PathLane, traces::warp_lanes> jobs;
                  std::array<Vec3, traces::warp_lanes> radiance;
                  worker.traversal.begin(part, warp);
                  const std::uint32_t mask = capture.lane_jobs(launch, warp, jobs);
                  if (mask != 0) worker.integrator->trace(mask, jobs, radiance);
              });
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
