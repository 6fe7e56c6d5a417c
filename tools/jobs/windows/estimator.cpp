#include "tools/jobs/windows/estimator.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "tools/jobs/costs.hpp"

namespace raycache::tools {
namespace {

constexpr std::uint32_t first_look = 8, fewest_blocks = 2;
constexpr double all_error = 0.05;  ///< of a 95 % interval

std::string stage_name(std::uint32_t end) { return fmt::format("windows of {} blocks", end); }

}  // namespace

Estimator::Estimator(const tracer::PreparedScene& scene, const std::vector<WindowedStrategy>& strategies,
                     const EstimateSettings& settings, const std::vector<cachesim::Gpu>& gpus,
                     std::vector<cachesim::Idealised> ideals, bool findings, Observer& observer,
                     const WindowChoice& choice)
    : settings_(settings),
      gpus_(gpus),
      ideals_(std::move(ideals)),
      observer_(observer),
      sizes_(choice.sizes),
      error_of_look_(all_error) {
    std::uint32_t blocks = most_blocks;
    if (settings.window_count != 0) {
        sizes_.windows = static_cast<std::uint32_t>(std::min<std::uint64_t>(sizes_.windows, settings.window_count / 2));
        sizes_.timed_windows = std::min(sizes_.timed_windows, sizes_.windows);
        blocks = static_cast<std::uint32_t>(settings.window_count / sizes_.windows);
    }
    const std::uint32_t grain = common_indices(strategies);
    for (const WindowedStrategy& strategy : strategies) {
        Case& c =
            cases_.emplace_back(Case{make_case(scene, strategy, sizes_, choice.drawing, blocks, grain), {}, {}, {}});
        if (!findings) continue;
        c.depth = std::make_unique<cachesim::ElementDepth>(c.capture->header().regions);
        c.findings.resize(gpus.size());
    }
}

void Estimator::warn_of_pictures() const {
    for (const cachesim::Gpu& gpu : gpus_) {
        const std::uint32_t wave = wave_warps(gpu), picture = cases_.front().capture->header().warps_per_launch;
        if (picture >= wave) continue;
        observer_.warn(fmt::format(
            "the picture has {} warps a sample and {} holds {} at once: several samples of it are under way together, "
            "as where a renderer launches them in one go",
            picture, gpu.name, wave));
    }
}

double Estimator::block_cost() const {
    double paths = sizes_.work_groups * sizes_.work_warps, longest = 0, replayed = 0, timed = 0;
    for (const cachesim::Gpu& gpu : gpus_) {
        const double wave = wave_warps(gpu), windows = (sizes_.warm_up_waves + sizes_.counted_waves) * wave;
        const double of_sms = 2.0 * sizes_.sm_windows * gpu.warps_per_cta;
        const double of_gpu = sizes_.windows * windows + 3 * wave;
        paths += of_sms;
        longest = std::max(longest, of_gpu);
        replayed += of_sms + of_gpu;
        timed += static_cast<double>(ideals_.size()) *
                 (1 + sizes_.timed_windows * (sizes_.timed_warm_up_waves + sizes_.counted_waves)) * wave;
    }
    const double count = traces::warp_lanes * static_cast<double>(cases_.size());
    const std::uint32_t bounces = cases_.front().capture->settings().paths.bounces;
    return window_cost(bounces, (paths + longest) * count, replayed * count, timed * count);
}

double Estimator::work_cost() const {
    const double paths =
        traces::warp_lanes * sizes_.work_groups * sizes_.work_warps * static_cast<double>(cases_.size());
    return window_cost(cases_.front().capture->settings().paths.bounces, paths, 0, 0);
}

void Estimator::expect(std::uint32_t begin, std::uint32_t end) {
    observer_.expect(stage_name(end), ideals_.empty() ? Work::replay : Work::timed_replay,
                     (end - begin) * block_cost());
}

void Estimator::run_blocks(std::uint32_t end) {
    const std::uint32_t begin = blocks_;
    const std::size_t tasks = (end - begin) * cases_.size();
    for (Case& c : cases_) c.blocks.resize(end);
    const Stage stage(observer_, stage_name(end), tasks, "blocks");
    std::mutex mutex;
    tbb::parallel_for(
        std::size_t{0}, tasks,
        [&](std::size_t task) {
            Case& c = cases_[task % cases_.size()];
            const std::size_t block = begin + task / cases_.size();
            std::vector<BlockResult>& results = c.blocks[block];
            results = replay_block(*c.capture, static_cast<std::uint32_t>(block * c.plan.launches()), c.plan,
                                   c.plan.block(block, c.first[block]), sizes_, gpus_, {ideals_, c.depth.get()});
            const std::lock_guard lock(mutex);  // sums of whole numbers: in any order the same
            for (std::size_t g = 0; g < c.findings.size(); ++g) c.findings[g] += std::exchange(results[g].findings, {});
            stage.add(1, 1);
        },
        tbb::simple_partitioner());
    blocks_ = end;
}

Worst Estimator::look(std::uint32_t end, const std::string& baseline) {
    if (blocks_ == 0) expect(0, end);
    run_blocks(end);
    error_of_look_ /= 2;
    return worst_ = worst_error(result(), baseline, settings_.across_gpus);
}

/// The half width falls with the square root of the blocks: the looks that are still to come.
void Estimator::expect_further(std::uint32_t end, double error) {
    for (std::uint32_t next = 2 * end; next <= most_blocks; next *= 2) {
        expect(next / 2, next);
        if (error * std::sqrt(end / static_cast<double>(next)) <= settings_.target_error) return;
    }
}

/// Looks at 8, 16, 32 … blocks; with a budget at 2, 4, 8 … and, where the next does not fit, at what fits.
void Estimator::run(const std::string& baseline, Clock::time_point start) {
    warn_of_pictures();
    if (settings_.window_count != 0) {
        const auto blocks = static_cast<std::uint32_t>(settings_.window_count / sizes_.windows);
        expect(0, blocks);
        run_blocks(blocks);
        return;
    }
    if (settings_.time_budget > 0) return spend_budget(baseline, start);
    for (std::uint32_t end = first_look; end <= most_blocks; end *= 2) {
        if (look(end, baseline).error <= settings_.target_error) return;
        expect_further(end, worst_.error);
    }
    observer_.warn(fmt::format("no more than {} blocks are replayed: {}", most_blocks, how_far()));
}

void Estimator::spend_budget(const std::string& baseline, Clock::time_point start) {
    const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    const double budget = settings_.time_budget, prepared = seconds();
    look(fewest_blocks, baseline);
    if (const double took = seconds(); took > budget && worst_.error > settings_.target_error) {
        observer_.warn(
            fmt::format("the time budget of {:g} s is less than an interval takes, {:.1f} s: {:.1f} s until the scene "
                        "is ready, {:.1f} s for {} blocks; {}",
                        budget, took, prepared, took - prepared, blocks_, how_far()));
        return;
    }
    while (worst_.error > settings_.target_error && blocks_ < most_blocks) {
        expect_further(blocks_, worst_.error);
        const double left = budget - seconds(), of_block = (seconds() - prepared) / blocks_;
        const auto fits = static_cast<std::uint32_t>(std::clamp(left / of_block, 0.0, 1.0 * most_blocks));
        if (fits == 0) break;
        // Looks are counted, so few long ones: what is left for less than twice as many blocks is one look, the last.
        const std::uint32_t more = fits < 3 * blocks_ ? fits : blocks_;
        look(std::min(blocks_ + more, most_blocks), baseline);
    }
    if (worst_.error > settings_.target_error)
        observer_.warn(fmt::format("the time budget of {:g} s ends at {} blocks, {}", budget, blocks_, how_far()));
}

/// After a look.
std::string Estimator::how_far() const {
    return fmt::format("±{:.1f} % ({}); the target was ±{:.2g} %", 100 * worst_.error, worst_.of,
                       100 * settings_.target_error);
}

cachesim::Origin Estimator::origin(const Case& c, std::size_t gpu) const {
    const traces::Provenance& p = c.capture->header().provenance;
    cachesim::Origin origin{p.scene,
                            c.name,
                            p.sequence,
                            p.parameters,
                            p.thread_map,
                            gpus_[gpu].name,
                            p.spp,
                            {gpus_[gpu].levels.size(), gpus_[gpu].l1().sector_bytes},
                            {}};
    cachesim::WindowSample& w = origin.windows.emplace();
    w.blocks = blocks_;
    w.indices = c.plan.launches() * c.plan.indices_per_launch();
    w.windows = sizes_.windows;
    w.timed_windows = ideals_.empty() ? 0 : sizes_.timed_windows;
    if (blocks_ > 1 && error_of_look_ != all_error) w.widening = cachesim::widening(blocks_ - 1, error_of_look_);
    for (const auto& block : c.blocks) {
        w.unfilled_share += block[gpu].unfilled_share / blocks_;
        w.last_cache_full &= block[gpu].unfilled_share < sizes_.unfilled_share;
    }
    return origin;
}

Predicted Estimator::result() const {
    Predicted all;
    for (const Case& c : cases_)
        for (std::size_t g = 0; g < gpus_.size(); ++g) {
            cachesim::Series& counted = all.traffic.emplace_back(cachesim::Series{origin(c, g), {}});
            for (const auto& block : c.blocks) counted.launches.push_back(block[g].counts);
            if (ideals_.empty()) continue;
            cachesim::TimedSeries& timed = all.times.emplace_back();
            static_cast<cachesim::Origin&>(timed) = counted;
            timed.no_time = cachesim::no_time_note(gpus_[g]);
            timed.traversal = cachesim::traversal_name(gpus_[g]);
            for (const auto& block : c.blocks) timed.launches.push_back(block[g].times.front());
        }
    return all;
}

std::vector<Json> Estimator::subject() const {
    std::vector<Json> all;
    for (const Case& c : cases_) all.push_back(c.subject(blocks_));
    return all;
}

}  // namespace raycache::tools
