// A GPU in TOML. Every key of Gpu and CacheGeometry must be there, as a plain value or as { value = …, source = "…" }:
//
//     name = "my-gpu"
//     description = "…"
//     sms = 22
//     warps_per_sm = 40
//     warps_per_cta = 8
//     l1_per_sm = 1
//     [l1]                        # and [l2]
//     sets = 4
//     ways = 48
//     line_bytes = 128
//     sector_bytes = 32
//     index = "modulo"            # or "xor_fold"
//     policy = "lru"
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
