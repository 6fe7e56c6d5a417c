#include "tools/jobs/explain_launches.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <mutex>

#include "cachesim/analysis/explainer.hpp"
#include "cachesim/replay/replay.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "tools/jobs/heat_map.hpp"

namespace raycache::tools {

namespace {

using traces::Header;

/// The warps that are handed to all replays of a launch before the next are read.
constexpr std::size_t warps_at_once = 64;

/// 0 … count - 1, in any order and by several threads.
template <class Use>
void for_each(std::size_t count, const Use& use) {
    tbb::parallel_for(std::size_t{0}, count, use, tbb::simple_partitioner());
}

}  // namespace

Explained explain(const ExplainRequest& request, Observer& observer) {
    const cachesim::Gpu& gpu = request.gpu;
    const Header& first = *request.sources[0]->header;
    Explained done;
    cachesim::Explanation& explanation = done.explanation;
    explanation = begin_explanation(request.pair, gpu, request.by);

    std::array<std::unique_ptr<cachesim::ElementDepth>, 2> depths;
    std::array<cachesim::LanePixels, 2> pixels;
    std::array<cachesim::ExplainedTrace*, 2> traces{&explanation.base, &explanation.other};
    for (std::size_t t = 0; t < 2; ++t) {
        const Header& header = *request.sources[t]->header;
        if (request.pixels) pixels[t] = lane_pixels(header, request.pair[t].name);
        depths[t] = std::make_unique<cachesim::ElementDepth>(header.regions);
        traces[t]->launches.resize(header.launches.size());
    }
    if (gpu.timing && request.timed) predict_speed_ups(explanation, gpu, first.launches.size());

    const Stage stage(observer, "explain", 2 * std::uint64_t{first.warps_per_launch} * first.launches.size(), "rays");
    std::mutex mutex;
    const auto run_task = [&](std::size_t task) {
        const std::size_t t = task % 2;
        const auto launch = static_cast<std::uint32_t>(task / 2);
        const Header& header = *request.sources[t]->header;
        cachesim::Replay replay(gpu, header.regions, header.launches[launch]);
        cachesim::Explainer explainer(gpu, header.regions, *depths[t], request.pixels ? &pixels[t] : nullptr);
        replay.observe(explainer);
        std::vector<cachesim::TimedReplay> timed;
        for (const cachesim::SpeedUp& s : explanation.speed_ups)
            timed.emplace_back(gpu, header.regions, header.launches[launch], s.replay.ideal);
        std::vector<std::shared_ptr<const traces::WarpTrace>> warps;
        const auto push_all = [&] {
            const auto push_to = [&](auto& r) {
                for (const auto& warp : warps) r.push(warp);
            };
            for_each(1 + timed.size(), [&](std::size_t i) { i == 0 ? push_to(replay) : push_to(timed[i - 1]); });
            warps.clear();
        };
        request.sources[t]->deliver(launch, [&](traces::WarpTrace&& warp) {
            stage.add(1, count_rays(warp));
            warps.push_back(std::make_shared<const traces::WarpTrace>(std::move(warp)));
            if (warps.size() == warps_at_once) push_all();
        });
        push_all();
        std::vector<cachesim::TimedStatistics> times(timed.size());
        for_each(1 + timed.size(), [&](std::size_t i) {
            if (i == 0)
                traces[t]->launches[launch] = replay.finish();
            else
                times[i - 1] = timed[i - 1].finish();
        });
        const std::lock_guard lock(mutex);  // sums of whole numbers: in any order the same
        traces[t]->findings += explainer.findings();
        for (std::size_t i = 0; i < times.size(); ++i) {
            cachesim::SpeedUp& s = explanation.speed_ups[i];
            (t == 0 ? s.base : s.other) += times[i];
            (t == 0 ? s.base_cycles : s.other_cycles)[launch] = static_cast<double>(times[i].cycles);
        }
        if (request.pixels) done.costs[t] += explainer.pixel_costs();
    };
    // Each launch begins with cold caches, so launches are independent; but the replays of one launch share its warps,
    // so as many launches at once as keep the threads busy take the least memory.
    const std::size_t tasks = 2 * first.launches.size(), replays = 1 + explanation.speed_ups.size();
    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    const std::size_t at_once = replays == 1 ? tasks : (threads + replays - 1) / replays;
    for (std::size_t begin = 0; begin < tasks; begin += at_once)
        for_each(std::min(at_once, tasks - begin), [&](std::size_t i) { run_task(begin + i); });
    return done;
}

}  // namespace raycache::tools
