// What a reader of estimates from windows must know.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/report/origin.hpp"

namespace raycache::cachesim {

/// What intervals are taken over.
inline const char* units_name(bool windows) { return windows ? "blocks of sample indices" : "sample indices"; }
/// What bytes are, where they are not those of launches from cold caches.
inline constexpr const char* warm_bytes_legend = "bytes read in the steady state, caches warm";

/// "what is estimated, from what, and what the intervals cover"
std::string window_note(const WindowSample&);
/// Of GPUs whose last cache holds the scene: "…: DRAM bytes are at most those shown".
std::string unfilled_note(const std::string& gpus);

/// An estimate over blocks as it is to be shown: wider for several looks, exact where nothing was drawn.
inline Estimate with_interval_of(const WindowSample& windows, const Estimate& e) {
    return windows.all_indices ? Estimate{e.mean, 0} : widened(e, windows.widening);
}

/// Calls add(note) for each, once.
template <class Row, class Add>
void note_windows(const std::vector<Row>& rows, const Add& add) {
    std::vector<std::string> unfilled;
    bool said = false;
    for (const Row& row : rows) {
        if (!row.windows) continue;
        if (!std::exchange(said, true)) add(window_note(*row.windows));
        if (!row.windows->last_cache_full && std::find(unfilled.begin(), unfilled.end(), row.gpu) == unfilled.end())
            unfilled.push_back(row.gpu);
    }
    if (!unfilled.empty()) add(unfilled_note(fmt::format("{}", fmt::join(unfilled, ", "))));
}

}  // namespace raycache::cachesim
