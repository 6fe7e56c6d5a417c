#include "traces/memory_budget.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>

namespace raycache {
namespace {

std::atomic<std::uint64_t> given_limit{0};

/// The number in a file of the kernel's; none where it is missing or says "max".
std::uint64_t number_in(const char* path) {
    std::uint64_t value = 0;
    std::ifstream file(path);
    return file >> value ? value : std::numeric_limits<std::uint64_t>::max();
}

[[noreturn]] void refuse(std::uint64_t limit, std::uint64_t used, std::uint64_t bytes, std::string_view where,
                         std::string_view what) {
    const std::uint64_t all = bytes > std::numeric_limits<std::uint64_t>::max() - used
                                  ? std::numeric_limits<std::uint64_t>::max()
                                  : used + bytes;
    throw MemoryError(fmt::format(
        "{}: {}: expected one input to need at most {} of memory, found {}; use a smaller one, or allow more with "
        "--memory-limit",
        where, what, size_text(limit), size_text(all)));
}

}  // namespace

std::uint64_t machine_memory() {
    static const std::uint64_t bytes = [] {
        const auto pages = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES));
        const std::uint64_t machine = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
        // Control groups, versions 2 and 1, as a container sees its own.
        return std::min({machine, number_in("/sys/fs/cgroup/memory.max"),
                         number_in("/sys/fs/cgroup/memory/memory.limit_in_bytes")});
    }();
    return bytes;
}

std::uint64_t memory_limit() {
    const std::uint64_t given = given_limit;
    return given != 0 ? given : std::max<std::uint64_t>(machine_memory() / 4, 1);
}

void set_memory_limit(std::uint64_t bytes) { given_limit = std::max<std::uint64_t>(bytes, 1); }

std::string size_text(std::uint64_t bytes) {
    constexpr std::array units{"KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
    if (bytes < 1024) return fmt::format("{} bytes", bytes);
    auto value = static_cast<double>(bytes) / 1024;
    std::size_t unit = 0;
    for (; value >= 1024 && unit + 1 < units.size(); ++unit) value /= 1024;
    return value == static_cast<double>(static_cast<std::uint64_t>(value))
               ? fmt::format("{} {}", static_cast<std::uint64_t>(value), units.at(unit))
               : fmt::format("{:.1f} {}", value, units.at(unit));
}

void MemoryBudget::charge(std::uint64_t bytes, std::string_view where, std::string_view what) {
    std::uint64_t used = used_;
    do {
        if (used > limit_ || bytes > limit_ - used) refuse(limit_, used, bytes, where, what);
    } while (!used_.compare_exchange_weak(used, used + bytes));
}

void MemoryBudget::check(std::uint64_t bytes, std::string_view where, std::string_view what) const {
    if (bytes > left()) refuse(limit_, used_, bytes, where, what);
}

std::uint64_t MemoryBudget::left() const {
    const std::uint64_t used = used_;
    return used < limit_ ? limit_ - used : 0;
}

}  // namespace raycache
