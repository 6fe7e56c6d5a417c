// A GPU in TOML. A value is plain, or { value = …, source = "…" }. These keys must be there:
//
//     name = "my-gpu"
//     description = "…"
//     sms = 22
//     warps_per_sm = 40           # resident at once
//     warps_per_cta = 8
//     l1_per_sm = 1
//     [l1]                        # and [l2]; [l3] where there is one. The last is shared by all SMs
//     sets = 4                    # of one slice
//     ways = 48
//     line_bytes = 128            # the same in all levels, as are sectors
//     sector_bytes = 32
//     index = "modulo"            # or "xor_fold", "ipoly", "parity": cachesim/cache/line_map.hpp
//     policy = "lru"              # or "fifo", "random", "tree_plru": cachesim/cache/policies/
//
// These may be left out; here with what is taken then:
//
//     simd_width = 32                      # lanes that execute together: 1, 2, 4, 8, 16 or 32
//     scheduler = "loose_round_robin"      # or "greedy_then_oldest"
//     [front_end]
//     load_bytes = 16                      # widest load; objects are read in pieces of this size: 4, 8 or 16
//     lanes_per_request_16 = 32            # lanes of a load of 16 bytes that go to the tag stage together; 1 to 32
//     lanes_per_request_8 = 32             # of 8 bytes
//     lanes_per_request_4 = 32             # of 4 bytes or fewer
//     [l1]                                 # and every other level
//     seed = 1                             # of policy "random"
//     slices = 1                           # any number
//     slice_hash = "modulo"                # or "xor_fold", "ipoly"
//     interleave_bytes = 256               # neighbouring bytes in one slice; a line where that is longer
//     slice_bits = []                      # "ipoly": address bits that number the slices, lowest first
//     slice_hash_from = 0                  # "ipoly": lowest of the address bits that are mixed in
//     index_masks = []                     # "parity": one mask of address bits for each bit of the set
//     fill_bytes = 32                      # what a miss fetches: the sector, or its aligned piece of this size
//     allocate = "on_miss"                 # or "on_fill": when a miss takes its line; makes a difference in time only
//
// [timing] is for a timed replay, with a key for every field of Timing (cachesim/gpus/timing.hpp).
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
