#include "tracer/strategy_groups.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/strategy_name.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {

const std::vector<StrategyGroup>& strategy_groups() {
    static const std::vector<StrategyGroup> all{
        // Which map goes with what: tracer/simt/thread_map.hpp (rows). Off, the pattern is Owen-scrambled per pixel
        // (kernel/sample/tabulated_sobol.h) and a warp holds sample indices of one pixel.
        {"cycles",
         "Blender's Scrambling Distance as Cycles runs it: off, automatic, and multipliers 0.5, 0.25, 0.1 of that",
         {"owen@samples", "scrambling-distance@rows", "scrambling-distance:cycles-multiplier=0.5@rows",
          "scrambling-distance:cycles-multiplier=0.25@rows", "scrambling-distance:cycles-multiplier=0.1@rows"}},
    };
    return all;
}

const StrategyGroup* find_strategy_group(const std::string& name) {
    for (const StrategyGroup& group : strategy_groups())
        if (group.name == name) return &group;
    return nullptr;
}

namespace {

/// What is no strategy, but nearly a group, is a misspelt group, or one with parts that only strategies have.
void refuse_misspelt_group(const std::string& name) {
    const std::string strategy = parse_strategy_name(name).decorrelation;
    std::vector<std::string> strategies, groups;
    for (const DecorrelationEntry& entry : decorrelations()) strategies.push_back(entry.name);
    if (!closest_name(strategy, strategies).empty()) return;
    for (const StrategyGroup& group : strategy_groups()) groups.push_back(group.name);
    if (find_strategy_group(strategy) != nullptr)
        throw UsageError(
            fmt::format("strategy '{}': '{}' is a group, whose strategies have their own parameters and "
                        "thread maps; expected '{}' alone",
                        name, strategy, strategy));
    if (const std::string hint = did_you_mean(strategy, groups); !hint.empty())
        throw UsageError(
            fmt::format("unknown strategy '{}'; expected a strategy or a group of strategies{}", name, hint));
}

}  // namespace

std::vector<std::string> expand_groups(const std::vector<std::string>& names) {
    std::vector<std::string> all;
    const auto add = [&](const std::string& name) {
        if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    };
    for (const std::string& name : names) {
        const StrategyGroup* const group = find_strategy_group(name);
        if (group == nullptr) {
            refuse_misspelt_group(name);
            add(name);
        } else {
            for (const std::string& member : group->members) add(member);
        }
    }
    return all;
}

std::optional<std::string> baseline_of_groups(const std::vector<std::string>& names) {
    if (std::find(names.begin(), names.end(), "cranley-patterson") != names.end()) return std::nullopt;
    for (const std::string& name : names)
        if (const StrategyGroup* const group = find_strategy_group(name)) return group->members.front();
    return std::nullopt;
}

}  // namespace raycache::tracer
