#include "tools/jobs/samples_job.hpp"

namespace raycache::tools {

tracer::StrategySettings SamplesJob::settings() const {
    return of_case(sampling, strategy).strategy(strategy.sequence, to_string(strategy.strategy), strategy.spp);
}

SamplesResult run(const SamplesJob& job, Observer& observer) {
    const Stage stage(observer, "points");
    SamplesResult result{make_sample_union(job.settings(), job.dimensions[0], job.dimensions[1], job.copies)};
    for (const std::string& line : result.samples.warnings) observer.warn(line);
    return result;
}

}  // namespace raycache::tools
