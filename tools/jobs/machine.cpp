#include "tools/jobs/machine.hpp"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <thread>

namespace raycache::tools {
namespace {

/// The value of the first line "KEY : VALUE" in /proc/cpuinfo with one of these keys.
std::string cpu_name() {
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);) {
        const std::size_t colon = line.find(": ");
        if (colon == std::string::npos) continue;
        for (const char* key : {"model name", "Model", "Hardware"})
            if (line.starts_with(key)) return line.substr(colon + 2);
    }
    return {};
}

}  // namespace

Machine this_machine() {
    const auto known = [](std::string text) { return text.empty() ? std::string("unknown") : text; };
    return {known(cpu_name()), std::max(1U, std::thread::hardware_concurrency()),
            known(first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"))};
}

std::string first_line(const std::string& path) {
    std::ifstream in(path);
    std::string line;
    std::getline(in, line);
    return line;
}

double thread_seconds() {
    std::timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace raycache::tools
