// What a job replays: trace files, or captures of a scene made on the fly.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/jobs/launch_source.hpp"
#include "tools/jobs/sampling_settings.hpp"
#include "tools/jobs/subject.hpp"

namespace raycache::tools {

/// Trace files, or a scene and at least one case of it.
struct LaunchSettings {
    std::vector<std::string> traces;
    SceneSettings scene;
    SamplingSettings sampling;
    std::vector<CaseSettings> cases;

    bool of_traces() const { return !traces.empty(); }
    /// Throws UsageError for traces and a scene, for neither, and as capture_settings() does.
    void check() const;
    /// Of the cases; none of traces.
    std::vector<tracer::CaptureSettings> captures() const;
};

/// Where a launch of some thread maps holds more sample indices than one of others (32 of `samples`): all captures get
/// the same sample indices, in whole groups of as many, rounded up. Returns the indices of a group, so that launches
/// can be joined to the same work (JoinedLaunches); 1 where all maps are alike, and then nothing is changed.
std::uint32_t pair_launches(std::vector<tracer::CaptureSettings>&);

/// Joins launches of sources that hold fewer indices than that, in place. The result must outlive them.
std::vector<std::unique_ptr<JoinedLaunches>> join_launches(std::vector<LaunchSource>&, std::uint32_t indices);

/// The launches themselves, ready to be delivered, as long as this object lives.
class Launches {
public:
    /// Opens the traces or loads the scene, and warns. Throws as LaunchSettings::check(), traces::Reader and
    /// SceneSettings::prepare() do.
    Launches(const LaunchSettings&, const FileNames& outputs, Observer&);

    const std::vector<LaunchSource>& sources() const { return sources_; }
    /// For messages: files or strategies.
    const std::vector<std::string>& names() const { return names_; }
    /// trace_json() of each.
    std::vector<Json> subject() const;

private:
    bool of_traces_;
    std::vector<std::string> names_;
    std::unique_ptr<TraceFiles> files_;
    std::unique_ptr<tracer::PreparedScene> scene_;
    std::vector<std::unique_ptr<tracer::Capture>> captures_;
    std::vector<std::unique_ptr<JoinedLaunches>> joined_;
    std::vector<LaunchSource> sources_;
};

}  // namespace raycache::tools
