#include "tools/jobs/cpu_caches.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <thread>

#include "tools/jobs/machine.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

/// "32K", "1024K", "12"; 0 for what is no number.
std::uint64_t number(const std::string& text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) return 0;
    const char unit = end == text.data() + text.size() ? ' ' : *end;
    return value << (unit == 'K' ? 10 : unit == 'M' ? 20 : 0);
}

std::vector<CpuCache> of_sysfs(const std::string& root) {
    std::vector<CpuCache> caches;
    for (unsigned i = 0;; ++i) {
        const std::string folder = fmt::format("{}/cpu0/cache/index{}/", root, i);
        const std::string type = first_line(folder + "type");
        if (type.empty()) return caches;
        if (type == "Instruction") continue;
        caches.push_back({static_cast<unsigned>(number(first_line(folder + "level"))),
                          number(first_line(folder + "size")), number(first_line(folder + "ways_of_associativity")),
                          static_cast<std::uint32_t>(number(first_line(folder + "coherency_line_size"))), "sysfs"});
    }
}

std::vector<CpuCache> of_library() {
    std::vector<CpuCache> caches;
#if defined(_SC_LEVEL1_DCACHE_SIZE)
    const auto ask = [](int name) { return static_cast<std::uint64_t>(std::max(0L, sysconf(name))); };
    const int names[][3] = {
        {_SC_LEVEL1_DCACHE_SIZE, _SC_LEVEL1_DCACHE_ASSOC, _SC_LEVEL1_DCACHE_LINESIZE},
        {_SC_LEVEL2_CACHE_SIZE, _SC_LEVEL2_CACHE_ASSOC, _SC_LEVEL2_CACHE_LINESIZE},
        {_SC_LEVEL3_CACHE_SIZE, _SC_LEVEL3_CACHE_ASSOC, _SC_LEVEL3_CACHE_LINESIZE},
    };
    for (unsigned level = 0; level < 3; ++level)
        caches.push_back({level + 1, ask(names[level][0]), ask(names[level][1]),
                          static_cast<std::uint32_t>(ask(names[level][2])), "sysconf"});
#endif
    return caches;
}

/// CPUs in a list such as "0-3,8".
unsigned count_list(const std::string& list) {
    unsigned count = 0;
    for (std::size_t at = 0; at < list.size();) {
        const std::size_t end = std::min(list.find(',', at), list.size());
        const std::string part = list.substr(at, end - at);
        const std::size_t dash = part.find('-');
        const std::uint64_t first = number(part),
                            last = dash == std::string::npos ? first : number(part.substr(dash + 1));
        count += static_cast<unsigned>(last - std::min(first, last) + 1);
        at = end + 1;
    }
    return count;
}

}  // namespace

CpuTopology cpu_topology(const std::string& root, bool ask_library) {
    CpuTopology topology;
    topology.caches = of_sysfs(root);
    const auto lacks_two = [&] {
        std::erase_if(topology.caches, [](const CpuCache& c) { return c.level == 0 || c.level > 3 || c.bytes == 0; });
        std::stable_sort(topology.caches.begin(), topology.caches.end(),
                         [](const CpuCache& a, const CpuCache& b) { return a.level < b.level; });
        return topology.caches.size() < 2 || topology.caches[0].level != 1 || topology.caches[1].level != 2 ||
               (topology.caches.size() > 2 && topology.caches[2].level != 3) || topology.caches.size() > 3;
    };
    if (lacks_two() && ask_library) topology.caches = of_library();
    if (lacks_two())
        throw Error(
            fmt::format("{}/cpu0/cache: expected a first and a second level of data caches, found {}; this "
                        "system does not say what its caches are: copy cachesim/gpus/xeon-8380.toml and write "
                        "down what the maker says",
                        root, topology.caches.empty() ? "none" : "others"));
    const unsigned online = count_list(first_line(root + "/online"));
    const unsigned siblings = count_list(first_line(root + "/cpu0/topology/thread_siblings_list"));
    topology.core_threads = std::max(1U, siblings);
    topology.cores = std::max(1U, (online != 0 ? online : std::thread::hardware_concurrency()) / topology.core_threads);
    topology.cores_source =
        online != 0 && siblings != 0 ? "sysfs" : "assumed: the system does not say which threads share a core";
    return topology;
}

}  // namespace raycache::tools
