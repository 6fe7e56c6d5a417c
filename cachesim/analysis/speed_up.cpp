#include "cachesim/analysis/speed_up.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cachesim/report/table.hpp"

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

double ratio(std::uint64_t a, std::uint64_t b) { return static_cast<double>(a) / static_cast<double>(b); }

/// other's x per ray over base's.
double per_ray(const SpeedUp& s, std::uint64_t base, std::uint64_t other) {
    return ratio(other, s.other.rays) / ratio(base, s.base.rays);
}

/// "43 % lower", "as before".
std::string change(double quotient) {
    const double percent = 100 * (quotient - 1);
    if (!std::isfinite(percent)) return "not comparable";
    if (std::fabs(percent) < 0.5) return "unchanged";
    return fmt::format("{:.0f} % {}", std::fabs(percent), percent < 0 ? "lower" : "higher");
}

}  // namespace

std::span<const NamedIdeal> idealised_replays() { return replays; }

double SpeedUp::value() const { return ratio(base.cycles, other.cycles); }

std::string to_text(const std::vector<SpeedUp>& all, const std::string& base, const std::string& other) {
    using Align = TextTable::Align;
    TextTable table;
    table.column("replay", Align::left);
    table.column("base cycles", Align::right);
    table.column("gain", Align::right);
    table.column("other cycles", Align::right);
    table.column("gain", Align::right);
    table.column("speed-up", Align::right);
    for (const SpeedUp& s : all)
        table.row(
            {s.replay.name, fmt::format("{}", s.base.cycles),
             fmt::format("{:.2f}", ratio(all.front().base.cycles, s.base.cycles)), fmt::format("{}", s.other.cycles),
             fmt::format("{:.2f}", ratio(all.front().other.cycles, s.other.cycles)), fmt::format("{:.3f}", s.value())});
    std::string text = table.text() + fmt::format("\nbase: {}; other: {}\n", base, other);
    for (const SpeedUp& s : all)
        if (*s.replay.meaning) text += fmt::format("{}: {}\n", s.replay.name, s.replay.meaning);
    return text;
}

std::string sentence(const std::vector<SpeedUp>& all) {
    const SpeedUp& real = all.front();
    const double predicted = real.value(), remains = all.at(1).value();
    // lane accesses per ray, and warp accesses per lane access
    const double work = per_ray(real, real.base.lane_accesses, real.other.lane_accesses);
    const double divergence = per_ray(real, real.base.warp_accesses, real.other.warp_accesses) / work;
    std::string cause = "work and SIMT efficiency as before";
    if (std::fabs(std::log(divergence)) > std::fabs(std::log(work)) && std::fabs(divergence - 1) > 0.005)
        cause = divergence < 1 ? "fewer divergent steps" : "more divergent steps";
    else if (std::fabs(work - 1) > 0.005)
        cause = work < 1 ? "less work per ray" : "more work per ray";
    const std::string traffic = fmt::format("L1-to-L2 traffic per ray is {}, DRAM traffic {}",
                                            change(per_ray(real, real.base.l2.requests(), real.other.l2.requests())),
                                            change(per_ray(real, real.base.dram_sectors, real.other.dram_sectors)));
    const double rest = predicted / remains;
    const std::string role = std::fabs(rest - 1) < 0.01 ? "the caches add nothing to it"
                             : rest > 1                 ? fmt::format("the other {:.2f}x is locality", rest)
                                                        : fmt::format("the caches take {:.2f}x of it back", 1 / rest);
    return fmt::format("{:.2f}x predicted; {:.2f}x would remain with perfect caches ({}); {}: {}.", predicted, remains,
                       cause, role, traffic);
}

}  // namespace raycache::cachesim
