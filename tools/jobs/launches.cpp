#include "tools/jobs/launches.hpp"

#include <fmt/format.h>

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
    const auto captures = settings.captures();
    warn_of_strategies(captures, observer);
    scene_ = settings.scene.prepare(outputs, observer);
    for (std::size_t i = 0; i < captures.size(); ++i)
        captures_.push_back(std::make_unique<tracer::Capture>(
            scene_->in_layout(of_case(settings.scene, settings.cases[i]).layout), captures[i]));
    sources_ = sources_of(captures_);
    for (std::size_t i = 0; i < sources_.size(); ++i) {
        const tracer::StrategyName& given = settings.cases[i].strategy;
        names_.push_back(to_string(given));
        sources_[i].strategy.thread_map = given.thread_map;
    }
}

std::vector<Json> Launches::subject() const {
    std::vector<Json> all;
    for (std::size_t i = 0; i < sources_.size(); ++i)
        all.push_back(trace_json(*sources_[i].header, of_traces_ ? names_[i] : ""));
    return all;
}

}  // namespace raycache::tools
