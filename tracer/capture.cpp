#include "tracer/capture.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "tracer/simt/recorder.hpp"
#include "tracer/simt/warp_traversal.hpp"
#include "traces/error.hpp"
#include "traces/writer.hpp"

namespace raycache::tracer {
namespace {

constexpr std::uint64_t texel_base = 0x30'0000'0000;
constexpr std::uint32_t texel_bytes = 4;
/// Warps of a file block: 8 CTAs.
constexpr std::uint32_t block_warps = 64;

CaptureSettings checked(CaptureSettings settings) {
    const auto check_size = [](std::uint32_t pixels, const char* what) {
        if (pixels == 0 || pixels > max_resolution)
            throw UsageError(fmt::format("picture {} of {} pixels; expected 1 to {}", what, pixels, max_resolution));
    };
    check_size(settings.width, "width");
    check_size(settings.height, "height");
    check(settings.paths);
    settings.strategy.parameters.width = settings.width;
    return settings;
}

std::vector<std::uint32_t> choose_launches(const CaptureSettings& settings, std::uint32_t samples_per_launch) {
    const DecorrelationSettings& p = settings.strategy.parameters;
    const std::uint64_t groups = (p.spp + samples_per_launch - 1) / samples_per_launch;
    const std::uint64_t wanted = (settings.trace_samples + samples_per_launch - 1) / samples_per_launch;
    std::vector<std::uint32_t> first = choose_sample_indices(groups, wanted, p.seed);
    for (std::uint32_t& index : first) index *= samples_per_launch;
    return first;
}

std::vector<traces::Region> make_regions(const PreparedScene& scene) {
    std::vector<traces::Region> regions = bvh2_regions(scene.bvh());
    if (scene.texels().count() != 0) {
        traces::Region texels;
        texels.kind = traces::ObjectKind::texel;
        texels.base = texel_base;
        texels.element_size = texels.stride = texel_bytes;
        texels.count = scene.texels().count();
        regions.push_back(std::move(texels));
    }
    return regions;
}

traces::Provenance make_provenance(const PreparedScene& scene, const CaptureSettings& settings,
                                   const SamplingStrategy& strategy) {
    traces::Provenance p;
    p.program = settings.program;
    p.command = settings.command;
    p.scene = scene.scene().name;
    p.scene_hash = scene.scene().hash;
    p.camera = scene.camera().name;
    p.sequence = settings.strategy.sequence;
    p.decorrelation = settings.strategy.decorrelation;
    p.parameters = strategy.parameters();
    p.thread_map = to_string(settings.thread_map);
    p.layout = "bvh2";
    p.spp = settings.strategy.parameters.spp;
    p.seed = settings.strategy.parameters.seed;
    p.width = settings.width;
    p.height = settings.height;
    p.bounces = settings.paths.bounces;
    return p;
}

}  // namespace

class Capture::Worker {
public:
    explicit Worker(const Capture& capture)
        : traversal(capture.scene_.scene(), capture.scene_.bvh(), capture.scene_.texels(), recorder),
          integrator(capture.scene_.scene(), capture.camera_, capture.scene_.lights(), capture.scene_.texels(),
                     capture.strategy_, capture.settings_.paths, traversal) {}

    WarpRecorder recorder;
    WarpTraversal<WarpRecorder> traversal;
    PathIntegrator<WarpTraversal<WarpRecorder>> integrator;
};

Capture::Capture(const PreparedScene& scene, const CaptureSettings& settings)
    : scene_(scene),
      settings_(checked(settings)),
      strategy_(settings_.strategy, path_dimensions(settings.paths.bounces)),
      camera_(scene.camera(), settings.width, settings.height),
      grid_(settings.thread_map, settings.width, settings.height, settings.strategy.parameters.spp,
            settings.strategy.parameters.interleave) {
    header_.provenance = make_provenance(scene, settings_, strategy_);
    header_.regions = make_regions(scene);
    header_.launches = choose_launches(settings_, grid_.samples_per_launch());
    header_.warps_per_launch = grid_.warps();
    for (const std::uint32_t first : header_.launches) {
        auto& points = base_points_.emplace_back();
        const std::uint64_t end = std::min<std::uint64_t>(std::uint64_t{first} + grid_.samples_per_launch(),
                                                          settings.strategy.parameters.spp);
        for (std::uint64_t i = first; i < end; ++i) points.push_back(strategy_.base_point(i));
    }
}

Capture::~Capture() = default;

std::unique_ptr<Capture::Worker, void (*)(Capture::Worker*)> Capture::make_worker() const {
    return {new Worker(*this), [](Worker* w) { delete w; }};
}

std::uint32_t Capture::lane_jobs(std::uint32_t launch, std::uint32_t warp,
                                 std::array<PathLane, traces::warp_lanes>& out) const {
    const std::uint32_t first = header_.launches[launch];
    const WarpJobs jobs = grid_.jobs(warp, first);
    for (unsigned l = 0; l < traces::warp_lanes; ++l) {
        if (((jobs.mask >> l) & 1U) == 0) continue;
        const LaneJob& job = jobs.lane[l];
        out[l] = {job.x, job.y, job.y * settings_.width + job.x, job.sample,
                  base_points_[launch][job.sample - first].data()};
    }
    return jobs.mask;
}

void Capture::trace_warp(Worker& worker, std::uint32_t launch, std::uint32_t warp, traces::WarpTrace& out) const {
    out.launch = launch;
    out.warp = warp;
    worker.recorder.clear();
    std::array<PathLane, traces::warp_lanes> jobs;
    std::array<Vec3, traces::warp_lanes> radiance;
    const std::uint32_t mask = lane_jobs(launch, warp, jobs);
    if (mask != 0) worker.integrator.trace(mask, jobs, radiance);
    worker.recorder.store(out);
}

void Capture::last_symbols(const Worker& worker, traces::WarpSymbols& out) const {
    const Bvh2& bvh = scene_.bvh();
    out.clear();
    if (bvh.stack_entries <= traces::symbol_stack_entries && bvh.nodes.front().child[1] != ChildRef::nothing)
        worker.recorder.store_symbols(out);
}

void write_capture(const Capture& capture, const std::string& path, const Progress& progress) {
    const traces::Header& header = capture.header();
    traces::Writer writer(path, header);

    struct Range {
        std::uint32_t launch, first, count;
    };
    std::uint32_t launch = 0, warp = 0;
    const auto next = [&](tbb::flow_control& control) -> Range {
        if (launch == header.launches.size()) {
            control.stop();
            return {};
        }
        const Range range{launch, warp, std::min(block_warps, header.warps_per_launch - warp)};
        warp += range.count;
        if (warp == header.warps_per_launch) {
            warp = 0;
            ++launch;
        }
        return range;
    };
    struct Local {
        std::unique_ptr<Capture::Worker, void (*)(Capture::Worker*)> worker;
        std::vector<traces::WarpTrace> warps{};
        std::vector<traces::WarpSymbols> symbols{};
    };
    tbb::enumerable_thread_specific<Local> locals([&] { return Local{capture.make_worker()}; });
    const auto trace = [&](const Range& range) {
        Local& local = locals.local();
        local.warps.resize(range.count);
        local.symbols.resize(range.count);
        for (std::uint32_t i = 0; i < range.count; ++i) {
            capture.trace_warp(*local.worker, range.launch, range.first + i, local.warps[i]);
            capture.last_symbols(*local.worker, local.symbols[i]);
        }
        return traces::encode_block(header, local.warps, local.symbols);
    };
    const auto append = [&](const traces::Block& block) {
        writer.append(block);
        if (progress) progress(block.warps, block.rays);
    };
    const auto tokens = static_cast<std::size_t>(2 * tbb::this_task_arena::max_concurrency());
    tbb::parallel_pipeline(tokens,
                           tbb::make_filter<void, Range>(tbb::filter_mode::serial_in_order, next) &
                               tbb::make_filter<Range, traces::Block>(tbb::filter_mode::parallel, trace) &
                               tbb::make_filter<traces::Block, void>(tbb::filter_mode::serial_in_order, append));
    writer.finish();
}

}  // namespace raycache::tracer
