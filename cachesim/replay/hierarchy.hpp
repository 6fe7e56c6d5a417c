// The memory system behind the front end: warp accesses in, counts out. Each SM has its caches (sm_caches.hpp) and runs
// some rounds ahead of the others; what its caches lack goes to the shared level (shared_level.hpp) at the end of the
// window, in order of issue. Nothing comes back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "cachesim/replay/group_numbers.hpp"
#include "cachesim/replay/hierarchy_rules.hpp"
#include "cachesim/replay/miss_window.hpp"
#include "cachesim/replay/observers.hpp"
#include "cachesim/replay/shared_level.hpp"
#include "cachesim/replay/sm_caches.hpp"
#include "cachesim/replay/statistics.hpp"

namespace raycache::cachesim {

class Hierarchy {
public:
    Hierarchy(const Gpu&, const std::vector<traces::Region>&, InstructionSet);
    Hierarchy(const Hierarchy&) = delete;
    Hierarchy& operator=(const Hierarchy&) = delete;

    /// From now on the sink, which must outlive this object, hears of the caches that it wants, beside others. Throws
    /// Error for the regions of a wavefront.
    void observe(RequestSink&);

    /// Rounds of a window: every SM may run so many rounds ahead of the others.
    std::size_t rounds() const { return rules_.rounds; }

    /// Accesses in one round come in order of SMs; SmCaches::end_run() comes between accesses of different SMs.
    SmCaches& sm(std::size_t number) { return sms_[number]; }
    /// For SMs that run one after the other.
    Workspace& workspace() { return work_; }

    /// Ray starts of warps that no SM runs.
    void add_rays(const traces::Record& record, BatchGroups& groups) { work_.tally.add_rays(record, groups); }

    /// All SMs have run all rounds: the shared level's turn.
    void end_window();

    /// All windows have ended, and so has a kernel: the next finds nothing in the L1s of a GPU, all in what is below.
    /// Caches of a CPU (three levels) keep what they have.
    void end_kernel();

    GroupNumbers& group_numbers() { return numbers_; }

    /// Of the shared level, in all windows that have ended.
    LineFills shared_fills() const { return shared_.fills(); }

    /// The counts of all windows that have ended, of these batches together.
    std::vector<RayGroup> groups(const std::vector<const BatchGroups*>& batches) const;

private:
    HierarchyRules rules_;
    GroupNumbers numbers_;
    Observers observers_;
    std::vector<Origin> window_;  ///< accesses of this window: rounds() of SM 0, rounds() of SM 1, …
    std::deque<SmCaches> sms_;
    SharedLevel shared_;
    Workspace work_;
    MissWindow misses_;
};

}  // namespace raycache::cachesim
