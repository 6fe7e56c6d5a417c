#include "tools/jobs/predict_times.hpp"

#include <algorithm>
#include <cmath>

#include "cachesim/analysis/estimate.hpp"
#include "tools/jobs/launches.hpp"
#include "tools/jobs/replay_launches.hpp"
#include "tools/jobs/windows/estimator.hpp"

namespace raycache::tools {
namespace {

tracer::CaptureSettings timed_settings(const QualityRequest& request, const QualityRow& row) {
    tracer::CaptureSettings settings = row.settings;
    if (request.time_width != 0) settings.width = request.time_width;
    if (request.time_height != 0) settings.height = request.time_height;
    return settings;
}

std::vector<cachesim::TimedSeries> replay_whole_launches(const tracer::PreparedScene& scene,
                                                         const QualityRequest& request,
                                                         const std::vector<QualityRow>& rows, Observer& observer) {
    std::vector<tracer::CaptureSettings> settings;
    for (const QualityRow& row : rows) settings.push_back(timed_settings(request, row));
    const std::uint32_t indices = pair_launches(settings);
    std::vector<std::unique_ptr<tracer::Capture>> captures;
    for (const tracer::CaptureSettings& one : settings)
        captures.push_back(std::make_unique<tracer::Capture>(scene, one));
    std::vector<LaunchSource> sources = sources_of(captures);
    const auto joined = join_launches(sources, indices);
    return replay_timed(sources, {*request.gpu}, observer);
}

std::vector<cachesim::TimedSeries> replay_windows(const tracer::PreparedScene& scene, const QualityRequest& request,
                                                  const std::vector<QualityRow>& rows, Observer& observer) {
    const auto start = Estimator::Clock::now();
    std::vector<WindowedStrategy> strategies;
    for (const QualityRow& row : rows) strategies.push_back({timed_settings(request, row), {}, scene.layout()});
    const std::vector<cachesim::Gpu> gpus{*request.gpu};
    Estimator estimator(scene, strategies, request.estimate, gpus, std::vector<cachesim::Idealised>(1), false,
                        observer);
    estimator.run(request.baseline, start);
    return estimator.result().times;
}

}  // namespace

void predict_times(const tracer::PreparedScene& scene, const QualityRequest& request, std::vector<QualityRow>& rows,
                   Observer& observer) {
    const cachesim::Gpu& gpu = *request.gpu;
    if (!cachesim::no_time_note(gpu).empty()) {
        for (QualityRow& row : rows) row.timing = {std::nan(""), std::nullopt, std::nullopt};
        observer.expect("replay", Work::timed_replay, 0);
        return;
    }
    const auto series = request.estimate.windows ? replay_windows(scene, request, rows, observer)
                                                 : replay_whole_launches(scene, request, rows, observer);
    std::vector<cachesim::Sums> cycles(rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
        double seconds = 0, samples = 0;
        for (const auto& launch : series[r].launches) {
            seconds += launch.seconds;
            samples += static_cast<double>(std::min<std::uint64_t>(series[r].indices, rows[r].spp()));
            cycles[r].y.push_back(static_cast<double>(launch.cycles));
            cycles[r].x.push_back(1);
        }
        rows[r].timing = {seconds / samples * static_cast<double>(rows[r].spp()), std::nullopt, series[r].windows};
    }
    const auto speed_up = [&](std::size_t base, std::size_t r) {
        return cachesim::widened(cachesim::ratio_to_baseline(cycles[base], cycles[r]),
                                 series[r].windows ? series[r].windows->widening : 1);
    };
    for (std::size_t r = 0; r < rows.size(); ++r) {
        if (rows[r].baseline && *rows[r].baseline != r) rows[r].timing->speed_up = speed_up(*rows[r].baseline, r);
        for (EqualError& against : rows[r].equal_error) against.speed_up = speed_up(against.baseline, r);
    }
}

}  // namespace raycache::tools
