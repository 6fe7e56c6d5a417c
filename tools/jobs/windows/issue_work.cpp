#include "tools/jobs/windows/issue_work.hpp"

#include "cachesim/frontend/load_counter.hpp"
#include "cachesim/replay/timed/timed_rules.hpp"

namespace raycache::tools {

IssueWork::IssueWork(const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions) {
    const cachesim::Timing& timing = *gpu.timing;
    const cachesim::LoadCounter loads(regions, gpu.front_end, {gpu.l1().line_bytes, gpu.l1().sector_bytes});
    const bool software = gpu.traversal != cachesim::Traversal::rt_unit;
    for (std::size_t r = 0; r < regions.size(); ++r)
        of_access_.push_back(loads.loads(r) +
                             (software ? cachesim::visit_instructions(timing, regions[r].kind, regions[r].degree) : 0));
    cycles_per_instruction_ = static_cast<double>(timing.instruction_interval) / (timing.schedulers * gpu.sms);
}

void IssueWork::add(const traces::WarpTrace& trace) {
    for (const traces::Record& record : trace.records)
        if (record.is_access()) instructions_ += of_access_[record.region];
}

}  // namespace raycache::tools
