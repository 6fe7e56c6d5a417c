// The data caches of this processor, as the system describes them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace raycache::tools {

struct CpuCache {
    unsigned level = 1;
    std::uint64_t bytes = 0;
    std::uint64_t ways = 0;        ///< 0: not told
    std::uint32_t line_bytes = 0;  ///< 0: not told
    std::string source;            ///< who says so: "sysfs", "sysconf"
};

struct CpuTopology {
    std::vector<CpuCache> caches;          ///< level 1 first
    unsigned cores = 1, core_threads = 1;  ///< that are online; threads of one core
    std::string cores_source;
};

/// `root`: where sysfs describes processors, "/sys/devices/system/cpu". Where it says nothing of caches, the C library
/// is asked, which asks the processor. Throws Error if neither knows a first and a second level.
CpuTopology cpu_topology(const std::string& root = "/sys/devices/system/cpu", bool ask_library = true);

}  // namespace raycache::tools
