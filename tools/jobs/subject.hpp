// What a result is about, as JSON: the GPUs asked and the traces replayed. docs/json.md describes both for readers.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "traces/header.hpp"

namespace raycache::tools {

using Json = nlohmann::ordered_json;

/// Beyond the settings: the values that stand behind them.
struct Subject {
    std::vector<Json> gpus;    ///< gpu_json() of each
    std::vector<Json> traces;  ///< trace_json() of each trace or capture
};

/// Name, description, what was changed, and the sizes that matter.
Json gpu_json(const cachesim::Gpu&);

/// What a trace says of its making: scene, camera, strategy, N, seed, picture, paths, execution, sample indices.
/// `file`: its name, empty for a capture that was never in a file.
Json trace_json(const traces::Header&, const std::string& file);

/// A number where the text reads as one, else the text.
Json value_json(const std::string& text);

/// As UTF-8 with an indent of 2 and a line break at the end; a name that is no UTF-8 shows U+FFFD.
std::string json_text(const Json&);

}  // namespace raycache::tools
