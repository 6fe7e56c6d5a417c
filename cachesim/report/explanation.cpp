#include "cachesim/report/explanation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "cachesim/report/format.hpp"

namespace raycache::cachesim {

namespace {

/// Bytes per ray that level `level` fetches.
double bytes_per_ray(const Explanation& e, const Counters& c, std::size_t level) {
    return e.sector_bytes * static_cast<double>(c.fetched(level, e.caches().levels)) / static_cast<double>(c.rays);
}

}  // namespace

Counters ExplainedTrace::totals() const {
    Counters sum;
    for (const LaunchStatistics& launch : launches) sum += launch.all();
    return sum;
}

std::vector<Counters> ExplainedTrace::by_launch() const {
    std::vector<Counters> all;
    for (const LaunchStatistics& launch : launches) all.push_back(launch.all());
    return all;
}

std::optional<Factors> Explanation::factors_of(const std::vector<Counters>& of_base,
                                               const std::vector<Counters>& of_other) const {
    auto factors = traffic_factors(of_base, of_other, caches());
    if (factors) factors->widen(widening());
    return factors;
}

Estimate Explanation::ratio_of(TrafficKey key, const std::vector<Counters>& of_base,
                               const std::vector<Counters>& of_other) const {
    return widened(cachesim::ratio_of(traffic_figures[key.index], of_base, of_other, caches()), widening());
}

Estimate ratio(const Explanation& e, TrafficKey key) {
    return e.ratio_of(key, e.base.by_launch(), e.other.by_launch());
}

Difference difference_of(const Explanation& e) {
    Difference d;
    for (const BytesFigures& bytes : bytes_figures(e.caches().levels)) d.bytes.push_back(ratio(e, bytes.ratio));
    d.factors = e.factors();
    const double compulsory =
        traffic_figures[TrafficKey("dram_compulsory_share").index].value(e.other.totals(), e.caches());
    d.dram_compulsory_share = std::isfinite(compulsory) ? compulsory : 0;
    d.traced = e.base.launches.size();
    d.windows = e.windows;
    d.spp = e.spp;
    if (!e.speed_ups.empty()) d.speed_up = e.speed_ups.front().value();
    return d;
}

std::string sentence(const Explanation& e) {
    Difference d = difference_of(e);
    if (!d.factors) return "There is no DRAM traffic per ray in both traces, so there is no ratio to explain.";
    const Counters base = e.base.totals(), other = e.other.totals();
    std::vector<std::string> parts;
    bool any_certain = false, all_same = true;
    for (std::size_t level = 0; level < d.bytes.size(); ++level) {
        const Estimate& ratio = d.bytes[level];
        const std::string bytes =
            level + 1 == d.bytes.size() ? "DRAM bytes" : fmt::format("L{}-to-L{} bytes", level + 2, level + 1);
        const std::string values = fmt::format("({} against {})", figure(bytes_per_ray(e, other, level)),
                                               figure(bytes_per_ray(e, base, level)));
        all_same &= ratio.mean == 1 && ratio.half_width.value_or(0) == 0;
        any_certain |= is_certain(ratio);
        const std::string than =
            parts.empty() ? fmt::format(" {} {}", ratio.mean == 1 ? "as" : "than", e.base.name) : std::string();
        if (is_certain(ratio) || !ratio.half_width || ratio.mean == 1)
            parts.push_back(fmt::format("{} {} per ray{} {}{}", change_of(ratio), bytes, than, values,
                                        cause_text(d.factors, level)));
        else
            parts.push_back(
                fmt::format("{} {} per ray{} {}, no certain difference", range_of(ratio), bytes, than, values));
    }
    if (all_same)
        return fmt::format("There is no difference: {} reads as many bytes per ray as {} from every level.",
                           e.other.name, e.base.name);
    std::string text = fmt::format("{} reads {}", e.other.name, fmt::join(parts, "; "));
    text += fmt::format("; with equal miss rates x{} of the DRAM bytes would remain, the miss rates give x{}",
                        with_interval(d.factors->equal_miss_rates, 3), with_interval(d.factors->cache_locality(), 3));
    if (!d.bytes.back().half_width)
        return text + fmt::format("; from one {}, so without a confidence interval.",
                                  e.windows ? "block of windows" : "sample index");
    d.speed_up.reset();  // the sentence is about bytes
    return text + (any_certain ? "." : "; " + remedy(d) + ".");
}

std::string factor_sentences(const Report& report) {
    std::string text;
    for (const Row& row : report.rows) {
        if (!row["dram_bytes_ratio"]) continue;
        text += paragraph(fmt::format("{}: {}.", row_label(report, row), verdict(difference_of(row)).text), 2);
    }
    return text;
}

}  // namespace raycache::cachesim
