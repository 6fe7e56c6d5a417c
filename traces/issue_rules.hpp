// The rules of WarpTrace::issue, for whoever writes, reads or replays it.
#pragma once

#include <cstdint>
#include <span>

#include "traces/record.hpp"

namespace raycache::traces {

/// Most steps of a warp of so many accesses: each access is waited for once, and between two there is one wait for
/// nothing.
constexpr std::uint64_t most_issue_steps(std::uint64_t accesses) { return accesses == 0 ? 0 : 2 * accesses + 1; }

/// What is wrong with the steps of a warp of so many accesses; nullptr: nothing.
constexpr const char* issue_fault(std::span<const IssueStep> steps, std::uint32_t accesses) {
    if (steps.size() > most_issue_steps(accesses))
        return "expected at most two issue steps an access and one, found more";
    std::uint32_t before = 0;
    for (const IssueStep& step : steps) {
        if (step.access < before || step.access > accesses)
            return "expected issue steps in the order of the accesses, found one elsewhere";
        if (step.needs > step.access)
            return "expected an issue step to wait for an access before it, found a later one";
        before = step.access;
    }
    if (accesses != 0 && (steps.empty() || before != accesses))
        return "expected the last issue step behind all accesses, found none there";
    return nullptr;
}

}  // namespace raycache::traces
