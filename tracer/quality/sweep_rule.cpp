#include "tracer/quality/sweep_rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raycache::tracer {

namespace {

constexpr std::uint64_t most_repeats = 1024;

std::string number(double value, int digits, bool general) {
    return general ? fmt::format("{:.{}g}", value, digits) : fmt::format("{:.{}f}", value, digits);
}

/// What would tell on which side of the limit a figure lies; a difference below a twentieth of the limit is not worth
/// telling.
Raise more(const Measured& m, double limit, const SweepEffort& effort) {
    const double wanted = std::max(std::fabs(m.value - limit), 0.05 * limit);
    if (m.reference_share > 0.5)
        return {"--reference-spp", effort.reference_spp, raised(effort.reference_spp, m.half_width, wanted)};
    return {"--repeats", effort.repeats, std::min(most_repeats, raised(effort.repeats, m.half_width, wanted))};
}
/// Four times as many samples halve what the reference's noise hides.
Raise better_reference(const SweepEffort& effort) {
    return {"--reference-spp", effort.reference_spp, 4 * effort.reference_spp};
}

/// One figure against its limit. `name` and `text` for the reason.
Judgement judge_figure(const Measured& m, double limit, const std::string& reason, const SweepEffort& effort) {
    if (m.resolved()) {
        if (!std::isfinite(m.half_width))
            return {Verdict::unclear, reason, Raise{"--repeats", effort.repeats, 2 * effort.repeats}};
        if (m.value + m.half_width <= limit) return {};
        if (m.value - m.half_width > limit) return {Verdict::rejected, reason, {}};
        return {Verdict::unclear, reason, more(m, limit, effort)};
    }
    if (m.below && *m.below <= limit) return {};
    if (m.above && *m.above > limit) return {Verdict::rejected, reason, {}};
    return {Verdict::unclear, reason, better_reference(effort)};
}

}  // namespace

std::string Raise::text() const { return fmt::format("raise {} from {} to {}", option, from, to); }

std::uint64_t raised(std::uint64_t from, double half_width, double wanted) {
    const double factor = half_width / wanted;
    if (!std::isfinite(factor)) return 2 * from;
    const double to = std::ceil(std::min(0x1p40, static_cast<double>(from) * factor * factor));
    // Two digits are all that such an estimate is worth.
    const double step = std::pow(10.0, std::max(0.0, std::floor(std::log10(std::max(1.0, to))) - 1));
    const double rounded = std::ceil(to / step) * step;
    return std::max(from + 1, static_cast<std::uint64_t>(rounded));
}

std::string measured_text(const Measured& m, int digits, bool general) {
    if (m.resolved()) {
        const std::string value = number(m.value, digits, general);
        if (!std::isfinite(m.half_width)) return value;
        return value + " ±" + number(m.half_width, general ? 2 : digits, general);
    }
    const auto bound = [&](double b) { return fmt::format("{:.2g}", b); };
    if (m.below) return "< " + bound(*m.below);
    if (m.above) return "> " + bound(*m.above);
    return "-";
}

std::string ratio_text(const RmseRatio& ratio) {
    if (ratio.decided_by_pixels)
        return fmt::format("decided by {} pixel{}", *ratio.decided_by_pixels, *ratio.decided_by_pixels == 1 ? "" : "s");
    if (ratio.value.resolved() || ratio.value.below || ratio.value.above) return measured_text(ratio.value, 3);
    if (ratio.baseline_is_zero) return "not defined: the baseline's error is 0";
    return "below the reference's noise";
}

Judgement judge(const SweepPoint& point, const SweepLimits& limits, const SweepEffort& effort) {
    if (point.mu >= 1) return {};
    if (point.ratio.baseline_is_zero) return {Verdict::unclear, ratio_text(point.ratio), {}};
    if (point.ratio.decided_by_pixels)
        return {Verdict::unclear, fmt::format("RMSE {}: use --clamp", ratio_text(point.ratio)), {}};
    const Judgement shared = judge_figure(
        point.r8, limits.r8, fmt::format("R8 {}, at most {}", measured_text(point.r8, 2), limits.r8), effort);
    const Judgement size =
        judge_figure(point.ratio.value, limits.rmse_ratio,
                     fmt::format("RMSE {} x, at most {}", ratio_text(point.ratio), limits.rmse_ratio), effort);
    if (shared.verdict == Verdict::rejected) return shared;
    if (size.verdict == Verdict::rejected) return size;
    return shared.verdict == Verdict::unclear ? shared : size;
}

SweepAdvice advise(std::vector<SweepPoint> points, const SweepLimits& limits, const SweepEffort& effort) {
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.mu > b.mu; });
    SweepAdvice advice;
    for (const SweepPoint& point : points) {
        Judgement judgement = judge(point, limits, effort);
        if (judgement.verdict != Verdict::accepted) {
            advice.blocked_by = point.mu;
            advice.why = std::move(judgement);
            break;
        }
        advice.mu = point.mu;
    }
    return advice;
}

}  // namespace raycache::tracer
