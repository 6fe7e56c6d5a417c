// Strategies that are asked for together by one name: what a renderer offers as the settings of one thing.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace raycache::tracer {

struct StrategyGroup {
    std::string name, description;
    /// Names of strategies (strategy_name.hpp), each once. The first is what the others are held against where nobody
    /// says otherwise.
    std::vector<std::string> members;
};
/// A group is a row of the table in strategy_groups.cpp. None is called as a decorrelation is.
const std::vector<StrategyGroup>& strategy_groups();

/// Null for a name that is no group's.
const StrategyGroup* find_strategy_group(const std::string& name);

/// Each group replaced by its members, in place; no name twice. Throws UsageError for a misspelt group.
std::vector<std::string> expand_groups(const std::vector<std::string>& names);

/// The first member of the first group among the names, unless cranley-patterson is among them: that is a baseline
/// already.
std::optional<std::string> baseline_of_groups(const std::vector<std::string>& names);

}  // namespace raycache::tracer
