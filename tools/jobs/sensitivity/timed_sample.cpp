#include "tools/jobs/sensitivity/timed_sample.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "cachesim/replay/timed/timed_replay.hpp"
#include "tools/jobs/windows/window_replay.hpp"
#include "tools/jobs/windows/windowed_replay.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

WindowedReplay<cachesim::TimedReplay> make_replay(const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions,
                                                  const BlockPlan& plan, const WindowSizes& sizes) {
    const std::uint32_t wave = wave_warps(gpu);
    return {cachesim::TimedReplay(gpu, regions, plan.first), sizes.timed_warm_up_waves * wave,
            sizes.counted_waves * wave, gpu.warps_per_cta, sizes.timed_windows};
}

/// Warps before and behind the place of a window.
struct WindowExtent {
    std::int64_t first, end;
};

WindowExtent window_extent(const cachesim::Gpu& gpu, const WindowSizes& sizes) {
    const double wave = wave_warps(gpu);
    return {-std::max(1LL, std::llround(sizes.timed_warm_up_waves * wave)),
            std::max(1LL, std::llround(sizes.counted_waves * wave))};
}

}  // namespace

std::uint64_t TimedSample::warps_of(const ModelledGpu& model, const WindowSizes& sizes) {
    const WindowExtent extent = window_extent(model.gpu, sizes);
    return wave_warps(model.gpu) + static_cast<std::uint64_t>(extent.end - extent.first) * sizes.timed_windows +
           model.gpu.warps_per_cta;
}

template <class Use>
void TimedSample::for_each_warp(const ModelledGpu& model, const Use& use) const {
    const auto of_cta = static_cast<std::int64_t>(model.gpu.warps_per_cta);
    const auto round = static_cast<std::int64_t>(round_);
    const auto number = [&](const WindowPlace& place, std::int64_t offset) {
        const std::int64_t cta = offset >= 0 ? offset / of_cta : -((of_cta - 1 - offset) / of_cta);
        const std::int64_t at = std::int64_t{place.index} * launch_warps_ + place.warp +
                                cta_of_launch(cta, model) * of_cta + (offset - cta * of_cta);
        return static_cast<std::uint64_t>((at % round + round) % round);
    };
    const auto wave = static_cast<std::int64_t>(wave_warps(model.gpu));
    for (std::int64_t i = 0; i < wave; ++i) use(true, 0u, i, number(plan_.fills.front(), i));
    const WindowExtent extent = window_extent(model.gpu, sizes_);
    for (std::uint32_t w = 0; w < sizes_.timed_windows; ++w) {
        const std::int64_t end = extent.end + (w + 1 == sizes_.timed_windows ? of_cta : 0);
        for (std::int64_t i = extent.first; i < end; ++i) use(false, w, i, number(plan_.windows[w], i));
    }
}

TimedSample::TimedSample(const WindowedCase& c, std::size_t block, const BlockPlan& plan, const WindowSizes& sizes,
                         const std::vector<ModelledGpu>& gpus)
    : case_(c),
      plan_(plan),
      sizes_(sizes),
      launch_warps_(c.capture->header().warps_per_launch),
      round_(std::uint64_t{c.plan.launches()} * launch_warps_),
      work_(c.capture->header().regions, {}) {
    std::vector<std::uint64_t> numbers;
    for (const ModelledGpu& model : gpus)
        for_each_warp(model, [&](bool, std::uint32_t, std::int64_t, std::uint64_t n) { numbers.push_back(n); });
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    std::vector<WarpPointer> traced(numbers.size());
    const auto stream = [&] { return WarpStream(*c.capture, c.first_launch(block), c.plan.launches()); };
    constexpr std::size_t piece = 64;
    const std::size_t pieces = (numbers.size() + piece - 1) / piece;
    std::uint64_t counted = 0;
    // The first task counts the work, the others trace.
    tbb::parallel_for(
        std::size_t{0}, pieces + 1,
        [&](std::size_t task) {
            WarpStream own = stream();
            if (task == 0) {
                counted = count_work(own, plan_, sizes_, work_);
                return;
            }
            for (std::size_t i = (task - 1) * piece; i < std::min(task * piece, numbers.size()); ++i)
                traced[i] = std::make_shared<const traces::WarpTrace>(own.trace(numbers[i]));
        },
        tbb::simple_partitioner());
    scale_ = static_cast<double>(launch_warps_) / static_cast<double>(counted);
    for (std::size_t i = 0; i < numbers.size(); ++i) warps_.emplace(numbers[i], std::move(traced[i]));
}

cachesim::TimedStatistics TimedSample::replay(const ModelledGpu& model) const {
    auto windowed = make_replay(model.gpu, case_.capture->header().regions, plan_, sizes_);
    for_each_warp(model, [&](bool fill, std::uint32_t window, std::int64_t offset, std::uint64_t number) {
        const WarpPointer& warp = warps_.at(number);
        fill ? windowed.replay().push(warp) : windowed.push(warp, window, offset);
    });
    cachesim::TimedStatistics times;
    const auto& batches = windowed.replay().batches();
    if (!batches.empty()) times = batches.front();
    for (std::size_t b = 1; b < batches.size(); ++b) times += batches[b];
    if (times.cycles == 0)
        throw Error(fmt::format(
            "{}: a window in time began and ended at once, since most of its warps have no ray; expected a picture "
            "whose warps fill the GPU: raise --resolution, or replay whole launches (--trace-samples)",
            model.gpu.name));
    work_.scale(times, scale_);
    return times;
}

}  // namespace raycache::tools
