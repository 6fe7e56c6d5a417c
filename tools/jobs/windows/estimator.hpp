// Strategies of one scene, replayed block by block until the answer is certain enough.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/jobs/observer.hpp"
#include "tools/jobs/replay_launches.hpp"
#include "tools/jobs/subject.hpp"
#include "tools/jobs/windows/estimate.hpp"
#include "tools/jobs/windows/stop_rule.hpp"
#include "tools/jobs/windows/window_replay.hpp"
#include "tools/jobs/windows/windowed_case.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::tools {

/// What a measurement of estimates themselves may choose (tools/bench/tradeoff).
struct WindowChoice {
    WindowSizes sizes;
    std::uint64_t drawing = 0;  ///< another number: other blocks and places of the same samples
};

class Estimator {
public:
    using Clock = std::chrono::steady_clock;

    /// One of the strategies, and what its windows said.
    struct Case : WindowedCase {
        std::unique_ptr<cachesim::ElementDepth> depth;  ///< if findings are wanted
        std::vector<std::vector<BlockResult>> blocks;   ///< by block, then GPU; without findings
        std::vector<cachesim::Findings> findings;       ///< by GPU, of all blocks together; none unless asked for
    };

    /// `ideals`: a replay in time each. `gpus` and the observer must outlive the estimator.
    Estimator(const tracer::PreparedScene&, const std::vector<WindowedStrategy>&, const EstimateSettings&,
              const std::vector<cachesim::Gpu>& gpus, std::vector<cachesim::Idealised> ideals, bool findings, Observer&,
              const WindowChoice& = {});

    /// Replays blocks until the settings are satisfied, once. `baseline`: that of the settings, or another strategy.
    /// `start`: when the time budget began.
    void run(const std::string& baseline, Clock::time_point start);
    /// Replays until there are `end` blocks, more than before, and tells how certain that is. Look number k, from 1,
    /// may err in a share 0.05 / 2^k of all cases, so that all of them together err in less than 0.05: the union bound.
    Worst look(std::uint32_t end, const std::string& baseline);
    /// Where a picture is smaller than what a GPU holds at once.
    void warn_of_pictures() const;
    /// Tells the observer that these blocks are to come.
    void expect(std::uint32_t begin, std::uint32_t end);
    /// Modelled seconds of CPU of one block of all strategies: of everything, and of tracing its work alone.
    double block_cost() const;
    double work_cost() const;

    const std::vector<Case>& cases() const { return cases_; }
    /// In the order of cases, then GPUs; times of the first of the ideals.
    Predicted result() const;
    /// What the windows of a case are of, on a GPU.
    cachesim::Origin origin(const Case&, std::size_t gpu) const;
    /// trace_json() of each case, with the sample indices that were drawn.
    std::vector<Json> subject() const;

private:
    void expect_further(std::uint32_t end, double error);
    void run_blocks(std::uint32_t end);
    std::string how_far() const;
    void spend_budget(const std::string& baseline, Clock::time_point start);

    EstimateSettings settings_;
    const std::vector<cachesim::Gpu>& gpus_;
    std::vector<cachesim::Idealised> ideals_;
    Observer& observer_;
    WindowSizes sizes_;
    std::vector<Case> cases_;
    std::uint32_t blocks_ = 0;
    Worst worst_;           ///< after the last look
    double error_of_look_;  ///< that the intervals of this look may have
};

}  // namespace raycache::tools
