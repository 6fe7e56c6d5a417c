#include "tools/jobs/launches.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/jobs/windows/launch_extent.hpp"
#include "tracer/sampling/sampling_strategy.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

void LaunchSettings::check() const {
    if (of_traces()) {
        if (!scene.source.empty())
            throw UsageError(fmt::format("'{}' is a scene and '{}' a trace; expected either one scene or trace files",
                                         scene.source, traces.front()));
        return;
    }
    if (scene.source.empty()) throw UsageError("neither a scene nor traces; expected one of them");
    if (cases.empty()) throw UsageError(fmt::format("scene {} without a case; expected at least one", scene.source));
    captures();
}

std::vector<tracer::CaptureSettings> LaunchSettings::captures() const {
    if (of_traces()) return {};
    return capture_settings(scene, sampling, cases);
}

std::uint32_t pair_launches(std::vector<tracer::CaptureSettings>& captures) {
    std::uint32_t most = 1, least = ~0U;
    for (const tracer::CaptureSettings& c : captures) {
        const std::uint32_t each = launch_grid_of(c).samples_per_launch();
        most = std::max(most, each);
        least = std::min(least, each);
    }
    if (most <= least) return 1;
    for (tracer::CaptureSettings& c : captures) {
        const std::uint64_t spp = c.strategy.samples.spp;
        c.first_indices.clear();
        std::vector<std::uint32_t> groups = tracer::choose_sample_indices(
            (spp + most - 1) / most, (c.trace_samples + most - 1) / most, c.strategy.samples.seed);
        c.trace_samples = std::min<std::uint64_t>(spp, groups.size() * most);
        for (const std::uint64_t group : groups)
            for (std::uint64_t i = group * most; i < std::min(spp, (group + 1) * most);
                 i += launch_grid_of(c).samples_per_launch())
                c.first_indices.push_back(static_cast<std::uint32_t>(i));
    }
    return most;
}

std::vector<std::unique_ptr<JoinedLaunches>> join_launches(std::vector<LaunchSource>& sources, std::uint32_t indices) {
    std::vector<std::unique_ptr<JoinedLaunches>> joined;
    for (LaunchSource& source : sources) {
        if (source.indices >= indices) continue;
        joined.push_back(std::make_unique<JoinedLaunches>(source, indices / source.indices));
        source = joined.back()->source;
    }
    return joined;
}

Launches::Launches(const LaunchSettings& settings, const FileNames& outputs, Observer& observer)
    : of_traces_(settings.of_traces()) {
    settings.check();
    if (of_traces_) {
        refuse_overwriting(settings.traces, outputs);
        names_ = settings.traces;
        files_ = std::make_unique<TraceFiles>(settings.traces);
        sources_ = files_->sources;
        return;
    }
    auto captures = settings.captures();
    const std::uint32_t indices = pair_launches(captures);
    warn_of_strategies(captures, observer);
    scene_ = settings.scene.prepare(outputs, observer);
    for (std::size_t i = 0; i < captures.size(); ++i)
        captures_.push_back(std::make_unique<tracer::Capture>(
            scene_->in_layout(of_case(settings.scene, settings.cases[i]).layout), captures[i]));
    sources_ = sources_of(captures_);
    for (std::size_t i = 0; i < sources_.size(); ++i) {
        const tracer::StrategyName& given = settings.cases[i].strategy;
        names_.push_back(to_string(given));
        sources_[i].strategy.take_from(given);
    }
    joined_ = join_launches(sources_, indices);
}

std::vector<Json> Launches::subject() const {
    std::vector<Json> all;
    for (std::size_t i = 0; i < sources_.size(); ++i)
        all.push_back(trace_json(*sources_[i].header, of_traces_ ? names_[i] : ""));
    return all;
}

}  // namespace raycache::tools
