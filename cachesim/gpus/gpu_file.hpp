// A GPU in TOML: the keys are those of key_tables.hpp. A value is plain, or
// { value = …, source = "…" }.
#pragma once

#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"

namespace raycache::cachesim {

/// `file` is named in errors: "FILE:LINE: KEY: expected …, found …; …".
/// `changes`: see load_gpu().
Gpu parse_gpu(const std::string& toml, const std::string& file, const std::vector<std::string>& changes = {});

/// Every value with its source: see gpu_values().
std::vector<GpuValue> parse_gpu_values(const std::string& toml, const std::string& file);

}  // namespace raycache::cachesim
