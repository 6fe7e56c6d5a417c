// The memory system behind the front end: warp accesses in, counts out. Each SM has its caches (sm_caches.hpp) and runs
// some rounds ahead of the others; what its caches lack goes to the shared level (shared_level.hpp) at the end of the
// window, in order of issue. Nothing comes back.
//
// So nothing that an SM issues waits for an answer, and where the TBB arena has more than one thread, a window is first
// issued as a whole. Then the caches of each SM look it up, on whichever threads are free, while one of them gives the
// shared level what the SMs lacked in the window before. Each cache sees the same look-ups in the same order as on one
// thread, and sums of whole numbers do not depend on who adds them: every count is the same. Where someone listens, or
// lines are numbered as they are touched (LineIds::dense()), all stays on the calling thread.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <array>
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
    /// Error for the regions of a wavefront, unless it is of the last level alone.
    void observe(RequestSink&);

    /// Rounds of a window: every SM may run that far ahead of the others.
    std::size_t rounds() const { return rules_.rounds; }

    /// Before the first access of a window.
    void begin_window();

    /// Accesses in one round come in order of SMs; end_run() comes between accesses of different SMs.
    SmCaches& sm(std::size_t number) { return sms_[number]; }
    /// The accesses that this SM has issued so far are all for now. False if their elements must stay where they are
    /// until the window ends: they are looked up then.
    bool end_run(std::size_t sm) {
        if (deferred_) return false;
        sms_[sm].end_run(work_);
        return true;
    }
    /// For SMs that issue one after the other.
    Workspace& workspace() { return work_; }

    /// Ray starts of warps that no SM runs.
    void add_rays(const traces::Record& record, BatchGroups& groups) { work_.tally.add_rays(record, groups); }

    /// All SMs have run all rounds: the shared level's turn, at once or beside the next window.
    void end_window();

    /// Looks up all that was issued so far but for what the shared level does at the end of the present window: then
    /// groups() and shared_fills() do not depend on the number of threads.
    void catch_up();

    /// All windows have ended, and so has a kernel: the next finds nothing in the L1s of a GPU, all in what is below.
    /// Caches of a CPU (three levels) keep what they have.
    void end_kernel();

    GroupNumbers& group_numbers() { return numbers_; }

    /// Of the shared level.
    LineFills shared_fills() const { return shared_.fills(); }

    /// The counts of these batches together. Call catch_up() before, as for shared_fills().
    std::vector<RayGroup> groups(const std::vector<const BatchGroups*>& batches) const;

private:
    /// What SMs issue in a window, and what their caches lack of it.
    struct Window {
        std::vector<AccessOrigin> accesses;  ///< rounds() of SM 0, rounds() of SM 1, …
        std::vector<Lookups> missing;  ///< by SM, once the window has ended; only where the shared level comes later
    };

    AccessOrigin* accesses_of(Window&);
    void look_up_deferred();
    void look_up_shared();
    template <class MissingOf>
    void ask_shared(const Window&, const MissingOf&);

    HierarchyRules rules_;
    GroupNumbers numbers_;
    Observers observers_;
    std::array<Window, 2> windows_;  ///< the present one, and the one before or the next
    std::size_t present_ = 0;
    std::deque<SmCaches> sms_;
    SharedLevel shared_;
    Workspace work_;                                         ///< of the thread that issues
    tbb::enumerable_thread_specific<Workspace> on_threads_;  ///< of threads that look up a whole window
    MissWindow misses_;
    bool deferred_ = false;      ///< the present window is looked up when it has been issued as a whole
    bool shared_waits_ = false;  ///< the shared level has not seen the window before
};

}  // namespace raycache::cachesim
