#include "cachesim/replay/shared_level.hpp"

namespace raycache::cachesim {

SharedLevel::SharedLevel(const HierarchyRules& rules, const GroupNumbers& groups, const Observers& observers)
    : rules_(rules),
      level_(rules, rules.shared, 0, groups, observers),
      first_touches_(rules.gpu.levels.back().line_bytes / rules.gpu.levels.back().sector_bytes) {
    if (rules.writes) write_back_.emplace();
}

void SharedLevel::look_up(Lookups& lookups, const AccessOrigin* window, Workspace& work) {
    if (write_back_) {
        look_up_written(lookups, window, work);
        return;
    }
    level_.look_up(lookups, window, work);
    for (std::size_t i = 0; i < lookups.count; ++i)
        work.tally.add_first(window[lookups.accesses[i]].group,
                             first_touches_.add(lookups.lines[i], lookups.sectors[i]));
}

/// A launch that writes: a written sector is there afterwards without being read from DRAM, and is written to DRAM once
/// for each time that it was changed and then evicted (or was left at the end).
void SharedLevel::look_up_written(Lookups& lookups, const AccessOrigin* window, Workspace& work) {
    level_.answer(lookups, window, work);
    for (std::size_t i = 0; i < lookups.count; ++i) {
        const std::uint32_t line = lookups.lines[i], fetched = lookups.sectors[i], asked = work.asked[i];
        const AccessOrigin& origin = window[lookups.accesses[i]];
        if (traces::is_write(rules_.kinds[origin.region])) {
            work.tally.add_fetched(rules_.shared, origin.group, write_back_->write(line, asked, fetched));
            first_touches_.add(line, asked | fetched);  // there without being read
        } else {
            write_back_->read(line, fetched);
            work.tally.add_unasked(rules_.shared, origin.group, fetched & ~asked);
            work.tally.add_fetched(rules_.shared, origin.group, fetched);
            work.tally.add_first(origin.group, first_touches_.add(line, fetched));
        }
    }
}

}  // namespace raycache::cachesim
