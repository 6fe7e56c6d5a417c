#include "cachesim/replay/timed/timed_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <type_traits>

namespace raycache::cachesim {

namespace {

constexpr std::array resources{&TimedStatistics::issue,
                               &TimedStatistics::l1_port,
                               &TimedStatistics::crossbar,
                               &TimedStatistics::l2_slices,
                               &TimedStatistics::dram,
                               &TimedStatistics::l1_tags,
                               &TimedStatistics::l1_data,
                               &TimedStatistics::l1_mshrs,
                               &TimedStatistics::l2_mshrs,
                               &TimedStatistics::rt_box_tests,
                               &TimedStatistics::rt_triangle_tests,
                               &TimedStatistics::rt_warps};

/// Calls use(mine, other's) for every counter of the two.
template <class Use>
void for_each_counter(LevelAnswers& a, const LevelAnswers& b, const Use& use) {
    use(a.hits, b.hits);
    use(a.merges, b.merges);
    use(a.line_misses, b.line_misses);
    use(a.sector_misses, b.sector_misses);
}

template <class Use>
void for_each_counter(TimedStatistics& a, const TimedStatistics& b, const Use& use) {
    for (const auto count : {&TimedStatistics::cycles, &TimedStatistics::rays, &TimedStatistics::warp_accesses,
                             &TimedStatistics::lane_accesses, &TimedStatistics::instructions, &TimedStatistics::loads,
                             &TimedStatistics::dram_sectors, &TimedStatistics::visit_cycles, &TimedStatistics::warps,
                             &TimedStatistics::warp_cycles, &TimedStatistics::rt_loads})
        use(a.*count, b.*count);
    for (std::size_t level = 0; level < most_levels; ++level) for_each_counter(a.levels[level], b.levels[level], use);
    for (const auto resource : resources) use((a.*resource).busy, (b.*resource).busy);
    use(a.seconds, b.seconds);
}

constexpr auto add_up = [](auto& mine, const auto& others) { mine += others; };
constexpr auto take_away = [](auto& mine, const auto& others) { mine -= others; };

}  // namespace

LevelAnswers& LevelAnswers::operator+=(const LevelAnswers& other) {
    for_each_counter(*this, other, add_up);
    return *this;
}

LevelAnswers& LevelAnswers::operator-=(const LevelAnswers& other) {
    for_each_counter(*this, other, take_away);
    return *this;
}

TimedStatistics& TimedStatistics::operator+=(const TimedStatistics& other) {
    for_each_counter(*this, other, add_up);
    warp_slots = other.warp_slots ? other.warp_slots : warp_slots;
    peak_l2_gb_s = std::max(peak_l2_gb_s, other.peak_l2_gb_s);
    peak_dram_gb_s = std::max(peak_dram_gb_s, other.peak_dram_gb_s);
    for (const auto resource : resources) (this->*resource).copies = (other.*resource).copies;
    return *this;
}

TimedStatistics& TimedStatistics::operator-=(const TimedStatistics& before) {
    for_each_counter(*this, before, take_away);
    return *this;
}

TimedStatistics& TimedStatistics::operator*=(double launches) {
    for_each_counter(*this, *this, [launches](auto& mine, const auto&) {
        const double product = static_cast<double>(mine) * launches;
        if constexpr (std::is_integral_v<std::remove_reference_t<decltype(mine)>>)
            mine = static_cast<std::uint64_t>(std::llround(product));
        else
            mine = product;
    });
    return *this;
}

}  // namespace raycache::cachesim
