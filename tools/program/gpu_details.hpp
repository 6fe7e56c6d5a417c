// What the GPU presets say, value by value: raycache list gpus --details.
#pragma once

#include <cstddef>
#include <string>

namespace raycache::tools {

/// A table with one row per preset, then every value with its source.
std::string gpu_details_text(std::size_t width);

/// {"gpu_presets": [{"name", "description", "sms": {"value", "source"}, …, "l1": {"bytes", "sets": {"value", "source"},
/// …}, …}]}; a value with a range has "range" or "choices", and "range_source".
std::string gpu_details_json();

}  // namespace raycache::tools
