#include "tools/jobs/windows/estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/jobs/windows/cold_launches.hpp"
#include "tools/jobs/windows/estimator.hpp"
#include "tools/jobs/windows/fidelity.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

void EstimateSettings::check() const {
    if (!(target_error > 0 && target_error <= 1))
        throw UsageError(
            fmt::format("target error {:g} %; expected more than 0 and at most 100 %", 100 * target_error));
    if (!(time_budget >= 0 && std::isfinite(time_budget)))
        throw UsageError(fmt::format("time budget {} s; expected 0 or more", time_budget));
    constexpr std::uint64_t most_windows = std::uint64_t{most_blocks} * WindowSizes{}.windows;
    if (window_count == 1 || window_count > most_windows)
        throw UsageError(fmt::format("{} window{}; expected 2 (an interval takes two) to {}", window_count,
                                     window_count == 1 ? "" : "s", most_windows));
}

bool has_windows(const LaunchSettings& launches) {
    if (launches.of_traces()) return false;
    const auto captures = launches.captures();
    return std::all_of(captures.begin(), captures.end(), [](const tracer::CaptureSettings& c) {
        return c.execution.execution == tracer::Execution::megakernel;
    });
}

void check_windows(const LaunchSettings& launches, const EstimateSettings& settings) {
    settings.check();
    launches.check();
    if (!has_windows(launches))
        throw UsageError(
            "windows of traces or wavefronts; expected a scene and --execution megakernel: the windows of an estimate "
            "are traced where they are wanted");
    if (settings.cold_launches > 0) check_cold_launches(strategies_of(launches), settings.cold_launches);
}

namespace {

Estimated estimate_from_windows(const tracer::PreparedScene& scene, const std::vector<WindowedStrategy>& strategies,
                                const EstimateSettings& settings, const std::vector<cachesim::Gpu>& gpus, bool timed,
                                Observer& observer, Estimator::Clock::time_point start) {
    Estimator estimator(scene, strategies, settings, gpus, std::vector<cachesim::Idealised>(timed ? 1 : 0), false,
                        observer);
    estimator.run(settings.baseline, start);
    Estimated out;
    out.subject.traces = estimator.subject();
    out.result = estimator.result();
    return out;
}

}  // namespace

Estimated estimate(const LaunchSettings& launches, const EstimateSettings& settings,
                   const std::vector<cachesim::Gpu>& gpus, bool timed, Observer& observer, const FileNames& outputs) {
    check_windows(launches, settings);
    check_fidelity(settings, gpus, timed);
    const auto start = Estimator::Clock::now();
    warn_of_strategies(launches.captures(), observer);
    const auto scene = launches.scene.prepare(outputs, observer);
    const std::vector<WindowedStrategy> strategies = strategies_of(launches);
    if (settings.cold_launches > 0) expect_cold_launches(strategies, settings.cold_launches, gpus, timed, observer);
    Estimated out = settings.fidelity == Fidelity::windows
                        ? estimate_from_windows(*scene, strategies, settings, gpus, timed, observer, start)
                        : estimate_at_fidelity(*scene, strategies, settings, gpus, observer);
    for (const cachesim::Gpu& gpu : gpus) out.subject.gpus.push_back(gpu_json(gpu));
    if (settings.cold_launches > 0)
        out.cold = replay_cold_launches(*scene, strategies, settings.cold_launches, gpus, timed, observer);
    return out;
}

}  // namespace raycache::tools
