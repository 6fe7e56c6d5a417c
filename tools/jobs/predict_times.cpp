#include "tools/jobs/predict_times.hpp"

#include <cmath>

#include "cachesim/analysis/estimate.hpp"
#include "tools/jobs/replay_launches.hpp"
#include "tools/jobs/windows/estimator.hpp"

namespace raycache::tools {
namespace {

std::vector<cachesim::TimedSeries> replay_whole_launches(const tracer::PreparedScene& scene, const cachesim::Gpu& gpu,
                                                         const std::vector<QualityRow>& rows, Observer& observer) {
    std::vector<std::unique_ptr<tracer::Capture>> captures;
    for (const QualityRow& row : rows) captures.push_back(std::make_unique<tracer::Capture>(scene, row.settings));
    return replay_timed(sources_of(captures), {gpu}, observer);
}

std::vector<cachesim::TimedSeries> replay_windows(const tracer::PreparedScene& scene, const QualityRequest& request,
                                                  const std::vector<QualityRow>& rows, Observer& observer) {
    const auto start = Estimator::Clock::now();
    std::vector<WindowedStrategy> strategies;
    for (const QualityRow& row : rows) strategies.push_back({row.settings, std::nullopt, scene.layout()});
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
                                                 : replay_whole_launches(scene, gpu, rows, observer);
    std::vector<cachesim::Sums> cycles(rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
        double seconds = 0, samples = 0;
        for (const auto& launch : series[r].launches) {
            seconds += launch.seconds;
            samples += 1;
            cycles[r].y.push_back(static_cast<double>(launch.cycles));
            cycles[r].x.push_back(1);
        }
        rows[r].timing = {seconds / samples * static_cast<double>(rows[r].spp()), std::nullopt, series[r].windows};
    }
    for (std::size_t r = 0; r < rows.size(); ++r)
        if (rows[r].baseline && *rows[r].baseline != r)
            rows[r].timing->speed_up =
                cachesim::widened(cachesim::ratio_to_baseline(cycles[*rows[r].baseline], cycles[r]),
                                  series[r].windows ? series[r].windows->widening : 1);
}

}  // namespace raycache::tools
