// The figures of a timed replay: cycles, what they are spent on, and the speed-up predicted from them. A new figure is
// a row of this table, as in traffic_figures.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "cachesim/replay/timed/timed_statistics.hpp"
#include "cachesim/report/figures/figure.hpp"

namespace raycache::cachesim {

using TimedQuantity = Quantity<TimedStatistics, double>;
using TimedFigure = Figure<TimedQuantity>;

namespace timed {

using Units = CacheUnits;

/// A member of TimedStatistics as a quantity.
template <auto member>
constexpr TimedQuantity quantity(const char* name) {
    return {name, [](const TimedStatistics& t, const Units&) { return static_cast<double>(t.*member); }};
}
template <std::size_t level, auto member>
constexpr TimedQuantity answered(const char* name) {
    return {name, [](const TimedStatistics& t, const Units&) { return static_cast<double>(t.levels[level].*member); }};
}
template <std::size_t level>
constexpr TimedQuantity requests(const char* name) {
    return {name,
            [](const TimedStatistics& t, const Units&) { return static_cast<double>(t.levels[level].requests()); }};
}

/// The level that all SMs share.
inline const LevelAnswers& shared_level(const TimedStatistics& t) { return t.levels[t.levels[2].requests() ? 2 : 1]; }
inline double gigabytes(std::uint64_t sectors, const Units& u) {
    return static_cast<double>(sectors) * u.sector_bytes / 1e9;
}

inline constexpr TimedQuantity cycles = quantity<&TimedStatistics::cycles>("cycles");
inline constexpr TimedQuantity seconds = quantity<&TimedStatistics::seconds>("seconds");
inline constexpr TimedQuantity rays = quantity<&TimedStatistics::rays>("rays");
inline constexpr TimedQuantity warp_accesses = quantity<&TimedStatistics::warp_accesses>("warp_accesses");

/// A count that files show and tables do not.
constexpr TimedFigure total(const char* key, const char* title, const char* unit, const char* definition,
                            const TimedQuantity& count) {
    return {.key = key, .of = Of::total, .title = title, .unit = unit, .definition = definition, .numerator = count};
}

/// The answers of one level.
template <std::size_t level>
constexpr std::array<TimedFigure, 8> of_level(const char* object, const std::array<const char*, 8>& keys,
                                              const char* column, const char* title) {
    constexpr auto hits = answered<level, &LevelAnswers::hits>("hits");
    constexpr auto merges = answered<level, &LevelAnswers::merges>("merges");
    constexpr auto all = requests<level>("requests");
    constexpr TimedQuantity found{"hits + merges", [](const TimedStatistics& t, const Units&) {
                                      const LevelAnswers& a = t.levels[level];
                                      return static_cast<double>(a.hits + a.merges);
                                  }};
    const auto count = [&](std::size_t i, const char* name, const char* what, const char* definition,
                           const TimedQuantity& quantity) {
        TimedFigure f = total(keys[i], what, "sectors", definition, quantity);
        f.object = object;
        f.name = name;
        f.presence = level == 2 ? Presence::three_levels : Presence::always;
        if (i == 0) f.field = Field::json;
        return f;
    };
    const auto share = [&](std::size_t i, const char* name, const char* what, const char* definition,
                           const TimedQuantity& quantity, Field field, const char* column_title) {
        TimedFigure f = count(i, name, what, definition, quantity);
        f.of = Of::quotient;
        f.unit = "share";
        f.denominator = all;
        f.column = column_title;
        f.scale = 100;
        f.digits = f.page_digits = 1;
        f.table = Table::hits;
        f.field = field;
        f.part = 2;
        return f;
    };
    TimedFigure hit_rate = share(5, "hit_rate", title,
                                 "share of the requests to the level that hit, requests for a "
                                 "sector on its way included",
                                 found, level == 2 ? Field::json : Field::in_both, column);
    hit_rate.better = Better::higher;
    return {count(0, "requests", "requests", "sectors asked of the level", all),
            count(1, "hits", "hits", "of these, found", hits),
            count(2, "merges", "merges", "of these, on their way already", merges),
            count(3, "line_misses", "line misses", "of these, in a line that was absent",
                  answered<level, &LevelAnswers::line_misses>("line_misses")),
            count(4, "sector_misses", "sector misses", "of these, absent from a line that was there",
                  answered<level, &LevelAnswers::sector_misses>("sector_misses")),
            hit_rate,
            share(6, "hit_rate_merges_miss", "hits without merges",
                  "share of the requests to the level that hit, requests for a sector on its way not included", hits,
                  Field::json, nullptr),
            share(7, "merge_rate", "merged", "share of the requests to the level for a sector on its way", merges,
                  Field::neither, "merged %")};
}

/// How much of the time a resource is in use. What may bind a launch has rank 0, parts of these have 1.
template <TimedStatistics::Resource TimedStatistics::*resource>
constexpr TimedFigure utilisation(const char* key, const char* title, const char* column, const char* definition,
                                  unsigned rank = 0) {
    return {.key = key,
            .of = Of::quotient,
            .title = title,
            .unit = "share",
            .definition = definition,
            .numerator = {"busy_cycles", [](const TimedStatistics& t, const Units&) { return (t.*resource).busy; }},
            .denominator = TimedQuantity{"copies x cycles",
                                         [](const TimedStatistics& t, const Units&) {
                                             return static_cast<double>((t.*resource).copies) *
                                                    static_cast<double>(t.cycles);
                                         }},
            .column = column,
            .scale = 100,
            .digits = 1,
            .rank = rank,
            .table = Table::use,
            .object = "utilisation",
            .in_time = true};
}

/// Of GPUs whose RT units walk the BVH.
constexpr TimedFigure of_rt_unit(TimedFigure f) {
    f.presence = Presence::rt_unit;
    f.field = Field::json;
    return f;
}

inline constexpr std::array times{
    TimedFigure{.key = "cycles",
                .of = Of::total,
                .title = "cycles",
                .unit = "cycles",
                .definition = "cycles of the SM clock from the start of a launch to the end of its last warp",
                .numerator = cycles,
                .column = "cycles",
                .digits = 0,
                .rank = 3,
                .better = Better::lower,
                .in_time = true},
    TimedFigure{.key = "seconds",
                .of = Of::quotient,
                .title = "time",
                .unit = "s",
                .definition = "the cycles over the SM clock",
                .numerator = seconds,
                .column = "ms",
                .scale = 1e3,
                .digits = 3,
                .rank = 2,
                .better = Better::lower,
                .in_time = true},
    TimedFigure{.key = "cycles_per_ray",
                .title = "cycles per ray",
                .unit = "cycles",
                .definition = "cycles of the whole GPU per ray",
                .numerator = cycles,
                .denominator = rays,
                .column = "cycles/ray",
                .digits = 2,
                .interval = true,
                .rank = 1,
                .better = Better::lower,
                .in_time = true},
    TimedFigure{.key = "speed_up",
                .of = Of::gain,
                .title = "predicted speed",
                .unit = "ratio",
                .definition = "predicted time of the baseline over that of the row; above 1 is faster. A model's, not "
                              "a measurement",
                .numerator = cycles,
                .column = "speed-up",
                .digits = 3,
                .interval = true,
                .better = Better::higher,
                .page = true,
                .page_digits = 2,
                .in_time = true},
    total("rays", "rays", "rays", "rays of all launches", rays),
    total("warp_accesses", "warp accesses", "accesses", "accesses of warps: one for all lanes that take part",
          warp_accesses),
    total("lane_accesses", "lane accesses", "accesses", "accesses of lanes to anything",
          quantity<&TimedStatistics::lane_accesses>("lane_accesses")),
    total("instructions", "instructions", "instructions", "instructions of warps: loads, and those between accesses",
          quantity<&TimedStatistics::instructions>("instructions")),
    total("loads", "loads", "instructions", "load instructions of warps", quantity<&TimedStatistics::loads>("loads")),
    of_rt_unit(total("rt_loads", "RT loads", "loads", "loads of RT units, each of all lanes of a warp, besides",
                     quantity<&TimedStatistics::rt_loads>("rt_loads"))),
};

inline constexpr std::array costs{
    TimedFigure{.key = "dram_sectors",
                .of = Of::total,
                .title = "DRAM sectors",
                .unit = "sectors",
                .definition = "sectors that DRAM reads and writes",
                .numerator = quantity<&TimedStatistics::dram_sectors>("dram_sectors"),
                .column = "DRAM sectors",
                .digits = 0,
                .table = Table::hits,
                .better = Better::lower},
    TimedFigure{.key = "occupancy",
                .of = Of::quotient,
                .title = "occupancy",
                .unit = "share",
                .definition = "share of the slots for warps that is taken, on average",
                .numerator = quantity<&TimedStatistics::warp_cycles>("warp_cycles"),
                .denominator = cycles,
                .per = quantity<&TimedStatistics::warp_slots>("warp_slots"),
                .column = "occupancy %",
                .scale = 100,
                .digits = 1,
                .better = Better::higher,
                .part = 1,
                .in_time = true,
                .of_nothing = 0},
    utilisation<&TimedStatistics::issue>("issue", "issue", "issue %", "share of the time that schedulers issue"),
    utilisation<&TimedStatistics::l1_port>("l1_port", "L1 port", "L1 port %", "share of the time that L1 ports work"),
    utilisation<&TimedStatistics::crossbar>("crossbar", "crossbar", "crossbar %",
                                            "share of the time that the crossbar carries replies"),
    utilisation<&TimedStatistics::l2_slices>("l2_slices", "L2 slices", "L2 slices %",
                                             "share of the time that slices of the level that all SMs share work"),
    utilisation<&TimedStatistics::dram>("dram", "DRAM", "DRAM %", "share of the time that channels of DRAM work"),
    utilisation<&TimedStatistics::l1_tags>("l1_tags", "L1 tags", "L1 tags %",
                                           "share of the time that L1 ports look up tags", 1),
    utilisation<&TimedStatistics::l1_data>("l1_data", "L1 data", "L1 data %",
                                           "share of the time that L1 ports move data", 1),
    utilisation<&TimedStatistics::l1_mshrs>("l1_mshrs", "L1 MSHRs", "L1 MSHRs %",
                                            "share of L1's registers for sectors on their way that are taken", 1),
    utilisation<&TimedStatistics::l2_mshrs>("l2_mshrs", "L2 MSHRs", "L2 MSHRs %",
                                            "the same of the level that all SMs share", 1),
    of_rt_unit(utilisation<&TimedStatistics::rt_box_tests>("rt_box_tests", "RT box tests", "RT boxes %",
                                                           "share of the time that RT units test boxes")),
    of_rt_unit(utilisation<&TimedStatistics::rt_triangle_tests>(
        "rt_triangle_tests", "RT triangle tests", "RT triangles %", "share of the time that RT units test triangles")),
    of_rt_unit(utilisation<&TimedStatistics::rt_warps>("rt_warps", "RT warps", "RT warps %",
                                                       "share of the RT units' places for warps that are taken", 1)),
    TimedFigure{.key = "l2_gb_s",
                .of = Of::quotient,
                .title = "L2 bandwidth",
                .unit = "GB/s",
                .definition = "10^9 bytes per second that the level that all SMs share is asked for",
                .numerator = {"gigabytes", [](const TimedStatistics& t,
                                              const Units& u) { return gigabytes(shared_level(t).requests(), u); }},
                .denominator = seconds,
                .column = "L2 GB/s",
                .digits = 1,
                .table = Table::rates,
                .part = 1,
                .in_time = true},
    TimedFigure{.key = "l2_peak_gb_s",
                .of = Of::quotient,
                .title = "peak of L2",
                .unit = "GB/s",
                .definition = "the most that its slices can answer",
                .numerator = quantity<&TimedStatistics::peak_l2_gb_s>("peak"),
                .column = "peak",
                .digits = 0,
                .table = Table::rates,
                .part = 1},
    TimedFigure{.key = "dram_gb_s",
                .of = Of::quotient,
                .title = "DRAM bandwidth",
                .unit = "GB/s",
                .definition = "10^9 bytes per second that DRAM reads and writes",
                .numerator = {"gigabytes",
                              [](const TimedStatistics& t, const Units& u) { return gigabytes(t.dram_sectors, u); }},
                .denominator = seconds,
                .column = "DRAM GB/s",
                .digits = 1,
                .table = Table::rates,
                .part = 1,
                .in_time = true},
    TimedFigure{.key = "dram_peak_gb_s",
                .of = Of::quotient,
                .title = "peak of DRAM",
                .unit = "GB/s",
                .definition = "the most that its channels can move",
                .numerator = quantity<&TimedStatistics::peak_dram_gb_s>("peak"),
                .column = "peak",
                .digits = 0,
                .table = Table::rates,
                .part = 1},
    TimedFigure{.key = "visit_latency",
                .of = Of::quotient,
                .title = "visit latency",
                .unit = "cycles",
                .definition = "cycles from the first load of a visit to its last data",
                .numerator = quantity<&TimedStatistics::visit_cycles>("visit_cycles"),
                .denominator = warp_accesses,
                .column = "visit latency",
                .digits = 0,
                .table = Table::rates,
                .better = Better::lower,
                .part = 1,
                .in_time = true},
};

template <std::size_t... sizes>
constexpr auto joined(const std::array<TimedFigure, sizes>&... lists) {
    std::array<TimedFigure, (sizes + ...)> all{};
    std::size_t at = 0;
    (std::for_each(lists.begin(), lists.end(), [&](const TimedFigure& f) { all[at++] = f; }), ...);
    return all;
}

}  // namespace timed

/// In the order of tables and JSON.
inline constexpr auto timed_figures =
    timed::joined(timed::times,
                  timed::of_level<0>("l1",
                                     {"l1_requests", "l1_hits", "l1_merges", "l1_line_misses", "l1_sector_misses",
                                      "l1_hit_rate", "l1_hit_rate_merges_miss", "l1_merge_rate"},
                                     "L1 %", "L1 hits"),
                  timed::of_level<1>("l2",
                                     {"l2_requests", "l2_hits", "l2_merges", "l2_line_misses", "l2_sector_misses",
                                      "l2_hit_rate", "l2_hit_rate_merges_miss", "l2_merge_rate"},
                                     "L2 %", "L2 hits"),
                  timed::of_level<2>("l3",
                                     {"l3_requests", "l3_hits", "l3_merges", "l3_line_misses", "l3_sector_misses",
                                      "l3_hit_rate", "l3_hit_rate_merges_miss", "l3_merge_rate"},
                                     "L3 %", "L3 hits"),
                  timed::costs);

using TimedKey = FigureIn<timed_figures>;

}  // namespace raycache::cachesim
