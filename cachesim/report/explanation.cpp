#include "cachesim/report/explanation.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cachesim/analysis/factor_terms.hpp"
#include "cachesim/report/estimate.hpp"

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

Estimate ratio(const Explanation& e, std::uint64_t Counters::*sectors) {
    return ratio_to_baseline(sectors_per_ray(e.other, sectors), sectors_per_ray(e.base, sectors));
}

/// "32.0 % fewer", "4.1 % more", "0.02 % more", "as many".
std::string change(double ratio) {
    if (ratio == 1) return "as many";
    const double percent = 100 * std::fabs(ratio - 1);
    return fmt::format("{} % {}", percent < 0.05 ? fmt::format("{:.1g}", percent) : fmt::format("{:.1f}", percent),
                       ratio < 1 ? "fewer" : "more");
}

bool certain(const Estimate& ratio) { return !ratio.half_width || std::fabs(ratio.mean - 1) > *ratio.half_width; }

}  // namespace

Counters ExplainedTrace::totals() const {
    Counters sum;
    for (const LaunchStatistics& launch : launches) sum += launch.all();
    return sum;
}

Estimate dram_bytes_ratio(const Explanation& e) { return ratio(e, &Counters::dram_sectors); }
Estimate l2_bytes_ratio(const Explanation& e) { return ratio(e, &Counters::l2_sectors); }

std::string sentence(const Explanation& e) {
    const Counters base = e.base.totals(), other = e.other.totals();
    const auto factors = traffic_factors(base, other, e.levels());
    if (!factors) return "There is no DRAM traffic per ray in both traces, so there is no ratio to explain.";
    const Estimate dram = dram_bytes_ratio(e), l2 = l2_bytes_ratio(e);
    const auto bytes = [&](const Counters& c) {
        return static_cast<double>(c.dram_sectors) * e.sector_bytes / static_cast<double>(c.rays);
    };
    if (dram.mean == 1 && l2.mean == 1)
        return fmt::format(
            "There is no difference: {} reads as many DRAM bytes per ray as {}, {:.1f}, and as many "
            "L2-to-L1 bytes.",
            e.other.name, e.base.name, bytes(other));
    std::string text = fmt::format("{} reads {} DRAM bytes per ray {} {} ({:.1f} against {:.1f}) and {} L2-to-L1 bytes",
                                   e.other.name, change(dram.mean), dram.mean == 1 ? "as" : "than", e.base.name,
                                   bytes(other), bytes(base), change(l2.mean));
    if (const auto most = main_term(*factors))
        text += fmt::format("; {} does most, x{:.3f} ({})", most->term->name, most->factor, most->meaning());
    text += fmt::format("; with equal miss rates x{:.3f} would remain, the miss rates give x{:.3f}",
                        factors->work * factors->simt_efficiency * factors->coalescing,
                        factors->l1_locality * factors->l2_locality * factors->l3_locality);
    if (!dram.half_width) return text + "; from one sample index, so without a confidence interval.";
    if (certain(dram)) return text + ".";
    return text + fmt::format("; but with {} sample indices the ratio is {:.3f} ±{:.3f}, no certain difference.",
                              e.base.launches.size(), dram.mean, *dram.half_width);
}

std::string factor_sentences(const Report& report) {
    std::string text;
    for (const Row& row : report.rows) {
        if (!row.factors || !row.dram_bytes_ratio) continue;
        const auto most = main_term(*row.factors);
        text += fmt::format("{}, N {}, {}{}: ", row.strategy, row.spp, row.gpu,
                            report.by == GroupBy::none ? "" : ", " + row.group);
        if (!most)
            text += "no difference in DRAM bytes/ray.\n";
        else if (certain(*row.dram_bytes_ratio))
            text += fmt::format("{} DRAM bytes/ray, most by {}, x{:.3f} ({}).\n", change(row.dram_bytes_ratio->mean),
                                most->term->name, most->factor, most->meaning());
        else
            text += "no certain difference in DRAM bytes/ray.\n";
    }
    return text;
}

}  // namespace raycache::cachesim
