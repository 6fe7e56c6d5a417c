// --cache-equivalent: what compare and explain also say of cache sizes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/jobs/cache_equivalents.hpp"
#include "tools/jobs/windows/estimate.hpp"
#include "tools/program/command.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

/// `without`: options whose results have no place for it.
inline void add_cache_equivalent(Command& command, bool& asked, std::vector<std::string> without) {
    command
        .add_flag("--cache-equivalent", asked,
                  "also which size of L1, and how much more bandwidth, the baseline would need to do as well; of whole "
                  "launches, which are replayed once more (raycache curve says more)")
        ->excludes(std::move(without));
}

/// Throws UsageError for windows.
inline void check_whole_launches(const EstimateSettings& estimate) {
    if (estimate.windows)
        throw UsageError("--cache-equivalent of windows; expected whole launches: add --exact or --trace-samples");
}

}  // namespace raycache::tools
