// The keys of GPU files, a table for each section, in the order in which they are read and listed. A new key is one
// member of the struct and one row here.
#pragma once

#include <span>

#include "cachesim/gpus/key.hpp"

namespace raycache::cachesim {

/// [registers]: from these follow the resident warps of an SM, where the file does not give them.
struct Registers {
    std::uint32_t per_sm = 0, per_thread = 0;
    std::uint32_t allocation = 256;
};

std::span<const Key<Gpu>> chip_keys();  ///< those in no section
std::span<const Key<Registers>> register_keys();
std::span<const Key<FrontEnd>> front_end_keys();
std::span<const Key<CacheGeometry>> level_keys();  ///< [l1], [l2], [l3]
std::span<const Key<Timing>> timing_keys();
std::span<const Key<RtUnitTiming>> rt_unit_keys();

}  // namespace raycache::cachesim
