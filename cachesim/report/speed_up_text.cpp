#include "cachesim/report/speed_up_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cachesim/report/format.hpp"

namespace raycache::cachesim {

namespace {

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

/// Less work or fuller warps: of those that change the time as `remains` says, the one that changes more.
std::string cause_of_rest(const Estimate& remains, double work, double divergence) {
    constexpr double least = 0.005;
    if (std::fabs(remains.mean - 1) < least) return "work and SIMT efficiency as before";
    const bool faster = remains.mean > 1;
    const auto helps = [&](double factor) { return faster ? 1 / factor : factor; };
    if (std::max(helps(work), helps(divergence)) < 1 + least) return "neither work nor SIMT efficiency says why";
    if (helps(divergence) > helps(work)) return faster ? "fewer divergent steps" : "more divergent steps";
    return faster ? "less work per ray" : "more work per ray";
}

/// What caches do: `rest` is the factor that perfect ones leave out, `traffic` that of L1-to-L2 sectors per ray.
std::string role_of_caches(const Estimate& rest, double traffic) {
    constexpr double least = 0.01;
    if (rest.half_width && *rest.half_width >= least && std::fabs(rest.mean - 1) <= *rest.half_width)
        return fmt::format("what the caches add, {:.2f}x{}, is not certain", rest.mean, half_width_text(rest, 2));
    if (std::fabs(rest.mean - 1) < least) return "the caches add nothing to it";
    const double size = std::max(rest.mean, 1 / rest.mean);
    // The half width of 1 / x, to first order.
    const Estimate shown{size, rest.half_width ? std::optional(*rest.half_width * size / rest.mean) : std::nullopt};
    const std::string factor = fmt::format("{:.2f}x{}", size, half_width_text(shown, 2));
    if (rest.mean > 1)
        return traffic < 1 ? "the other " + factor + " is locality"
                           : "the other " + factor + " is no locality but shorter waits of the longest warps";
    return traffic > 1 ? "more traffic takes " + factor + " of it back"
                       : "longer waits of the longest warps take " + factor + " of it back";
}

}  // namespace

std::string to_text(const std::vector<SpeedUp>& all, const std::string& base, const std::string& other,
                    std::size_t width) {
    using Align = TextTable::Align;
    TextTable table;
    table.column("replay", Align::left);
    table.column("base cycles", Align::right);
    table.column("gain", Align::right);
    table.column("other cycles", Align::right);
    table.column("gain", Align::right);
    table.column("speed-up", Align::right);
    for (const SpeedUp& s : all) {
        const auto times = [&](const Estimate& gain) {
            return &s == &all.front() ? std::string("1") : with_interval(gain, 2);
        };
        table.row({s.replay.name, fmt::format("{}", s.base.cycles), times(s.base_gain(all.front())),
                   fmt::format("{}", s.other.cycles), times(s.other_gain(all.front())), with_interval(s.value(), 3)});
    }
    std::string text = table.text(width) + fmt::format("\nbase: {}; other: {}\n", base, other);
    for (const SpeedUp& s : all)
        if (*s.replay.meaning) text += fmt::format("{}: {}\n", s.replay.name, s.replay.meaning);
    return text;
}

std::string sentence(const std::vector<SpeedUp>& all) {
    const SpeedUp& real = all.front();
    if (real.base.warp_accesses == 0 || real.other.warp_accesses == 0)
        return "No speed-up to predict: a trace has no accesses.";
    const Estimate predicted = real.value();
    const Estimate remains = all.at(1).value();
    // lane accesses per ray, and warp accesses per lane access
    const double work = per_ray(real, real.base.lane_accesses, real.other.lane_accesses);
    const double divergence = per_ray(real, real.base.warp_accesses, real.other.warp_accesses) / work;
    const double to_l2 = per_ray(real, real.base.levels[0].misses(), real.other.levels[0].misses());
    const auto times = [](const Estimate& e) { return fmt::format("{:.2f}x{}", e.mean, half_width_text(e, 2)); };
    std::string text = times(predicted);
    if (predicted.half_width && std::fabs(predicted.mean - 1) <= *predicted.half_width)
        text += " predicted, so no certain difference in time";
    else
        text += " predicted";
    text +=
        fmt::format("; {} would remain with perfect caches ({}); {}: L1-to-L2 traffic per ray is {}, DRAM traffic {}.",
                    times(remains), cause_of_rest(remains, work, divergence), role_of_caches(locality_part(all), to_l2),
                    change(to_l2), change(per_ray(real, real.base.dram_sectors, real.other.dram_sectors)));
    constexpr double few = 0.5;
    const double taken = std::min(real.base.occupancy(), real.other.occupancy());
    if (taken < few)
        text += fmt::format(
            " The warps take only {:.0f} % of the GPU's slots on average: these cycles are those of the "
            "longest warps and no statement on throughput.",
            100 * taken);
    return text;
}

}  // namespace raycache::cachesim
