#include "cachesim/analysis/speed_up.hpp"

namespace raycache::cachesim {

namespace {

constexpr NamedIdeal replays[] = {
    {"as modelled", "", {}},
    {"perfect L1", "every look-up in L1 hits", {.perfect_l1 = true}},
    {"perfect L2", "every look-up in L2 hits", {.perfect_l2 = true}},
    {"infinite bandwidth",
     "no L1 port, crossbar, L2 slice or DRAM channel is ever taken",
     {.infinite_bandwidth = true}},
    {"no added latency", "L2 and DRAM answer as fast as L1", {.no_added_latency = true}},
    {"full warps", "consecutive visits of a warp fill up its lanes", {.full_warps = true}},
};

}  // namespace

std::span<const NamedIdeal> idealised_replays() { return replays; }

Estimate SpeedUp::value() const {
    const std::vector<double> ones(base_cycles.size(), 1.0);
    return widened(ratio_to_baseline({base_cycles, ones}, {other_cycles, ones}), widening);
}

Estimate SpeedUp::base_gain(const SpeedUp& as_modelled) const {
    return widened(product_of_powers({{as_modelled.base_cycles, 1}, {base_cycles, -1}}), widening);
}

Estimate SpeedUp::other_gain(const SpeedUp& as_modelled) const {
    return widened(product_of_powers({{as_modelled.other_cycles, 1}, {other_cycles, -1}}), widening);
}

Estimate locality_part(const std::vector<SpeedUp>& all) {
    const SpeedUp &real = all.front(), &perfect = all.at(1);
    return widened(
        product_of_powers(
            {{real.base_cycles, 1}, {real.other_cycles, -1}, {perfect.base_cycles, -1}, {perfect.other_cycles, 1}}),
        real.widening);
}

}  // namespace raycache::cachesim
