// Predicted speed-ups in words: a table of all idealised replays, and what it says.
#pragma once

#include <string>
#include <vector>

#include "cachesim/analysis/speed_up.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {

/// A table with one line per replay: cycles of both, their ratio, and for each trace how much faster it is than as
/// modelled.
std::string to_text(const std::vector<SpeedUp>&, const std::string& base, const std::string& other,
                    std::size_t width = text_width);

/// The finding in plain words, from all of idealised_replays() in their order.
std::string sentence(const std::vector<SpeedUp>&);

}  // namespace raycache::cachesim
