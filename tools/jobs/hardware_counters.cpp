#include "tools/jobs/hardware_counters.hpp"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cmath>

namespace raycache::tools {
namespace {

struct CounterKind {
    const char* name;
    std::uint32_t type;
    std::uint64_t config;
};

constexpr CounterKind counter_kinds[] = {
    {"cycles", PERF_TYPE_HARDWARE, PERF_COUNT_HW_CPU_CYCLES},
    {"instructions", PERF_TYPE_HARDWARE, PERF_COUNT_HW_INSTRUCTIONS},
    {"branch_misses", PERF_TYPE_HARDWARE, PERF_COUNT_HW_BRANCH_MISSES},
    {"l1d_misses", PERF_TYPE_HW_CACHE,
     PERF_COUNT_HW_CACHE_L1D | (PERF_COUNT_HW_CACHE_OP_READ << 8) | (PERF_COUNT_HW_CACHE_RESULT_MISS << 16)},
};

int open_counter(const CounterKind& kind) {
    perf_event_attr attributes{};
    attributes.size = sizeof attributes;
    attributes.type = kind.type;
    attributes.config = kind.config;
    attributes.disabled = 1;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
    return static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, PERF_FLAG_FD_CLOEXEC));
}

}  // namespace

HardwareCounters::HardwareCounters() {
    for (const CounterKind& kind : counter_kinds)
        if (const int file = open_counter(kind); file >= 0) {
            names_.emplace_back(kind.name);
            files_.push_back(file);
        }
}

HardwareCounters::~HardwareCounters() {
    for (const int file : files_) close(file);
}

void HardwareCounters::start() {
    for (const int file : files_) {
        ioctl(file, PERF_EVENT_IOC_RESET, 0);
        ioctl(file, PERF_EVENT_IOC_ENABLE, 0);
    }
}

std::vector<double> HardwareCounters::stop() {
    std::vector<double> counts;
    for (const int file : files_) {
        ioctl(file, PERF_EVENT_IOC_DISABLE, 0);
        std::uint64_t value[3]{};  // count, time enabled, time running
        const bool whole = read(file, value, sizeof value) == sizeof value && value[1] == value[2] && value[2] != 0;
        counts.push_back(whole ? static_cast<double>(value[0]) : std::nan(""));
    }
    return counts;
}

}  // namespace raycache::tools
