#include "cachesim/report/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cachesim/report/format.hpp"

namespace raycache::cachesim {

namespace {

/// What one level fetches.
struct Bytes {
    std::string key, name;
    std::size_t level;
    bool of_dram;
    Estimate ratio;
};

/// From L1 down.
std::vector<Bytes> bytes_of(const Difference& d) {
    std::vector<Bytes> all;
    for (std::size_t level = 0; level < d.bytes.size(); ++level) {
        if (!std::isfinite(d.bytes[level].mean)) continue;
        const bool dram = level + 1 == d.bytes.size();
        all.push_back({dram ? "dram_bytes" : fmt::format("l{}_bytes", level + 2),
                       dram ? "DRAM bytes/ray" : fmt::format("L{}-to-L{} bytes/ray", level + 2, level + 1), level, dram,
                       d.bytes[level]});
    }
    return all;
}

std::string percent(double share) {
    const double p = 100 * std::fabs(share);
    return p != 0 && p < 0.05 ? fmt::format("{:.1g}", p) : fmt::format("{:.1f}", p);
}

std::string one_end(double ratio) { return fmt::format("{} % {}", percent(ratio - 1), ratio < 1 ? "fewer" : "more"); }

std::string times_as_fast(const Estimate& speed_up) {
    return with_interval(speed_up, 2) + " times as fast (predicted)";
}

std::string fast_range(const Estimate& e) {
    return fmt::format("{:.2f} to {:.2f} times as fast (predicted)", e.mean - *e.half_width, e.mean + *e.half_width);
}

bool same(const Estimate& ratio) { return ratio.mean == 1 && ratio.half_width.value_or(0) == 0; }

std::string list(const std::vector<std::string>& parts, const char* separator) {
    return fmt::format("{}", fmt::join(parts, separator));
}

/// What was counted where nothing can be certain: a single sample index.
std::string without_interval(const Difference& d, const std::vector<Bytes>& bytes) {
    std::vector<std::string> parts;
    if (d.speed_up) parts.push_back(times_as_fast(*d.speed_up));
    for (const Bytes& b : bytes)
        parts.push_back(change_of(b.ratio) + ' ' + b.name +
                        (b.level == bytes.front().level ? cause_text(d.factors, b.level) : ""));
    if (d.windows) return list(parts, "; ") + "; from one block, so without an interval: raise --windows";
    return list(parts, "; ") + "; from one sample index, so without an interval: raise --trace-samples";
}

/// The end of the interval that is further from 1: "2.1 %".
std::string at_most(const Estimate& ratio) {
    return percent(std::fabs(ratio.mean - 1) + ratio.half_width.value_or(0)) + " %";
}

std::string nothing_certain(const Difference& d, const std::vector<Bytes>& bytes) {
    std::vector<std::string> parts;
    if (d.windows) {
        if (d.speed_up) parts.push_back(at_most(*d.speed_up) + " in time (predicted)");
        for (const Bytes& b : bytes)
            if (b.ratio.half_width) parts.push_back(at_most(b.ratio) + " in " + b.name);
        return "no difference above " + list(parts, ", ") + "; to see a smaller one, " + remedy(d);
    }
    if (d.speed_up) parts.push_back(fast_range(*d.speed_up));
    for (const Bytes& b : bytes)
        if (b.ratio.half_width) parts.push_back(range_of(b.ratio) + ' ' + b.name);
    return "no certain difference; at most " + list(parts, ", ") + "; " + remedy(d);
}

}  // namespace

std::span<const BytesFigures> bytes_figures(std::size_t levels) {
    static constexpr BytesFigures two[] = {{"l2_bytes_per_ray", "l2_bytes_ratio"},
                                           {"dram_bytes_per_ray", "dram_bytes_ratio"}};
    static constexpr BytesFigures three[] = {{"l2_bytes_per_ray", "l2_bytes_ratio"},
                                             {"l3_bytes_per_ray", "l3_bytes_ratio"},
                                             {"dram_bytes_per_ray", "dram_bytes_ratio"}};
    return levels == 3 ? std::span<const BytesFigures>(three) : two;
}

Difference difference_of(const Row& row) {
    Difference d;
    for (const BytesFigures& bytes : bytes_figures(row.caches.levels))
        if (row[bytes.ratio]) d.bytes.push_back(*row[bytes.ratio]);
    d.factors = row.factors;
    d.dram_compulsory_share = row["dram_compulsory_share"].value_or(Estimate{}).mean;
    d.windows = row.windows;
    d.traced = row.samples.size();
    d.spp = row.spp;
    return d;
}

std::string compulsory_note(const std::string& gpus) {
    return fmt::format(
        "{}: at least {:.0f} % of the sectors read from DRAM are compulsory misses (first touches). Each sample index "
        "is "
        "a launch that begins with cold caches, and the last cache holds what it reads, so DRAM bytes say how many "
        "sectors are touched, not how often; L2->L1 bytes tell strategies apart",
        gpus, 100 * mostly_compulsory);
}

bool is_certain(const Estimate& ratio) { return ratio.half_width && std::fabs(ratio.mean - 1) > *ratio.half_width; }

std::string change_of(const Estimate& ratio) {
    if (ratio.mean == 1) return "as many";
    const std::string width = ratio.half_width ? fmt::format(" ±{}", percent(*ratio.half_width)) : "";
    return fmt::format("{}{} % {}", percent(ratio.mean - 1), width, ratio.mean < 1 ? "fewer" : "more");
}

std::string range_of(const Estimate& ratio) {
    const double half = ratio.half_width.value_or(0);
    return one_end(std::max(0.0, ratio.mean - half)) + " to " + one_end(ratio.mean + half);
}

std::string cause_text(const std::optional<Factors>& factors, std::size_t level) {
    const auto cause = factors ? main_cause(*factors, level) : std::nullopt;
    if (!cause) return {};
    return fmt::format(", most {}by {}, x{} ({})",
                       cause->factor.half_width && !is_certain(cause->factor) ? "perhaps " : "", cause->name,
                       with_interval(cause->factor, 3), cause->meaning);
}

std::string remedy(const Difference& d) {
    // A half width falls with the square root of the sample indices.
    double least = std::numeric_limits<double>::infinity();
    std::vector<Estimate> ratios;
    if (d.speed_up) ratios.push_back(*d.speed_up);
    for (const Bytes& b : bytes_of(d)) ratios.push_back(b.ratio);
    for (const Estimate& ratio : ratios)
        if (ratio.half_width && ratio.mean != 1)
            least = std::min(least, std::pow(*ratio.half_width / (ratio.mean - 1), 2));
    const double wanted = std::ceil(least * static_cast<double>(d.traced)) + 1;
    if (d.windows)
        return fmt::format(
            "ask for a smaller --target-error{}",
            std::isfinite(wanted) ? fmt::format(", or --windows {:.0f}", wanted * d.windows->windows) : "");
    if (wanted <= static_cast<double>(d.spp))
        return fmt::format("raise --trace-samples from {} to about {:.0f}", d.traced, wanted);
    if (d.traced < d.spp)
        return fmt::format("raise --trace-samples from {} towards all {}, or the resolution, to narrow this", d.traced,
                           d.spp);
    return "all sample indices are traced: raise the resolution to narrow this";
}

Verdict verdict(const Difference& d) {
    const std::vector<Bytes> bytes = bytes_of(d);
    if (bytes.empty() && !d.speed_up) return {"nothing to compare: no traffic", std::nullopt};
    if ((!d.speed_up || same(*d.speed_up)) &&
        std::all_of(bytes.begin(), bytes.end(), [](const Bytes& b) { return same(b.ratio); }))
        return {d.speed_up ? "no difference in predicted time or bytes/ray" : "no difference in bytes/ray",
                std::nullopt};
    const bool intervals = std::any_of(bytes.begin(), bytes.end(), [](const Bytes& b) { return b.ratio.half_width; }) ||
                           (d.speed_up && d.speed_up->half_width);
    if (!intervals) return {without_interval(d, bytes), std::nullopt};

    Verdict result;
    std::vector<std::string> parts;
    const bool time_certain = d.speed_up && is_certain(*d.speed_up);
    if (time_certain) {
        parts.push_back(times_as_fast(*d.speed_up));
        result.level = "time";
    }
    bool cause_named = false;
    for (const Bytes& b : bytes) {
        if (!is_certain(b.ratio)) continue;
        std::string part = change_of(b.ratio) + ' ' + b.name;
        if (b.of_dram && d.dram_compulsory_share >= mostly_compulsory) part += " (compulsory misses of cold launches)";
        if (!cause_named) part += cause_text(d.factors, b.level);
        cause_named = true;
        parts.push_back(part);
        if (!result.level) result.level = b.key;
    }
    if (parts.empty()) return {nothing_certain(d, bytes), std::nullopt};
    if (!cause_named && !bytes.empty() && bytes.front().ratio.half_width)
        parts.push_back(
            fmt::format("no certain difference in bytes: {} {}", range_of(bytes.front().ratio), bytes.front().name));
    if (d.speed_up && !time_certain && d.speed_up->half_width)
        parts.push_back("no certain difference in time: " + fast_range(*d.speed_up));
    result.text = list(parts, "; ");
    return result;
}

}  // namespace raycache::cachesim
