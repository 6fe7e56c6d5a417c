#include "tools/jobs/windows/explain_windows.hpp"

#include <algorithm>

#include "tools/jobs/explained_pair.hpp"
#include "tools/jobs/windows/estimator.hpp"

namespace raycache::tools {
namespace {

using cachesim::Explanation;

/// The counts and findings of one of the two.
void fill(cachesim::ExplainedTrace& trace, const Estimator::Case& from) {
    for (const auto& block : from.blocks) trace.launches.push_back(block.front().counts);
    trace.findings = from.findings.front();
}

void fill(cachesim::SpeedUp& s, std::size_t ideal, const Estimator::Case& base, const Estimator::Case& other) {
    for (std::size_t b = 0; b < base.blocks.size(); ++b) {
        const auto &of_base = base.blocks[b].front().times[ideal], &of_other = other.blocks[b].front().times[ideal];
        s.base += of_base;
        s.other += of_other;
        s.base_cycles[b] = static_cast<double>(of_base.cycles);
        s.other_cycles[b] = static_cast<double>(of_other.cycles);
    }
}

}  // namespace

ExplainResult explain_windows(const ExplainJob& job, const cachesim::Gpu& gpu, Observer& observer,
                              const FileNames& outputs) {
    const auto start = Estimator::Clock::now();
    warn_of_strategies(job.launches.captures(), observer);
    const auto scene = job.launches.scene.prepare(outputs, observer);
    const std::vector<cachesim::Gpu> gpus{gpu};
    const bool timed = gpu.timing && job.timed && cachesim::no_time_note(gpu).empty();
    std::vector<cachesim::Idealised> ideals;
    if (timed)
        for (const cachesim::NamedIdeal& ideal : cachesim::idealised_replays()) ideals.push_back(ideal.ideal);
    Estimator estimator(*scene, strategies_of(job.launches), job.estimate, gpus, ideals, true, observer);
    const Estimator::Case &base = estimator.cases()[0], &other = estimator.cases()[1];
    ExplainedPair pair;
    for (std::size_t i = 0; i < 2; ++i)
        pair[i] = {&estimator.cases()[i].capture->header(), job.launches.cases[i].strategy, estimator.cases()[i].name};
    Explanation explanation = begin_explanation(pair, gpu, job.by);

    estimator.run(base.name, start);

    if (gpu.timing && job.timed) predict_speed_ups(explanation, gpu, base.blocks.size());
    fill(explanation.base, base);
    fill(explanation.other, other);
    cachesim::WindowSample& windows = explanation.windows.emplace(*estimator.origin(base, 0).windows);
    const cachesim::WindowSample of_other = *estimator.origin(other, 0).windows;
    windows.last_cache_full &= of_other.last_cache_full;
    windows.unfilled_share = std::max(windows.unfilled_share, of_other.unfilled_share);
    for (std::size_t i = 0; i < explanation.speed_ups.size(); ++i) {
        fill(explanation.speed_ups[i], i, base, other);
        explanation.speed_ups[i].widening = windows.widening;
    }
    return {{{gpu_json(gpu)}, estimator.subject()}, std::move(explanation), {}};
}

}  // namespace raycache::tools
