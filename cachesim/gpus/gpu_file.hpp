// A GPU in TOML: the keys are those of key_tables.hpp. A value is plain, or
// { value = …, source = "…" }, or with what it may be instead { value = …, source = "…", range = [low, high] } or
// { …, choices = [a, b] }, and `range_source` where someone says why.
#pragma once

#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"

namespace raycache::cachesim {

/// `file` is named in errors: "FILE:LINE: KEY: expected …, found …; …".
/// `changes`: see load_gpu().
Gpu parse_gpu(const std::string& toml, const std::string& file, const std::vector<std::string>& changes = {});

/// Every value with its source: see gpu_values().
std::vector<GpuValue> parse_gpu_values(const std::string& toml, const std::string& file,
                                       const std::vector<std::string>& changes = {});

}  // namespace raycache::cachesim
