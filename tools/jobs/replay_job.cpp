#include "tools/jobs/replay_job.hpp"

#include "tools/jobs/costs.hpp"
#include "tools/jobs/replay_launches.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

namespace {

void say_resumable(const ReplayJob& job, Observer& observer) {
    if (job.launches.of_traces()) return;
    observer.resumable(
        "nothing can be resumed: run the same command again, or keep traces with 'raycache capture' and compare "
        "those");
}

/// Of whole launches.
void say_costs(const ReplayJob& job, std::size_t gpus, Observer& observer) {
    if (job.launches.of_traces()) return;
    double seconds = 0;
    auto captures = job.launches.captures();
    pair_launches(captures);
    for (const auto& s : captures) seconds += trace_cost(s) + static_cast<double>(gpus) * replay_cost(s, job.timed);
    observer.expect("replay", job.timed ? Work::timed_replay : Work::replay, seconds);
}

Subject subject_of(const Launches& launches, const std::vector<cachesim::Gpu>& gpus) {
    Subject subject;
    for (const cachesim::Gpu& gpu : gpus) subject.gpus.push_back(gpu_json(gpu));
    subject.traces = launches.subject();
    return subject;
}

}  // namespace

ProfileResult profile(const ReplayJob& job, const std::vector<cachesim::Gpu>& gpus, Observer& observer,
                      const FileNames& outputs) {
    say_resumable(job, observer);
    say_costs(job, gpus.size(), observer);
    const Launches launches(job.launches, outputs, observer);
    return {subject_of(launches, gpus), profile(launches.sources(), gpus, job.timed, observer)};
}

ReplayResult run(const ReplayJob& job, const std::vector<cachesim::Gpu>& gpus, Observer& observer,
                 const FileNames& outputs) {
    if (gpus.empty()) throw UsageError("no GPU; expected at least one");
    say_resumable(job, observer);
    if (job.estimate.windows) {
        Estimated estimated = estimate(job.launches, job.estimate, gpus, job.timed, observer, outputs);
        return {std::move(estimated.subject), std::move(estimated.result.traffic), std::move(estimated.result.times),
                std::move(estimated.cold), std::move(estimated.fidelity)};
    }
    say_costs(job, gpus.size(), observer);
    const Launches launches(job.launches, outputs, observer);
    ReplayResult result;
    result.subject = subject_of(launches, gpus);
    if (job.timed) {
        Predicted both = predict(launches.sources(), gpus, observer);
        result.series = std::move(both.traffic);
        result.times = std::move(both.times);
    } else {
        result.series = replay(launches.sources(), gpus, observer);
    }
    return result;
}

ReplayResult run(const ReplayJob& job, Observer& observer, const FileNames& outputs) {
    job.launches.check();
    const auto gpus = job.gpu.load(outputs);
    if (job.timed) job.gpu.check_timed(gpus);
    return run(job, gpus, observer, outputs);
}

}  // namespace raycache::tools
