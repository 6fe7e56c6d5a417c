#include "tools/jobs/windows/window_replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "cachesim/analysis/explainer.hpp"
#include "cachesim/replay/replay.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "tools/jobs/windows/issue_work.hpp"
#include "tools/jobs/windows/scaled_findings.hpp"
#include "tools/jobs/windows/warp_stream.hpp"
#include "tools/jobs/windows/windowed_replay.hpp"
#include "tools/jobs/windows/work_count.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

/// The replays of one GPU.
class GpuWindows {
public:
    GpuWindows(const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions, std::uint32_t sample,
               const WindowSizes& sizes, const WindowReplays& wanted)
        : gpu_(gpu.name),
          full_share_(sizes.unfilled_share),
          wave_(wave_warps(gpu)),
          counted_(cachesim::Replay(gpu, regions, sample), sizes.warm_up_waves * wave_, sizes.counted_waves * wave_,
                   wave_, sizes.windows) {
        // In time a window ends when the CTA behind it begins, and nothing needs to run after that.
        for (const cachesim::Idealised& ideal : wanted.timed)
            timed_.emplace_back(cachesim::TimedReplay(gpu, regions, sample, ideal), sizes.timed_warm_up_waves * wave_,
                                sizes.counted_waves * wave_, gpu.warps_per_cta,
                                std::min(sizes.timed_windows, sizes.windows));
        if (!wanted.depth) return;
        explainer_ =
            std::make_unique<cachesim::Explainer>(gpu, regions, *wanted.depth, nullptr, cachesim::History::endless);
        counted_.replay().observe(*explainer_);
    }

    std::uint32_t wave() const { return wave_; }

    bool is_full() const { return unfilled_share_ < full_share_; }
    /// `first`: of the first wave. It also brings the SMs of a timed replay out of step.
    void fill(const WarpPointer& warp, bool first) {
        counted_.replay().push(warp);
        if (!first) return;
        for (auto& timed : timed_) timed.replay().push(warp);
    }
    void end_wave() { note_fills(); }

    std::int64_t first() const { return counted_.first(); }
    std::int64_t end(std::uint32_t window) const {
        return std::max(counted_.end(window), timed_.empty() ? 0 : timed_.front().end(window));
    }
    bool wants(std::uint32_t window, std::int64_t offset) const {
        return counted_.wants(window, offset) || (!timed_.empty() && timed_.front().wants(window, offset));
    }
    void push(const WarpPointer& warp, std::uint32_t window, std::int64_t offset) {
        counted_.push(warp, window, offset);
        for (auto& timed : timed_) timed.push(warp, window, offset);
    }

    BlockResult finish() {
        BlockResult result;
        result.counts = counted_.replay().finish();
        if (!is_full()) note_fills();
        result.unfilled_share = unfilled_share_;
        for (auto& timed : timed_) {
            const auto& batches = timed.replay().batches();
            cachesim::TimedStatistics& times = result.times.emplace_back(batches.front());
            for (std::size_t b = 1; b < batches.size(); ++b) times += batches[b];
            if (times.cycles == 0)
                throw Error(fmt::format(
                    "{}: a window in time began and ended at once, since most of its warps have no ray; expected a "
                    "picture whose warps fill the GPU: raise --resolution, or replay whole launches (--exact)",
                    gpu_));
        }
        if (explainer_) result.findings = explainer_->findings();
        return result;
    }

private:
    /// Since the last call.
    void note_fills() {
        const cachesim::LineFills now = counted_.replay().last_level_fills();
        const std::uint64_t misses = now.line_misses - before_.line_misses;
        const std::uint64_t empty = now.of_empty_ways - before_.of_empty_ways;
        if (misses == 0) return;  // that says nothing: all of a small scene may be there, in a cache mostly empty
        unfilled_share_ = static_cast<double>(empty) / static_cast<double>(misses);
        before_ = now;
    }

    std::string gpu_;
    double full_share_;
    std::uint32_t wave_;
    WindowedReplay<cachesim::Replay> counted_;
    std::vector<WindowedReplay<cachesim::TimedReplay>> timed_;
    std::unique_ptr<cachesim::Explainer> explainer_;
    cachesim::LineFills before_;
    double unfilled_share_ = 1;
};

/// One SM as if it were alone with its share of the launch: of every `sms` CTAs the first, as many before the counted
/// ones as it holds at once. What its own caches do does not depend on the others.
cachesim::LaunchStatistics replay_sm(WarpStream& stream, const BlockPlan& plan, const cachesim::Gpu& gpu,
                                     const std::vector<traces::Region>& regions) {
    cachesim::Gpu one = gpu;
    one.sms = 1;
    const std::uint32_t slots = std::max(1U, gpu.warps_per_sm / gpu.warps_per_cta);
    const std::uint64_t next = std::uint64_t{gpu.sms} * gpu.warps_per_cta;  // warps from one of its CTAs to the next
    const std::uint64_t ahead = (slots * next / stream.round() + 1) * stream.round();
    const std::size_t count = std::max<std::size_t>(1, plan.sm_windows.size() / slots);
    cachesim::Replay replay(one, regions, plan.first);
    replay.count_until_here();
    for (std::size_t w = 0; w <= count; ++w) {  // one more, so that nothing counted drains
        const std::uint64_t begin = stream.number(plan.sm_windows[w % count]) + ahead - slots * next;
        for (std::uint32_t cta = 0; cta < (w < count ? 2 : 1) * slots; ++cta) {
            if (cta == slots) replay.count_from_here();
            for (std::uint32_t i = 0; i < gpu.warps_per_cta; ++i)
                replay.push(std::make_shared<const traces::WarpTrace>(stream.trace(begin + cta * next + i)));
        }
        replay.count_until_here();
    }
    return replay.finish();
}

void fill_caches(WarpStream& stream, const BlockPlan& plan, std::vector<GpuWindows>& gpus) {
    for (const WindowPlace& place : plan.fills) {
        const bool first = &place == &plan.fills.front();
        std::uint32_t longest = 0;
        for (const GpuWindows& gpu : gpus)
            if (!gpu.is_full()) longest = std::max(longest, gpu.wave());
        for (std::uint32_t i = 0; i < longest; ++i) {
            const auto warp = std::make_shared<const traces::WarpTrace>(stream.trace(stream.number(place) + i));
            for (GpuWindows& gpu : gpus)
                if (!gpu.is_full() && i < gpu.wave()) gpu.fill(warp, first);
        }
        for (GpuWindows& gpu : gpus)
            if (!gpu.is_full()) gpu.end_wave();
    }
}

void replay_windows(WarpStream& stream, const BlockPlan& plan, std::vector<GpuWindows>& gpus) {
    std::int64_t first = 0;
    for (const GpuWindows& gpu : gpus) first = std::min(first, gpu.first());
    // Where a warm-up is longer than the picture, it takes rounds through the block.
    const std::uint64_t ahead = (static_cast<std::uint64_t>(-first) / stream.round() + 1) * stream.round();
    for (std::uint32_t w = 0; w < plan.windows.size(); ++w) {
        std::int64_t end = 0;
        for (const GpuWindows& gpu : gpus) end = std::max(end, gpu.end(w));
        const std::uint64_t begin = stream.number(plan.windows[w]) + ahead;
        for (std::int64_t offset = first; offset < end; ++offset) {
            const auto wants = [&](const GpuWindows& gpu) { return gpu.wants(w, offset); };
            if (std::none_of(gpus.begin(), gpus.end(), wants)) continue;
            const auto number = static_cast<std::uint64_t>(static_cast<std::int64_t>(begin) + offset);
            const auto warp = std::make_shared<const traces::WarpTrace>(stream.trace(number));
            for (GpuWindows& gpu : gpus) gpu.push(warp, w, offset);
        }
    }
}

/// What makes one sample index of every pixel of so many traced warps.
double picture_share(const WarpStream& stream, const WindowPlan& windows, std::uint64_t traced) {
    return static_cast<double>(stream.warps()) / static_cast<double>(traced) / windows.indices_per_launch();
}

}  // namespace

std::uint32_t wave_warps(const cachesim::Gpu& gpu) {
    return gpu.sms * std::max(1U, gpu.warps_per_sm / gpu.warps_per_cta) * gpu.warps_per_cta;
}

std::vector<BlockResult> replay_block(const tracer::Capture& capture, std::uint32_t first_launch,
                                      const WindowPlan& windows, const BlockPlan& plan, const WindowSizes& sizes,
                                      const std::vector<cachesim::Gpu>& gpus, const WindowReplays& wanted) {
    WarpStream stream(capture, first_launch, windows.launches());
    const auto& regions = capture.header().regions;

    std::vector<std::uint32_t> widths;
    for (const cachesim::Gpu& gpu : gpus)
        if (gpu.simd_width != traces::warp_lanes) widths.push_back(gpu.simd_width);
    WorkCount work(regions, widths);
    std::vector<std::optional<IssueWork>> issued(gpus.size());
    for (std::size_t g = 0; g < gpus.size(); ++g)
        if (gpus[g].timing) issued[g].emplace(gpus[g], regions);
    const std::uint64_t traced = trace_work(stream, plan, sizes, [&](const traces::WarpTrace& warp) {
        work.add(warp);
        for (auto& of_gpu : issued)
            if (of_gpu) of_gpu->add(warp);
    });

    std::vector<GpuWindows> replays;
    replays.reserve(gpus.size());
    for (const cachesim::Gpu& gpu : gpus) replays.emplace_back(gpu, regions, plan.first, sizes, wanted);
    fill_caches(stream, plan, replays);
    replay_windows(stream, plan, replays);

    const double scale = picture_share(stream, windows, traced);
    std::vector<BlockResult> results;
    for (std::size_t g = 0; g < gpus.size(); ++g) {
        BlockResult& result = results.emplace_back(replays[g].finish());
        result.counts.groups = work.launch(replay_sm(stream, plan, gpus[g], regions), result.counts, gpus[g], scale);
        for (cachesim::TimedStatistics& times : result.times) work.scale(times, scale);
        if (issued[g]) result.issue_cycles = issued[g]->cycles() * scale;
        if (wanted.depth) result.findings = scaled_findings(result.findings, result.counts);
    }
    return results;
}

std::vector<double> count_issue_cycles(const tracer::Capture& capture, std::uint32_t first_launch,
                                       const WindowPlan& windows, const BlockPlan& plan, const WindowSizes& sizes,
                                       const std::vector<cachesim::Gpu>& gpus) {
    WarpStream stream(capture, first_launch, windows.launches());
    std::vector<IssueWork> issued;
    for (const cachesim::Gpu& gpu : gpus) issued.emplace_back(gpu, capture.header().regions);
    const std::uint64_t traced = trace_work(stream, plan, sizes, [&](const traces::WarpTrace& warp) {
        for (IssueWork& of_gpu : issued) of_gpu.add(warp);
    });
    std::vector<double> cycles;
    for (const IssueWork& of_gpu : issued) cycles.push_back(of_gpu.cycles() * picture_share(stream, windows, traced));
    return cycles;
}

}  // namespace raycache::tools
