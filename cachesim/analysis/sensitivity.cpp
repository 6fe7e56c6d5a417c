#include "cachesim/analysis/sensitivity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace raycache::cachesim {

namespace {

Estimate changed_speed_up(const Estimate& speed_up, const Estimate& change) {
    Estimate product{speed_up.mean * change.mean, std::nullopt};
    if (speed_up.half_width && change.half_width)
        product.half_width =
            product.mean * std::hypot(*speed_up.half_width / speed_up.mean, *change.half_width / change.mean);
    return product;
}

bool certainly_not_1(const Estimate& e) { return e.half_width && std::fabs(e.mean - 1) > *e.half_width; }

const Estimate& speed_up(const VariedPoint& p, Per per) { return per == Per::index ? p.per_index : p.per_ray; }

std::string shown(const Estimate& e) {
    return e.half_width ? fmt::format("{:.3f} ±{:.3f}", e.mean, *e.half_width) : fmt::format("{:.3f}", e.mean);
}

/// Of the value's points, the one that moves the speed-up across 1 for certain and furthest; null for none.
const VariedPoint* crossing(const Sensitivity& s, const Effect& effect, const Estimate& at_file, Per per) {
    const VariedPoint* found = nullptr;
    for (const std::size_t i : effect.points) {
        const VariedPoint& p = s.one_by_one[i];
        if ((speed_up(p, per).mean > 1) == (at_file.mean > 1) || !certainly_not_1(p.change)) continue;
        if (!found || std::fabs(p.change.mean - 1) > std::fabs(found->change.mean - 1)) found = &p;
    }
    return found;
}

/// Points lie on both sides of 1.
std::string what_it_depends_on(const Sensitivity& s, const Estimate& at_file, Per per) {
    const auto effects = ranked_effects(s);
    std::vector<std::string> parts;
    for (const Effect& effect : effects)
        if (const VariedPoint* p = crossing(s, effect, at_file, per))
            parts.push_back(fmt::format("{} ({} at {}, {} at {})", effect.key, shown(at_file), effect.value,
                                        shown(speed_up(*p, per)), p->values.front().second));
    constexpr std::size_t most_named = 3;
    if (parts.size() > most_named) {
        parts.resize(most_named);
        parts.emplace_back("others");
    }
    if (!parts.empty()) return fmt::format("not known, depends on {}", fmt::join(parts, ", "));
    const bool together = std::any_of(s.hypercube.begin(), s.hypercube.end(), [&](const VariedPoint& p) {
        return (speed_up(p, per).mean > 1) != (at_file.mean > 1) && certainly_not_1(p.change);
    });
    if (!together)
        return fmt::format(
            "not known: {} with the file's values, and what else may move it across 1 is less than this "
            "sample can tell; take more windows",
            shown(at_file));
    for (std::size_t i = 0; i < std::min<std::size_t>(2, effects.size()); ++i) parts.push_back(effects[i].key);
    return fmt::format("not known, depends on several values together, most on {}", fmt::join(parts, ", "));
}

}  // namespace

Estimate speed_up_per_index(const TimedSums& baseline, const TimedSums& other) {
    return product_of_powers({{baseline.cycles, 1}, {other.cycles, -1}});
}

Estimate speed_up_per_ray(const TimedSums& baseline, const TimedSums& other) {
    return product_of_powers({{baseline.cycles, 1}, {baseline.rays, -1}, {other.cycles, -1}, {other.rays, 1}});
}

VariedPoint varied_point(std::vector<ChosenValue> values, const TimedSums& base, const TimedSums& other,
                         const TimedSums& base_file, const TimedSums& other_file, const Sensitivity& at_file,
                         bool whole_sample) {
    VariedPoint point{std::move(values), {}, {}, {}};
    point.change =
        product_of_powers({{base.cycles, 1}, {other.cycles, -1}, {base_file.cycles, -1}, {other_file.cycles, 1}});
    point.per_index =
        whole_sample ? speed_up_per_index(base, other) : changed_speed_up(at_file.per_index, point.change);
    point.per_ray = whole_sample ? speed_up_per_ray(base, other) : changed_speed_up(at_file.per_ray, point.change);
    return point;
}

std::vector<Effect> ranked_effects(const Sensitivity& s) {
    std::vector<Effect> effects;
    for (const GpuValue& value : s.open) {
        Effect& effect = effects.emplace_back();
        effect.key = value.key;
        effect.value = value.value;
        double least = s.per_index.mean, most = s.per_index.mean;
        effect.low = effect.high = s.per_index;
        effect.low_value = effect.high_value = value.value;
        for (std::size_t i = 0; i < s.one_by_one.size(); ++i) {
            const VariedPoint& p = s.one_by_one[i];
            if (p.values.front().first != value.key) continue;
            const std::string& tried = p.values.front().second;
            const bool is_low = value.range->listed ? p.per_index.mean < least : tried == value.range->values.front();
            const bool is_high = value.range->listed ? p.per_index.mean > most : tried == value.range->values.back();
            if (is_low) effect.low = p.per_index, effect.low_value = tried;
            if (is_high) effect.high = p.per_index, effect.high_value = tried;
            least = std::min(least, p.per_index.mean);
            most = std::max(most, p.per_index.mean);
            effect.certain |= certainly_not_1(p.change);
            effect.points.push_back(i);
        }
        effect.swing = most - least;
    }
    std::stable_sort(effects.begin(), effects.end(), [](const auto& a, const auto& b) { return a.swing > b.swing; });
    return effects;
}

double hypercube_quantile(const Sensitivity& s, double p) {
    if (s.hypercube.empty()) return 0;
    std::vector<double> means;
    for (const VariedPoint& point : s.hypercube) means.push_back(point.per_index.mean);
    std::sort(means.begin(), means.end());
    const double at = p * static_cast<double>(means.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, means.size() - 1);
    return means[below] + (at - static_cast<double>(below)) * (means[above] - means[below]);
}

SensitivityVerdict verdict_of(const Sensitivity& s, Per per) {
    const Estimate& at_file = per == Per::index ? s.per_index : s.per_ray;
    std::vector<Estimate> all{at_file};
    for (const auto* points : {&s.one_by_one, &s.hypercube})
        for (const VariedPoint& p : *points) all.push_back(speed_up(p, per));
    const auto by_mean = [](const Estimate& a, const Estimate& b) { return a.mean < b.mean; };
    const auto [least, most] = std::minmax_element(all.begin(), all.end(), by_mean);
    if (least->mean <= 1 && most->mean >= 1) return {Outcome::not_known, what_it_depends_on(s, at_file, per)};
    const bool faster = least->mean > 1;
    const char* const word = faster ? "faster" : "slower";
    if (std::all_of(all.begin(), all.end(), certainly_not_1))
        return {faster ? Outcome::faster : Outcome::slower,
                fmt::format("{} whatever is assumed: {:.3f} to {:.3f} times as fast", word, least->mean, most->mean)};
    // The point nearest to 1.
    const Estimate& nearest = faster ? *least : *most;
    return {
        Outcome::not_known,
        fmt::format("not known: {} by all that is assumed, {:.3f} to {:.3f} times as fast, but the sample leaves it "
                    "open, {} at the nearest; take more windows",
                    word, least->mean, most->mean, shown(nearest))};
}

}  // namespace raycache::cachesim
