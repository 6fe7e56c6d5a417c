#include "tracer/capture.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "tracer/sampling/pixel_place.hpp"
#include "traces/error.hpp"
#include "traces/writer.hpp"

namespace raycache::tracer {
namespace {

constexpr std::uint64_t texel_base = 0x30'0000'0000;
constexpr std::uint32_t texel_bytes = 4;
/// Of the regions of an integrator, one behind the other.
constexpr std::uint64_t own_base = 0x38'0000'0000, region_alignment = 2U << 20U;
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
    check_execution(settings.execution, integrator_entry(settings.paths.integrator));
    settings.strategy.samples.width = settings.width;
    return settings;
}

std::vector<std::uint32_t> choose_launches(const CaptureSettings& settings, std::uint32_t samples_per_launch) {
    if (!settings.first_indices.empty()) return settings.first_indices;
    const SampleSet& p = settings.strategy.samples;
    const std::uint64_t groups = (p.spp + samples_per_launch - 1) / samples_per_launch;
    const std::uint64_t wanted = (settings.trace_samples + samples_per_launch - 1) / samples_per_launch;
    std::vector<std::uint32_t> first = choose_sample_indices(groups, wanted, p.seed);
    for (std::uint32_t& index : first) index *= samples_per_launch;
    return first;
}

/// Those of BVH and textures.
std::vector<traces::Region> scene_regions(const PreparedScene& scene) {
    std::vector<traces::Region> regions = scene.bvh().regions();
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

void add_own_regions(std::vector<traces::Region>& regions, const IntegratorData& data) {
    std::uint64_t base = own_base;
    for (traces::Region& region : data.regions()) {
        region.base = base;
        base += (std::uint64_t{region.count} * region.stride + region_alignment) / region_alignment * region_alignment;
        regions.push_back(std::move(region));
    }
}

traces::Provenance make_provenance(const PreparedScene& scene, const CaptureSettings& settings, const LaunchGrid& grid,
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
    p.thread_map = grid.name();
    p.layout = scene.layout();
    p.spp = settings.strategy.samples.spp;
    p.seed = settings.strategy.samples.seed;
    p.width = settings.width;
    p.height = settings.height;
    p.bounces = integrator_entry(settings.paths.integrator).follows_light ? settings.paths.bounces : 0;
    p.execution = to_string(settings.execution.execution);
    p.order = settings.execution.order;
    return p;
}

}  // namespace

Capture::Capture(const PreparedScene& scene, const CaptureSettings& settings)
    : scene_(scene),
      settings_(checked(settings)),
      strategy_(settings_.strategy, sample_dimensions(settings_.paths)),
      camera_(scene.camera(), settings.width, settings.height),
      data_(scene.integrator_data(camera_, settings_.paths)),
      grid_(settings.thread_map, settings.width, settings.height, settings.strategy.samples.spp,
            interleave_of(settings.strategy.parameters)) {
    header_.provenance = make_provenance(scene, settings_, grid_, strategy_);
    if (integrator_entry(settings_.paths.integrator).walks_bvh) header_.regions = scene_regions(scene);
    own_regions_ = static_cast<std::uint8_t>(header_.regions.size());
    if (data_) add_own_regions(header_.regions, *data_);
    header_.launches = choose_launches(settings_, grid_.samples_per_launch());
    header_.warps_per_launch = grid_.warps();
    if (is_wavefront()) plan_wavefront();
    for (const std::uint32_t first : header_.launches) {
        auto& points = base_points_.emplace_back();
        const std::uint64_t end =
            std::min<std::uint64_t>(std::uint64_t{first} + grid_.samples_per_launch(), settings.strategy.samples.spp);
        for (std::uint64_t i = first; i < end; ++i) points.push_back(strategy_.base_point(i));
    }
}

Capture::~Capture() = default;

void Capture::plan_wavefront() {
    order_ = ray_order_entry(settings_.execution.order).make(scene_.scene());
    const StagePlan plan = integrator_entry(settings_.paths.integrator).stages(settings_.paths, scene_.lights());
    kernels_ = wavefront_kernels(plan, order_ != nullptr);
    const std::uint64_t paths = std::uint64_t{grid_.warps()} * traces::warp_lanes;
    if (paths > max_wavefront_paths)
        throw UsageError(fmt::format(
            "execution wavefront with {} paths a launch; expected at most {}, all of which it keeps in "
            "memory: choose a smaller resolution{}",
            paths, max_wavefront_paths, settings_.thread_map == ThreadMap::samples ? " or thread map tile" : ""));
    buffers_ = add_wavefront_buffers(header_.regions, static_cast<std::uint32_t>(paths),
                                     order_ ? sort_cost(*order_) : SortCost{});
    header_.kernels_per_launch = static_cast<std::uint32_t>(kernels_.size());
    const std::uint64_t warps = kernels_.size() * std::uint64_t{grid_.warps()};
    constexpr std::uint64_t most_warps = 1U << 26;  // of a launch in a trace
    if (warps > most_warps)
        throw UsageError(
            fmt::format("execution wavefront with {} kernels of {} warps; expected at most {} warps a "
                        "launch: choose fewer bounces or a smaller resolution",
                        kernels_.size(), grid_.warps(), most_warps));
    header_.warps_per_launch = static_cast<std::uint32_t>(warps);
}

std::unique_ptr<Capture::Worker> Capture::make_worker() const {
    return std::make_unique<Worker>(scene_, camera_, strategy_, settings_.paths, data_.get(), own_regions_);
}

std::unique_ptr<Wavefront> Capture::begin_wavefront(std::uint32_t launch) const {
    return std::make_unique<Wavefront>(kernels_, buffers_, order_.get(),
                                       [&](std::uint32_t warp, std::array<PathLane, traces::warp_lanes>& out) {
                                           return lane_jobs(launch, warp, out);
                                       });
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
    if (mask != 0) worker.integrator->trace(mask, jobs, radiance);
    worker.recorder.store(out);
}

void Capture::last_symbols(const Worker& worker, traces::WarpSymbols& out) const {
    out.clear();
    const bool walks = integrator_entry(settings_.paths.integrator).walks_bvh;
    if (!walks || scene_.bvh().symbols_known()) worker.recorder.store_symbols(out);
}

namespace {

/// Traces ranges of warps in parallel and appends them to the file in order.
class RangeWriter {
public:
    struct Range {
        std::uint32_t launch, first, count;  ///< warps of the launch
    };
    /// Fills worker-local warps (launch and warp ordinal included) and their symbols; none for "not known".
    using Trace = std::function<void(Capture::Worker&, const Range&, std::vector<traces::WarpTrace>&,
                                     std::vector<traces::WarpSymbols>&)>;

    RangeWriter(const Capture& capture, const std::string& path, const Progress& progress)
        : header_(capture.header()),
          progress_(progress),
          writer_(path, header_),
          locals_([&capture] { return Local{capture.make_worker()}; }) {}

    /// All warps from `first` of `first_launch` up to the end of the last launch or of `count` warps.
    void write(std::uint32_t launch, std::uint32_t warp, std::uint64_t count, const Trace& trace) {
        const auto next = [&](tbb::flow_control& control) -> Range {
            if (count == 0) {
                control.stop();
                return {};
            }
            const auto size = static_cast<std::uint32_t>(
                std::min<std::uint64_t>({block_warps, header_.warps_per_launch - warp, count}));
            const Range range{launch, warp, size};
            count -= size;
            warp += size;
            if (warp == header_.warps_per_launch) {
                warp = 0;
                ++launch;
            }
            return range;
        };
        const auto encode = [&](const Range& range) {
            Local& local = locals_.local();
            local.warps.resize(range.count);
            local.symbols.assign(range.count, {});
            trace(*local.worker, range, local.warps, local.symbols);
            return traces::encode_block(header_, local.warps, local.symbols);
        };
        const auto append = [&](const traces::Block& block) {
            writer_.append(block);
            if (progress_) progress_(block.warps, block.rays);
        };
        const auto tokens = static_cast<std::size_t>(2 * tbb::this_task_arena::max_concurrency());
        tbb::parallel_pipeline(tokens,
                               tbb::make_filter<void, Range>(tbb::filter_mode::serial_in_order, next) &
                                   tbb::make_filter<Range, traces::Block>(tbb::filter_mode::parallel, encode) &
                                   tbb::make_filter<traces::Block, void>(tbb::filter_mode::serial_in_order, append));
    }
    void finish() { writer_.finish(); }

private:
    struct Local {
        std::unique_ptr<Capture::Worker> worker;
        std::vector<traces::WarpTrace> warps{};
        std::vector<traces::WarpSymbols> symbols{};
    };
    const traces::Header& header_;
    const Progress& progress_;
    traces::Writer writer_;
    tbb::enumerable_thread_specific<Local> locals_;
};

}  // namespace

void write_capture(const Capture& capture, const std::string& path, const Progress& progress) {
    const traces::Header& header = capture.header();
    RangeWriter writer(capture, path, progress);
    if (!capture.is_wavefront()) {
        writer.write(0, 0, std::uint64_t{header.warps_per_launch} * header.launches.size(),
                     [&](Capture::Worker& worker, const RangeWriter::Range& range, auto& warps, auto& symbols) {
                         for (std::uint32_t i = 0; i < range.count; ++i) {
                             capture.trace_warp(worker, range.launch, range.first + i, warps[i]);
                             capture.last_symbols(worker, symbols[i]);
                         }
                     });
        writer.finish();
        return;
    }
    const std::uint32_t per_kernel = header.warps_per_kernel();
    for (std::uint32_t launch = 0; launch < header.launches.size(); ++launch) {
        const auto wavefront = capture.begin_wavefront(launch);
        for (std::uint32_t kernel = 0; kernel < header.kernels_per_launch; ++kernel) {
            const std::uint32_t first = kernel * per_kernel;
            writer.write(launch, first, per_kernel,
                         [&](Capture::Worker& worker, const RangeWriter::Range& range, auto& warps, auto&) {
                             for (std::uint32_t i = 0; i < range.count; ++i) {
                                 wavefront->trace_warp(worker, range.first - first + i, warps[i]);
                                 warps[i].launch = launch;
                                 warps[i].warp = range.first + i;
                             }
                         });
            wavefront->end_kernel();
        }
    }
    writer.finish();
}

}  // namespace raycache::tracer
