#include "tools/jobs/explain_job.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/jobs/costs.hpp"
#include "tools/jobs/explain_launches.hpp"
#include "tools/jobs/windows/explain_windows.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

void ExplainJob::check() const {
    if (launches.of_traces() && launches.traces.size() != 2)
        throw UsageError(fmt::format("{} trace file{}; expected two: BASE and OTHER", launches.traces.size(),
                                     launches.traces.size() == 1 ? "" : "s"));
    if (!launches.of_traces() && launches.cases.size() != 2) {
        std::vector<std::string> names;
        for (const CaseSettings& c : launches.cases) names.push_back(to_string(c.strategy));
        throw UsageError(fmt::format("--strategy '{}': expected two names, BASE,OTHER, found {}", fmt::join(names, ","),
                                     names.size()));
    }
    launches.check();
    if (!estimate.windows) return;
    check_windows(launches, estimate);
    if (pixels) throw UsageError("heat maps of windows; expected whole launches: windows leave most pixels out");
}

ExplainResult run(const ExplainJob& job, const cachesim::Gpu& gpu, Observer& observer, const FileNames& outputs) {
    job.check();
    if (job.estimate.windows) return explain_windows(job, gpu, observer, outputs);
    if (!job.launches.of_traces()) {
        double seconds = 0;
        for (const auto& s : job.launches.captures())
            seconds += trace_cost(s) + explain_cost(s, gpu.timing && job.timed);
        observer.expect("explain", Work::replay, seconds);
    }
    const Launches launches(job.launches, outputs, observer);
    const auto& sources = launches.sources();
    for (std::size_t i = 0; i < 2; ++i) refuse_wavefront(*sources[i].header, launches.names()[i], "explain");
    ExplainRequest request;
    request.sources = {&sources[0], &sources[1]};
    request.pair = {{{sources[0].header, sources[0].strategy, launches.names()[0]},
                     {sources[1].header, sources[1].strategy, launches.names()[1]}}};
    request.gpu = gpu;
    request.by = job.by;
    request.timed = job.timed;
    request.pixels = job.pixels;
    Explained done = explain(request, observer);
    ExplainResult result{{{gpu_json(gpu)}, launches.subject()}, std::move(done.explanation), {}};
    const cachesim::Explanation& e = result.explanation;
    if (job.pixels)
        result.maps = {make_heat_map(e.base.name, *sources[0].header, done.costs[0], gpu),
                       make_heat_map(e.other.name, *sources[1].header, done.costs[1], gpu)};
    return result;
}

ExplainResult run(const ExplainJob& job, Observer& observer, const FileNames& outputs) {
    job.check();
    const cachesim::Gpu gpu = job.gpu.load_one(outputs, "explain");
    if (gpu.timing && job.timed) job.gpu.check_timed({gpu});
    return run(job, gpu, observer, outputs);
}

}  // namespace raycache::tools
