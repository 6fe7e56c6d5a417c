// A replay of windows until the answer is certain enough: what compare, explain and sweep ask unless they are told to
// replay whole launches.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/jobs/launches.hpp"
#include "tools/jobs/replay_launches.hpp"
#include "tools/jobs/windows/window_plan.hpp"

namespace raycache::tools {

/// Of a strategy.
inline constexpr std::uint32_t most_blocks = 512;

/// Which level of accuracy predicts speed-ups.
enum class Fidelity {
    windows,    ///< windows, functional or in time
    automatic,  ///< the cheapest that reaches target_error: fidelity.hpp
    exact,      ///< all of the picture in the steady state: steady_replay.hpp
};

struct EstimateSettings {
    bool windows = false;  ///< else whole launches, each from cold caches
    /// Half width of the 95 % interval of each ratio to the baseline (of each mean where nothing is compared), over
    /// it: 0 … 1. In time, of speed-ups alone; else of bytes per ray of every level.
    double target_error = 0.05;
    double time_budget = 0;          ///< seconds, the scene's loading included; no blocks that would end later; 0: none
    std::uint64_t window_count = 0;  ///< windows of each strategy, whatever the error; 0: by the two above
    std::string baseline;            ///< what target_error is about; empty: cranley-patterson where it is compared
    bool across_gpus = false;        ///< ratios of all variants of a GPU to the baseline on the first
    /// So many whole launches of each strategy besides, of the same sample indices, each from cold caches.
    std::uint64_t cold_launches = 0;
    Fidelity fidelity = Fidelity::windows;  ///< others only in time

    /// Throws UsageError for values out of range.
    void check() const;
};

struct Estimated {
    Subject subject;
    Predicted result;  ///< times: only if asked for
    std::optional<cachesim::FidelityChoice> fidelity;
    std::vector<cachesim::ColdLaunches> cold;  ///< of each series; none unless asked for
};

/// Throws UsageError for traces, wavefronts and settings that make no sense.
void check_windows(const LaunchSettings&, const EstimateSettings&);

/// Throws as check_windows() and as Launches do. The same result for any number of threads, unless there is a time
/// budget.
Estimated estimate(const LaunchSettings&, const EstimateSettings&, const std::vector<cachesim::Gpu>&, bool timed,
                   Observer&, const FileNames& outputs);

/// Whether all of it can be estimated from windows: a scene, and megakernels.
bool has_windows(const LaunchSettings&);

}  // namespace raycache::tools
