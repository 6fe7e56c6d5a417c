#include "traces/record_rules.hpp"

#include <algorithm>

#include "traces/issue_rules.hpp"

namespace raycache::traces {

void reject_record(const WarpTrace& warp, std::size_t record, const std::string& what) {
    throw Error(
        fmt::format("trace to be written: launch {}, warp {}, record {}: {}; this is a fault of the program that "
                    "made the records, please report it",
                    warp.launch, warp.warp, record, what));
}

void check_issue(const Header& header, const WarpTrace& warp) {
    if (!header.issue) {
        if (!warp.issue.empty()) reject_record(warp, 0, "expected no issue steps in a trace without them, found some");
        return;
    }
    const auto accesses = static_cast<std::uint32_t>(
        std::count_if(warp.records.begin(), warp.records.end(), [](const Record& r) { return r.is_access(); }));
    if (const char* fault = issue_fault(warp.issue, accesses)) reject_record(warp, warp.records.size(), fault);
}

}  // namespace raycache::traces
