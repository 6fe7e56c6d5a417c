// The level that all SMs share, between them and DRAM: look-ups in order of issue, written sectors, first touches.
#pragma once

#include <optional>

#include "cachesim/replay/first_touches.hpp"
#include "cachesim/replay/hierarchy_rules.hpp"
#include "cachesim/replay/owned_level.hpp"
#include "cachesim/replay/write_back.hpp"

namespace raycache::cachesim {

class SharedLevel {
public:
    /// Empty. All references must outlive this object.
    SharedLevel(const HierarchyRules&, const GroupNumbers&, const Observers&);

    /// What the SMs lack, in order of issue. `window`: origins of the accesses. Workspace::tally must have room
    /// for their groups.
    void look_up(Lookups&, const AccessOrigin* window, Workspace&);

    LineFills fills() const { return level_.fills(); }

private:
    void look_up_written(Lookups&, const AccessOrigin* window, Workspace&);

    const HierarchyRules& rules_;
    OwnedLevel level_;
    std::optional<WriteBack> write_back_;  ///< where any region is written
    FirstTouches first_touches_;
};

}  // namespace raycache::cachesim
