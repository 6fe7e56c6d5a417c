#include "cachesim/replay/owned_level.hpp"

#include "cachesim/cache/registry.hpp"

namespace raycache::cachesim {

OwnedLevel::OwnedLevel(const HierarchyRules& rules, std::size_t level, std::uint32_t sm, const GroupNumbers& groups,
                       const Observers& observers)
    : rules_(rules), number_(level), sm_(sm), groups_(groups), observers_(observers) {
    clear();
}

void OwnedLevel::clear() {
    const unsigned caches = number_ == 0 && number_ != rules_.shared ? rules_.gpu.l1_per_sm : 1;
    level_ = make_level(rules_.gpu.levels[number_], {caches, sm_ * caches}, rules_.ids.bound(), rules_.instructions);
    if (number_ == rules_.shared) level_->count_fills();
}

const std::uint32_t* OwnedLevel::sets(const Lookups& lookups, const AccessOrigin* window, Workspace& work) const {
    const auto region_of = [window](std::uint32_t access) { return window[access].region; };
    const SetFinder& find = rules_.find_sets[number_];
    if (number_ == 0 && rules_.gpu.l1_per_sm > 1)
        return find(
            lookups, region_of, [window](std::uint32_t access) { return window[access].l1; }, work.sets);
    return find(lookups, region_of, work.sets);
}

void OwnedLevel::look_up(Lookups& lookups, const AccessOrigin* window, Workspace& work) {
    const bool observed = observers_.any() && observers_.want(number_, sm_), widens = rules_.fills[number_].widens();
    if (observed || widens)
        work.asked.assign(lookups.sectors.begin(),
                          lookups.sectors.begin() + static_cast<std::ptrdiff_t>(lookups.count));
    level_->process(sets(lookups, window, work), lookups.lines.data(), lookups.sectors.data(), lookups.count);
    if (observed) report(lookups, window, work);
    if (widens)
        for (std::size_t i = 0; i < lookups.count; ++i)
            work.tally.add_unasked(number_, window[lookups.accesses[i]].group, lookups.sectors[i] & ~work.asked[i]);
    lookups.drop_answered(rules_.instructions);
    for (std::size_t i = 0; i < lookups.count; ++i)
        work.tally.add_fetched(number_, window[lookups.accesses[i]].group, lookups.sectors[i]);
}

void OwnedLevel::answer(Lookups& lookups, const AccessOrigin* window, Workspace& work) {
    work.asked.assign(lookups.sectors.begin(), lookups.sectors.begin() + static_cast<std::ptrdiff_t>(lookups.count));
    level_->process(sets(lookups, window, work), lookups.lines.data(), lookups.sectors.data(), lookups.count);
    if (observers_.any() && observers_.want(number_, sm_)) report(lookups, window, work);
}

void OwnedLevel::report(const Lookups& answers, const AccessOrigin* window, Workspace& work) const {
    work.served.clear();
    for (std::size_t i = 0; i < answers.count; ++i) {
        const std::uint32_t access = answers.accesses[i];
        const AccessOrigin& origin = window[access];
        const GroupNumbers::RayOf& of = groups_.ray_of(origin.group);
        work.served.push_back({rules_.ids.line(answers.lines[i], origin.region) * rules_.gpu.l1().line_bytes,
                               work.asked[i], answers.sectors[i] & work.asked[i], sm_, number_ == 0 ? origin.l1 : 0u,
                               of.ray, of.bounce, rules_.kinds[origin.region], of.batch != not_counted, access,
                               answers.lines[i]});
    }
    observers_.served(number_, sm_, work.served);
}

}  // namespace raycache::cachesim
