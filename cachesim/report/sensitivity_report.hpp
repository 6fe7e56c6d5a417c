// How far speed-ups hang on assumed values, in words, tables and files.
#pragma once

#include <string>
#include <vector>

#include "cachesim/analysis/sensitivity.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {

struct SensitivityReport {
    std::vector<Sensitivity> rows;
    std::string sample;  ///< "16 windows, 8 of them with other values": what was replayed, in words
    std::string model;   ///< "scale model of 2 SMs"; empty: the whole GPU
};

/// For each row the speed-up at the values of the file, its range over the hypercube, the values by how much they move
/// it, and the verdict.
std::string to_text(const SensitivityReport&, std::size_t width = text_width);
/// {"sample", "model", "sensitivities": […]}: docs/json.md.
std::string to_json(const SensitivityReport&);
/// One line for each point.
std::string to_csv(const SensitivityReport&);

}  // namespace raycache::cachesim
