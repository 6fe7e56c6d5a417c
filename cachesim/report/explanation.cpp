#include "cachesim/report/explanation.hpp"

#include <fmt/format.h>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/analysis/factor_terms.hpp"
#include "cachesim/report/format.hpp"

namespace raycache::cachesim {

namespace {

Sums sectors_per_ray(const ExplainedTrace& trace, std::uint64_t Counters::*sectors) {
    Sums sums;
    for (const LaunchStatistics& launch : trace.launches) {
        const Counters all = launch.all();
        sums.y.push_back(static_cast<double>(all.*sectors));
        sums.x.push_back(static_cast<double>(all.rays));
    }
    return sums;
}

Estimate bytes_ratio(const Explanation& e, std::uint64_t Counters::*sectors) {
    return ratio_to_baseline(sectors_per_ray(e.other, sectors), sectors_per_ray(e.base, sectors));
}

/// Of what is read from DRAM, 0 where nothing is.
double compulsory_share(const Counters& c) {
    return c.dram_read_sectors()
               ? static_cast<double>(c.dram_first_sectors) / static_cast<double>(c.dram_read_sectors())
               : 0;
}

}  // namespace

Counters ExplainedTrace::totals() const {
    Counters sum;
    for (const LaunchStatistics& launch : launches) sum += launch.all();
    return sum;
}

Estimate dram_bytes_ratio(const Explanation& e) { return bytes_ratio(e, &Counters::dram_sectors); }
Estimate l2_bytes_ratio(const Explanation& e) { return bytes_ratio(e, &Counters::l2_sectors); }

std::vector<Counters> ExplainedTrace::by_launch() const {
    std::vector<Counters> all;
    for (const LaunchStatistics& launch : launches) all.push_back(launch.all());
    return all;
}

std::optional<Factors> Explanation::factors() const {
    return traffic_factors(base.by_launch(), other.by_launch(), levels());
}

Difference difference_of(const Explanation& e) {
    const auto ratio = [&](std::uint64_t Counters::*sectors) { return bytes_ratio(e, sectors); };
    Difference d;
    d.l2_bytes = ratio(&Counters::l2_sectors);
    if (e.levels() == 3) d.l3_bytes = ratio(&Counters::l3_sectors);
    d.dram_bytes = ratio(&Counters::dram_sectors);
    d.factors = e.factors();
    d.dram_compulsory_share = compulsory_share(e.other.totals());
    d.traced = e.base.launches.size();
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
    const auto part = [&](const char* bytes, Traffic traffic, const std::optional<Estimate>& ratio,
                          std::uint64_t Counters::*sectors) {
        if (!ratio) return;
        const auto per_ray = [&](const Counters& c) {
            return figure(e.sector_bytes * static_cast<double>(c.*sectors) / static_cast<double>(c.rays));
        };
        const std::string values = fmt::format("({} against {})", per_ray(other), per_ray(base));
        all_same &= ratio->mean == 1 && ratio->half_width.value_or(0) == 0;
        any_certain |= is_certain(*ratio);
        const bool first = parts.empty();
        const std::string than =
            first ? fmt::format(" {} {}", ratio->mean == 1 ? "as" : "than", e.base.name) : std::string();
        if (is_certain(*ratio) || !ratio->half_width || ratio->mean == 1)
            parts.push_back(fmt::format("{} {} per ray{} {}{}", change_of(*ratio), bytes, than, values,
                                        cause_text(d.factors, traffic)));
        else
            parts.push_back(
                fmt::format("{} {} per ray{} {}, no certain difference", range_of(*ratio), bytes, than, values));
    };
    part("L2-to-L1 bytes", Traffic::l2_to_l1, d.l2_bytes, &Counters::l2_sectors);
    part("L3-to-L2 bytes", Traffic::l3_to_l2, d.l3_bytes, &Counters::l3_sectors);
    part("DRAM bytes", Traffic::dram, d.dram_bytes, &Counters::dram_sectors);
    if (all_same)
        return fmt::format("There is no difference: {} reads as many bytes per ray as {} from every level.",
                           e.other.name, e.base.name);
    std::string text = fmt::format("{} reads {}", e.other.name, fmt::join(parts, "; "));
    text += fmt::format("; with equal miss rates x{} of the DRAM bytes would remain, the miss rates give x{}",
                        with_interval(d.factors->equal_miss_rates, 3), with_interval(d.factors->cache_locality, 3));
    if (!d.dram_bytes->half_width) return text + "; from one sample index, so without a confidence interval.";
    d.speed_up.reset();  // the sentence is about bytes
    return text + (any_certain ? "." : "; " + remedy(d) + ".");
}

std::string factor_sentences(const Report& report) {
    std::string text;
    for (const Row& row : report.rows) {
        if (!row.dram_bytes_ratio) continue;
        text += paragraph(fmt::format("{}: {}.", row_label(report, row), verdict(difference_of(row)).text), 2);
    }
    return text;
}

}  // namespace raycache::cachesim
