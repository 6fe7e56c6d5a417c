// A GPU file of this processor (cachesim/gpus/xeon-8380.toml is one): what the system says, what was measured here, and
// what is assumed, each value with its source.
#pragma once

#include <cstdint>
#include <string>

#include "tools/jobs/cpu_caches.hpp"
#include "tools/jobs/machine.hpp"
#include "tools/jobs/observer.hpp"

namespace raycache::tools {

/// In nanoseconds and GB/s; of L3 0 where there is none.
struct CpuTimings {
    double mhz = 0;
    double l1_ns = 0, l2_ns = 0, l3_ns = 0, dram_ns = 0;
    double l2_gb_s = 0, l3_gb_s = 0;  ///< of one thread
    double dram_gb_s = 0;             ///< of all threads
    /// The largest buffer that chases find in L3 where it is smaller than the system says, which may mean the L3s of
    /// all cores; 0: as the system says.
    std::uint64_t l3_bytes = 0;
};

/// On the threads of the TBB arena; takes some seconds.
CpuTimings measure_cpu(const CpuTopology&, Observer&);

/// `date`: "2026-11-30"; `simd_width`: rays that Embree walks as one.
std::string cpu_preset(const Machine&, const CpuTopology&, const CpuTimings&, unsigned simd_width,
                       const std::string& date);

}  // namespace raycache::tools
