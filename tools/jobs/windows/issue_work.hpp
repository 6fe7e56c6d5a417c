// What schedulers have to issue for traces: work that tells strategies apart without a cache or a clock.
#pragma once

#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::tools {

/// The issue part of a roofline (Williams, Waterman, Patterson 2009): load instructions and those of visits
/// (cachesim::visit_instructions()), without shading and leaves, over what the schedulers of all SMs issue in a cycle.
/// Where RT units walk the BVH nobody issues visits: then it is the loads alone.
class IssueWork {
public:
    /// The GPU must have a timing. `regions`: of the traces.
    IssueWork(const cachesim::Gpu&, const std::vector<traces::Region>& regions);

    void add(const traces::WarpTrace&);
    /// Of the SM clock.
    double cycles() const { return cycles_per_instruction_ * static_cast<double>(instructions_); }

private:
    std::vector<std::uint64_t> of_access_;  ///< instructions, by region
    double cycles_per_instruction_;
    std::uint64_t instructions_ = 0;
};

}  // namespace raycache::tools
