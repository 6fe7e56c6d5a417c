// The rules of record.hpp that a warp to be written is checked against. Internal to traces/.
#pragma once

#include <string>

#include "traces/fault.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::traces {

/// Throws Error: the fault is not the user's.
[[noreturn]] void reject_record(const WarpTrace&, std::size_t record, const std::string& what);

/// Rules for one record alone.
inline void check_record(const Header& header, const WarpTrace& warp, std::size_t i) {
    const Record& record = warp.records[i];
    if (record.mask == 0) reject_record(warp, i, "expected a mask with at least one lane, found 0");
    if (static_cast<unsigned>(record.ray) >= ray_types)
        reject_record(warp, i, fmt::format("expected a ray type below {}, found {}", ray_types, unsigned(record.ray)));
    if (record.reserved != 0) reject_record(warp, i, fmt::format("expected reserved 0, found {}", record.reserved));
    if (record.is_access() && record.region >= header.regions.size())
        reject_record(warp, i,
                      fmt::format("expected a region below {}, found {}", header.regions.size(), record.region));
}

/// Rules for the warp's counts: `accesses` is the sum of lanes of its access records.
inline void check_elements(const WarpTrace& warp, std::size_t accesses) {
    if (accesses != warp.elements.size())
        reject_record(warp, warp.records.size(),
                      fmt::format("expected {} elements for its masks, found {}", accesses, warp.elements.size()));
}

/// Rules for the warp's issue steps, in a trace that has them or not.
void check_issue(const Header& header, const WarpTrace& warp);

}  // namespace raycache::traces
