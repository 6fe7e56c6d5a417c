#include "cachesim/replay/sm_caches.hpp"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

namespace raycache::cachesim {

SmCaches::SmCaches(const HierarchyRules& rules, std::uint32_t sm, AccessOrigin* window, const GroupNumbers& groups,
                   const Observers& observers)
    : rules_(rules),
      window_(window),
      groups_(groups),
      observers_(observers),
      first_(static_cast<std::uint32_t>(sm * rules.rounds)),
      accesses_(rules.rounds) {
    missing_.reserve(2 * rules.rounds);
    for (std::size_t level = 0; level < rules.shared; ++level)
        levels_.emplace_back(rules, level, sm, groups, observers);
}

void SmCaches::hear(const traces::Record& record, const std::uint32_t* elements, std::uint32_t warp,
                    const BatchGroups& groups) {
    heard_.push_back({record, elements, warp, first_ + issued_, groups.batch() != not_counted});
}

/// What a sort moves goes past all levels.
void SmCaches::pass_all(std::uint32_t group, const traces::Record& record, Workspace& work) {
    const std::uint32_t sector = rules_.gpu.l1().sector_bytes, lanes = record.lanes();
    const auto sectors = (lanes * rules_.regions[record.region].element_size + sector - 1) / sector;
    work.tally.make_room(groups_.size());
    work.tally.add_access(group, lanes, sectors);
    work.tally.add_passing(rules_.shared, group, sectors);
}

void SmCaches::end_run(Workspace& work) {
    if (!heard_.empty()) [[unlikely]] {
        observers_.issued(heard_);
        heard_.clear();
    }
    if (begun_ == issued_) return;
    work.tally.make_room(groups_.size());
    work.lookups.count = 0;
    work.coalesce(std::span(accesses_).subspan(begun_, issued_ - begun_), first_ + begun_, work.lookups);
    count_accesses(work);
    if (rules_.writes) set_writes_apart(work);
    for (OwnedLevel& level : levels_) level.look_up(work.lookups, window_, work);
    lack(work.lookups);
    begun_ = issued_;
}

/// Charges the accesses, whose look-ups are not answered yet.
void SmCaches::count_accesses(Workspace& work) {
    // Look-ups come in order of accesses: of each, how many sectors it and those before ask for.
    work.sectors.resize(rules_.rounds);
    std::uint32_t* const sectors = work.sectors.data();
    const Lookups& lookups = work.lookups;
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < lookups.count; ++i) {
        sum += static_cast<unsigned>(std::popcount(lookups.sectors[i]));
        sectors[lookups.accesses[i] - first_] = sum;
    }
    std::uint32_t before = 0;
    for (std::uint32_t i = begun_; i < issued_; ++i) {
        const WarpAccess& access = accesses_[i];
        const std::uint32_t group = window_[first_ + i].group;
        work.tally.add_access(group, access.lanes(), sectors[i] - before);
        before = sectors[i];
        if (!rules_.count_loads.requests_follow(access.region)) [[unlikely]]
            work.tally.add_requests(group, rules_.count_loads.requests(access.region, access.mask, access.elements));
    }
}

/// Writes go through to the shared level and leave no trace above.
void SmCaches::set_writes_apart(Workspace& work) {
    Lookups &lookups = work.lookups, &written = work.written;
    written.count = 0;
    written.reserve(lookups.count);
    std::size_t reads = 0;
    for (std::size_t i = 0; i < lookups.count; ++i) {
        const std::uint32_t line = lookups.lines[i], sectors = lookups.sectors[i], access = lookups.accesses[i];
        const AccessOrigin& origin = window_[access];
        if (traces::is_write(rules_.kinds[origin.region])) {
            written.add(line, sectors, access);
            work.tally.add_passing(rules_.shared - 1, origin.group, static_cast<unsigned>(std::popcount(sectors)));
        } else {
            lookups.lines[reads] = line;
            lookups.sectors[reads] = sectors;
            lookups.accesses[reads++] = access;
        }
    }
    lookups.count = reads;
    lack(written);  // each access has a round of its own, so the order of reads and writes is kept
}

void SmCaches::lack(const Lookups& lookups) {
    missing_.reserve(lookups.count);
    const auto append = [&](const std::vector<std::uint32_t>& from, std::vector<std::uint32_t>& to) {
        std::copy_n(from.begin(), lookups.count, to.begin() + static_cast<std::ptrdiff_t>(missing_.count));
    };
    append(lookups.lines, missing_.lines);
    append(lookups.sectors, missing_.sectors);
    append(lookups.accesses, missing_.accesses);
    missing_.count += lookups.count;
}

void SmCaches::end_window() {
    issued_ = begun_ = 0;
    missing_.count = 0;
}

void SmCaches::end_window(Lookups& missing, AccessOrigin* next_window) {
    std::swap(missing_, missing);
    window_ = next_window;
    end_window();
}

void SmCaches::end_kernel() {
    if (levels_.size() == 1) levels_.front().clear();
}

}  // namespace raycache::cachesim
