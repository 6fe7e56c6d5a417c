#include "tools/jobs/cache_equivalents.hpp"

#include "tools/jobs/baseline.hpp"
#include "tools/jobs/curve_job.hpp"

namespace raycache::tools {

std::vector<std::string> cache_equivalents(const LaunchSettings& launches, const std::vector<cachesim::Gpu>& gpus,
                                           const std::optional<std::string>& baseline, Observer& observer) {
    std::vector<std::string> sentences;
    for (const cachesim::Gpu& gpu : gpus) {
        CurveJob job;
        job.launches = launches;
        job.levels = {0};
        CurveResult result = run(job, gpu, observer);
        const std::string of = baseline ? baseline_strategy(result.series, *baseline) : result.series.front().strategy;
        const cachesim::CurveReport report = cachesim::make_curve_report(std::move(result.series), of, {});
        for (const cachesim::Equivalent& e : report.equivalents)
            sentences.push_back((gpus.size() > 1 ? gpu.name + ", " : "") + to_sentence(e));
    }
    return sentences;
}

}  // namespace raycache::tools
