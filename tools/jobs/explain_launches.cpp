#include "tools/jobs/explain_launches.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <mutex>

#include "cachesim/analysis/explainer.hpp"
#include "cachesim/replay/replay.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "cachesim/report/origin.hpp"
#include "tools/jobs/heat_map.hpp"
#include "traces/error.hpp"
#include "traces/printable.hpp"

namespace raycache::tools {

namespace {

using traces::Header;
using traces::Provenance;

std::string list(const std::vector<std::uint32_t>& samples) {
    constexpr std::size_t most = 8;
    const std::vector<std::uint32_t> shown(
        samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(std::min(most, samples.size())));
    return fmt::format("{}{}", fmt::join(shown, ", "), samples.size() > most ? ", …" : "");
}

/// Ratios per ray mean something only between traces of the same rays but for the strategy.
void check_comparable(const ExplainRequest& request) {
    const Header &base = *request.sources[0]->header, &other = *request.sources[1]->header;
    const Provenance &a = base.provenance, &b = other.provenance;
    const auto same = [&](const char* what, const auto& expected, const auto& found) {
        if (expected == found) return;
        throw Error(fmt::format("{}: expected the {} of {}, {}, found {}; capture both alike but for the strategy",
                                request.names[1], what, request.names[0], expected, found));
    };
    same("scene", a.scene, b.scene);
    same("content of the scene", fmt::format("{:#018x}", a.scene_hash), fmt::format("{:#018x}", b.scene_hash));
    same("camera", a.camera, b.camera);
    same("resolution", fmt::format("{}x{}", a.width, a.height), fmt::format("{}x{}", b.width, b.height));
    same("number of bounces", a.bounces, b.bounces);
    if (!cachesim::same_work_per_launch(a.thread_map, b.thread_map)) same("thread map", a.thread_map, b.thread_map);
    if (base.launches == other.launches) return;
    const bool common = std::any_of(base.launches.begin(), base.launches.end(), [&](std::uint32_t sample) {
        return std::find(other.launches.begin(), other.launches.end(), sample) != other.launches.end();
    });
    throw Error(
        fmt::format("{}: expected the sample indices of {}, {}, found {}{}; capture both with the same --spp, "
                    "--seed and --trace-samples",
                    request.names[1], request.names[0], list(base.launches), common ? "" : "none of them but ",
                    list(other.launches)));
}

/// What tells each trace from the other: its strategy, and whatever else they were not given alike.
std::array<std::string, 2> names_of(const ExplainRequest& request) {
    const Provenance &a = request.sources[0]->header->provenance, &b = request.sources[1]->header->provenance;
    std::array<std::string, 2> names;
    const auto add = [&](const std::string& first, const std::string& second) {
        if (first == second) return;
        for (std::size_t i = 0; i < 2; ++i) names[i] += (names[i].empty() ? "" : " ") + (i == 0 ? first : second);
    };
    add(to_string(request.sources[0]->strategy), to_string(request.sources[1]->strategy));
    if (a.decorrelation == b.decorrelation) add(a.parameters, b.parameters);
    add(a.sequence, b.sequence);
    add(fmt::format("N={}", a.spp), fmt::format("N={}", b.spp));
    add(a.layout, b.layout);
    if (names[0].empty() || names[1].empty()) return {"base", "other"};
    return {printable_line(names[0]), printable_line(names[1])};
}

/// The warps that are handed to all replays of a launch before the next are read.
constexpr std::size_t warps_at_once = 64;

/// 0 … count - 1, in any order and by several threads.
template <class Use>
void for_each(std::size_t count, const Use& use) {
    tbb::parallel_for(std::size_t{0}, count, use, tbb::simple_partitioner());
}

}  // namespace

Explained explain(const ExplainRequest& request, Observer& observer) {
    check_comparable(request);
    const auto names = names_of(request);
    const cachesim::Gpu& gpu = request.gpu;
    const Header& first = *request.sources[0]->header;
    Explained done;
    cachesim::Explanation& explanation = done.explanation;
    explanation.scene = printable_line(first.provenance.scene);
    explanation.gpu = gpu.name;
    explanation.spp = first.provenance.spp;
    explanation.sector_bytes = gpu.l1().sector_bytes;
    explanation.by = request.by;

    std::array<std::unique_ptr<cachesim::ElementDepth>, 2> depths;
    std::array<cachesim::LanePixels, 2> pixels;
    std::array<cachesim::ExplainedTrace*, 2> traces{&explanation.base, &explanation.other};
    for (std::size_t t = 0; t < 2; ++t) {
        const Header& header = *request.sources[t]->header;
        if (request.pixels) pixels[t] = lane_pixels(header, request.names[t]);
        depths[t] = std::make_unique<cachesim::ElementDepth>(header.regions);
        traces[t]->name = names[t];
        traces[t]->launches.resize(header.launches.size());
    }
    if (gpu.timing && request.timed) explanation.no_time = cachesim::no_time_note(gpu);
    if (gpu.timing && request.timed && explanation.no_time.empty()) {
        const std::vector<double> none(first.launches.size());
        for (const cachesim::NamedIdeal& ideal : cachesim::idealised_replays())
            explanation.speed_ups.push_back({ideal, {}, {}, none, none});
    }

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
