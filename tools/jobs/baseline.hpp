// What ratios refer to where the user does not say.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace raycache::tools {

/// Not asked for: the usual baseline, where it is among the strategies and there is something to hold against it.
template <class Series>
std::string baseline_of(const std::vector<Series>& series, const std::string& asked) {
    const std::string usual = "cranley-patterson";
    const auto is_usual = [&](const Series& s) { return s.strategy == usual; };
    const bool has_usual =
        std::any_of(series.begin(), series.end(), is_usual) && !std::all_of(series.begin(), series.end(), is_usual);
    return asked.empty() && has_usual ? usual : asked;
}

}  // namespace raycache::tools
