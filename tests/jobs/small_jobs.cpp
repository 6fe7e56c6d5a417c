#include "tests/jobs/small_jobs.hpp"

#include "traces/error.hpp"

namespace raycache::test {

tools::LaunchSettings small_launches(const std::vector<std::string>& strategies) {
    tools::LaunchSettings launches;
    launches.scene.source = "courtyard";
    launches.scene.detail = 50000;
    launches.sampling.resolution = "32x24";
    launches.sampling.trace_samples = 2;
    for (const std::string& strategy : strategies)
        launches.cases.push_back({tracer::parse_strategy_name(strategy), "sobol", 4, {}, {}});
    return launches;
}

std::string refusal_of_job(const std::string& text) {
    try {
        tools::parse_job(text, "cell 7");
        return {};
    } catch (const Error& e) {
        return e.what();
    }
}

}  // namespace raycache::test
