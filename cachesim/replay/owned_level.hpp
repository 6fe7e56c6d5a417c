// The caches of one level that belong together: those of one SM, or the one that all SMs share. Answers look-ups,
// charges what it fetches, and tells who listens.
#pragma once

#include <cstdint>
#include <memory>

#include "cachesim/cache/level.hpp"
#include "cachesim/replay/group_numbers.hpp"
#include "cachesim/replay/hierarchy_rules.hpp"
#include "cachesim/replay/observers.hpp"

namespace raycache::cachesim {

class OwnedLevel {
public:
    /// Empty. Of the shared level `sm` is 0. All references must outlive this object.
    OwnedLevel(const HierarchyRules&, std::size_t level, std::uint32_t sm, const GroupNumbers&, const Observers&);

    /// All look-ups in order; leaves those for which something is fetched, and what that is. `window`: origins of their
    /// accesses. Workspace::tally must have room for their groups.
    void look_up(Lookups&, const AccessOrigin* window, Workspace&);

    /// Leaves in the look-ups what is fetched, and in Workspace::asked what was asked for; charges nothing.
    void answer(Lookups&, const AccessOrigin* window, Workspace&);

    /// Forgets all lines.
    void clear();

    /// Of the shared level.
    LineFills fills() const { return level_->fills(); }

private:
    const std::uint32_t* sets(const Lookups&, const AccessOrigin* window, Workspace&) const;
    void report(const Lookups&, const AccessOrigin* window, Workspace&) const;

    const HierarchyRules& rules_;
    std::size_t number_;  ///< of the level
    std::uint32_t sm_;
    const GroupNumbers& groups_;
    const Observers& observers_;
    std::unique_ptr<Level> level_;
};

}  // namespace raycache::cachesim
