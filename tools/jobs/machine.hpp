// The processor that this program runs on, as far as the system tells.
#pragma once

#include <string>

namespace raycache::tools {

/// What is not known is "unknown".
struct Machine {
    std::string cpu;       ///< "AMD EPYC 7763 64-Core Processor"
    unsigned threads = 1;  ///< that run at a time
    std::string governor;  ///< of the first CPU's frequency: "performance", "schedutil"
};
Machine this_machine();

/// The first line of a file, such as one of sysfs; empty where there is none.
std::string first_line(const std::string& path);

/// Processor time of the calling thread so far, in seconds: time in which it did not run is none.
double thread_seconds();

}  // namespace raycache::tools
