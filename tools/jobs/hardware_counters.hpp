// Counters of the processor around a piece of work of the calling thread (perf_event_open). Where the kernel offers
// none, or not all, there are simply fewer; containers and virtual machines often have none.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace raycache::tools {

class HardwareCounters {
public:
    HardwareCounters();
    ~HardwareCounters();
    HardwareCounters(const HardwareCounters&) = delete;
    HardwareCounters& operator=(const HardwareCounters&) = delete;

    /// Of those there are, in order: "cycles", "instructions", "branch_misses", "l1d_misses" (of loads).
    const std::vector<std::string>& names() const { return names_; }
    void start();
    /// Counts since start(), by name, in user mode; NaN for a counter that had to share its register meanwhile.
    std::vector<double> stop();

private:
    std::vector<std::string> names_;
    std::vector<int> files_;
};

}  // namespace raycache::tools
