#include "tools/jobs/windows/windowed_case.hpp"

#include <algorithm>
#include <set>

#include "tools/jobs/windows/launch_extent.hpp"

namespace raycache::tools {

std::vector<WindowedStrategy> strategies_of(const LaunchSettings& launches) {
    std::vector<WindowedStrategy> all;
    const auto captures = launches.captures();
    for (std::size_t i = 0; i < captures.size(); ++i)
        all.push_back({captures[i], launches.cases[i].strategy, of_case(launches.scene, launches.cases[i]).layout});
    return all;
}

std::uint32_t common_indices(const std::vector<WindowedStrategy>& strategies) {
    std::uint32_t most = 1;
    for (const WindowedStrategy& s : strategies) most = std::max(most, launch_grid_of(s.capture).samples_per_launch());
    return most;
}

WindowedCase make_case(const tracer::PreparedScene& scene, const WindowedStrategy& strategy, const WindowSizes& sizes,
                       std::uint64_t drawing, std::uint32_t blocks, std::uint32_t grain) {
    tracer::CaptureSettings settings = strategy.capture;
    const tracer::LaunchGrid grid = launch_grid_of(settings);
    const tracer::SampleSet& samples = settings.strategy.samples;
    constexpr std::uint64_t golden = 0x9e3779b97f4a7c15;  // bits of drawings that follow each other differ widely
    const std::uint64_t seed = samples.seed ^ drawing * golden;
    WindowedCase c{{}, {samples.spp, grid.warps(), grid.samples_per_launch(), seed, sizes, grain}, {}, {}};
    c.first = c.plan.draw(blocks);
    for (const std::uint32_t first : c.first)
        for (std::uint32_t launch = 0; launch < c.plan.launches(); ++launch)
            settings.first_indices.push_back(first + launch * grid.samples_per_launch());
    c.capture = std::make_unique<tracer::Capture>(scene.in_layout(strategy.layout), settings);
    tracer::StrategyName name = tracer::strategy_name(c.capture->header().provenance);
    name.take_from(strategy.given);
    c.name = to_string(name);
    return c;
}

Json WindowedCase::subject(std::uint32_t blocks) const {
    traces::Header header = capture->header();
    std::set<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < blocks * plan.launches(); ++i) indices.insert(header.launches[i]);
    header.launches.assign(indices.begin(), indices.end());
    return trace_json(header, "");
}

}  // namespace raycache::tools
