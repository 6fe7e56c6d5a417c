#include "cachesim/replay/launch_checks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cachesim/gpus/limits.hpp"
#include "cachesim/replay/quick_check.hpp"
#include "traces/error.hpp"
#include "traces/issue_rules.hpp"

namespace raycache::cachesim {

const Gpu& checked(const Gpu& gpu) {
    if (const auto problem = find_problem(gpu))
        throw Error(fmt::format("GPU \"{}\": {}: {}", gpu.name, problem->key, problem->message));
    return gpu;
}

std::vector<traces::Region> checked(const std::vector<traces::Region>& regions) {
    if (regions.size() >= traces::ray_start)
        throw Error(fmt::format("trace: expected at most {} regions, found {}; write the trace again",
                                traces::ray_start - 1, regions.size()));
    std::vector<traces::Region> copies;
    for (const traces::Region& r : regions) {
        if (static_cast<unsigned>(r.kind) >= traces::object_kinds)
            throw Error(
                fmt::format("region {} of the trace: expected an object kind of 0 to {}, found {}; write the "
                            "trace again",
                            copies.size(), traces::object_kinds - 1, static_cast<unsigned>(r.kind)));
        copies.push_back({r.kind, r.base, r.element_size, r.stride, r.count, 0, {}, r.pages});
    }
    return copies;
}

const Gpu& checked_timed(const Gpu& gpu) {
    checked(gpu);
    if (!gpu.timing)
        throw Error(
            fmt::format("GPU \"{}\": expected a table [timing] for a timed replay, found none; add one, or replay "
                        "without time",
                        gpu.name));
    const std::uint64_t flights = std::uint64_t{gpu.warps_per_sm} * gpu.timing->accesses_in_flight;
    if (flights > 64 * gpu.timing->schedulers)
        throw Error(
            fmt::format("GPU \"{}\": warps_per_sm x timing.accesses_in_flight: expected at most 64 for each of {} "
                        "schedulers in a timed replay, found {} x {}; make fewer warps resident",
                        gpu.name, gpu.timing->schedulers, gpu.warps_per_sm, gpu.timing->accesses_in_flight));
    return gpu;
}

void check(const traces::WarpTrace& warp, const std::vector<traces::Region>& regions) {
    if (!warp.issue.empty()) {
        const auto accesses = static_cast<std::uint32_t>(std::count_if(
            warp.records.begin(), warp.records.end(), [](const traces::Record& r) { return r.is_access(); }));
        if (const char* fault = traces::issue_fault(warp.issue, accesses))
            throw Error(fmt::format("launch {}, warp {} of the trace: {}; write the trace again", warp.launch,
                                    warp.warp, fault));
    }
    static IsRight* const is_right = quick_check(best_instruction_set());
    if (is_right && is_right(warp, regions)) return;
    const auto where = [&] { return fmt::format("launch {}, warp {} of the trace", warp.launch, warp.warp); };
    std::size_t next = 0;
    for (const traces::Record& record : warp.records) {
        if (static_cast<unsigned>(record.ray) >= traces::ray_types)
            throw Error(fmt::format("{}: expected a ray type of 0 to {}, found {}; write the trace again", where(),
                                    traces::ray_types - 1, static_cast<unsigned>(record.ray)));
        if (!record.is_access()) continue;
        if (record.region >= regions.size())
            throw Error(fmt::format("{}: expected a region below {}, found {}; write the trace again", where(),
                                    regions.size(), record.region));
        const unsigned lanes = record.lanes();
        if (lanes == 0 || lanes > warp.elements.size() - next)
            throw Error(
                fmt::format("{}: expected an element for each of {} active lanes, found {}; write the trace "
                            "again",
                            where(), lanes, warp.elements.size() - next));
        std::uint32_t largest = 0;
        for (unsigned lane = 0; lane < lanes; ++lane) largest = std::max(largest, warp.elements[next + lane]);
        if (largest >= regions[record.region].count)
            throw Error(fmt::format("{}: expected elements of region {} below {}, found {}; write the trace again",
                                    where(), record.region, regions[record.region].count, largest));
        next += lanes;
    }
    if (next != warp.elements.size())
        throw Error(fmt::format("{}: expected {} elements, one for each active lane, found {}; write the trace again",
                                where(), next, warp.elements.size()));
}

}  // namespace raycache::cachesim
