// What ratios refer to where the user does not say.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "cachesim/report/origin.hpp"
#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/strategy_name.hpp"

namespace raycache::tools {

/// Not asked for: cranley-patterson, where it is among the strategies and there is something to hold against it; of one
/// strategy in several layouts the first. A default layout that is asked for by its name is no part of a series' name.
template <class Series>
std::string baseline_strategy(const std::vector<Series>& series, const std::string& asked) {
    if (!asked.empty()) {
        tracer::StrategyName name = tracer::parse_strategy_name(asked);
        if (name.layout == tracer::default_layout) name.layout.reset();
        return to_string(name);
    }
    const auto without_layout = [](const Series& s) { return s.strategy.substr(0, s.strategy.find('/')); };
    const auto is_usual = [&](const Series& s) { return without_layout(s) == "cranley-patterson"; };
    const auto is_first = [&](const Series& s) { return without_layout(s) == without_layout(series.front()); };
    const auto usual = std::find_if(series.begin(), series.end(), is_usual);
    const auto found =
        usual == series.end() && std::all_of(series.begin(), series.end(), is_first) ? series.begin() : usual;
    const auto is_found = [&](const Series& s) { return s.strategy == found->strategy; };
    return found == series.end() || std::all_of(series.begin(), series.end(), is_found) ? std::string()
                                                                                        : found->strategy;
}

/// `across_gpus`: for all variants of a GPU on the first of them; of one strategy, too.
template <class Series>
cachesim::Baseline baseline_of(const std::vector<Series>& series, const std::string& asked, bool across_gpus = false) {
    std::string strategy = baseline_strategy(series, asked);
    if (!across_gpus) return strategy;
    const std::string& first = series.front().strategy;
    const bool one = std::all_of(series.begin(), series.end(), [&](const Series& s) { return s.strategy == first; });
    if (strategy.empty() && one) strategy = first;
    return {strategy, strategy.empty() ? std::string() : series.front().gpu};
}

}  // namespace raycache::tools
