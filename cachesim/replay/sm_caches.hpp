// The caches of one SM, its L1s and, where there are three levels, its L2: what it issues in a window of rounds is
// coalesced and looked up at once, level after level; what the last of them lacks waits for the end of the window.
//
// Objects of different SMs share nothing that changes, as long as nobody listens to the replay and lines are numbered
// without gaps (LineIds::dense()): they may run on different threads, each with a Workspace of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cachesim/frontend/warp_access.hpp"
#include "cachesim/replay/group_numbers.hpp"
#include "cachesim/replay/hierarchy_rules.hpp"
#include "cachesim/replay/observers.hpp"
#include "cachesim/replay/owned_level.hpp"

namespace raycache::cachesim {

class SmCaches {
public:
    /// Empty. `window`: where the accesses of all SMs come from; this one writes those from sm * rounds on. All
    /// references must outlive this object.
    SmCaches(const HierarchyRules&, std::uint32_t sm, AccessOrigin* window, const GroupNumbers&, const Observers&);

    /// The warp access that the SM issues through one of its L1s in this round of the window; `elements`: one index per
    /// active lane, valid until end_run(); `warp`: whose number; `groups`: of its batch. Accesses come in order of
    /// rounds.
    void access(const traces::Record& record, const std::uint32_t* elements, std::uint32_t warp, unsigned l1,
                std::size_t round, BatchGroups& groups, Workspace& work) {
        const std::uint32_t group = groups.first(record) + record.region;
        if (observers_.any()) [[unlikely]]
            hear(record, elements, warp, groups);
        if (rules_.streams && traces::is_stream(rules_.kinds[record.region])) [[unlikely]] {
            pass_all(group, record, work);
            return;
        }
        accesses_[issued_] = {elements, record.mask, record.region};
        window_[first_ + issued_] = {group, static_cast<std::uint16_t>(round), record.region,
                                     static_cast<std::uint8_t>(l1)};
        ++issued_;
    }

    /// The accesses so far are all for now: looks them up.
    void end_run(Workspace&);

    /// What the caches lack in this window, accesses numbered as in the window.
    const Lookups& missing() const { return missing_; }
    /// The next window begins.
    void end_window();
    /// Likewise: what was missing goes to `missing`, whose room this object takes over, and the accesses of the next
    /// window are written elsewhere.
    void end_window(Lookups& missing, AccessOrigin* next_window);

    /// Accesses that end_run() has not looked up yet.
    std::uint32_t waiting() const { return issued_ - begun_; }

    /// The L1s of a GPU are empty for the next kernel; a CPU's caches (three levels) keep what they have.
    void end_kernel();

private:
    void hear(const traces::Record&, const std::uint32_t* elements, std::uint32_t warp, const BatchGroups&);
    void pass_all(std::uint32_t group, const traces::Record&, Workspace&);
    void count_accesses(Workspace&);
    void set_writes_apart(Workspace&);
    void lack(const Lookups&);

    const HierarchyRules& rules_;
    AccessOrigin* window_;
    const GroupNumbers& groups_;
    const Observers& observers_;
    std::uint32_t first_;                   ///< number of its first access in the window
    std::vector<OwnedLevel> levels_;        ///< from L1 down
    std::vector<WarpAccess> accesses_;      ///< of this window
    std::uint32_t issued_ = 0, begun_ = 0;  ///< accesses of this window, and those before the present run
    std::vector<IssuedAccess> heard_;       ///< of this run, if anyone listens
    Lookups missing_;
};

}  // namespace raycache::cachesim
