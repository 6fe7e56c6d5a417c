// --target-error, --time-budget, --windows, --exact: how certain an answer must be, or that it be of whole launches.
#pragma once

#include <string>

#include "tools/jobs/windows/estimate.hpp"
#include "tools/program/command.hpp"
#include "tools/program/options.hpp"

namespace raycache::tools {

struct EstimateOptions {
    std::string target_error = "5%";
    double time_budget = 0;
    std::uint64_t windows = 0;
    bool exact = false;

    /// `when_timed`: an option that makes --target-error be about something else, and what.
    void add(Command&, const std::string& when_timed);

    /// From windows, unless the user asks for whole launches (--exact, --trace-samples, --counters, --heatmap) or
    /// something in `launches` has no windows: then `why_exact` becomes a line to warn of. Sets the resolution of a
    /// real picture where the user gives none.
    EstimateSettings settings(const Command&, LaunchSettings&, std::string& why_exact) const;
};

/// Of the picture whose windows are replayed, where the user gives none.
inline constexpr const char* window_resolution = "1920x1080";

/// "2%", "0.5 %": 0.02, 0.005. Throws UsageError.
double parse_percentage(const std::string& text, const std::string& what);

}  // namespace raycache::tools
