#include "cachesim/analysis/cache_curve.hpp"

#include <algorithm>

namespace raycache::cachesim {

namespace {

/// The first number of ways from `least` to `most` for which it holds, as for all larger ones; else most + 1.
template <class Holds>
std::uint64_t first_ways(std::uint64_t least, std::uint64_t most, const Holds& holds) {
    std::uint64_t end = most + 1;
    while (least < end) {
        const std::uint64_t middle = least + (end - least) / 2;
        if (holds(middle))
            end = middle;
        else
            least = middle + 1;
    }
    return end;
}

}  // namespace

std::uint64_t CurveRow::most_useful_ways() const {
    std::uint64_t most = least_ways();
    for (const WaysCurve& launch : launches) most = std::max(most, launch.most_useful_ways());
    return most;
}

Sums LevelCurve::bytes_per_ray(const CurveRow& row, std::uint64_t ways) const {
    Sums sums{{}, rays};
    for (const WaysCurve& launch : row.launches)
        sums.y.push_back(static_cast<double>(launch.fetched_of(ways)) * row.geometry.sector_bytes);
    return sums;
}

Sums LevelCurve::misses(const CurveRow& row, std::uint64_t ways) const {
    Sums sums{{}, asked};
    for (const WaysCurve& launch : row.launches)
        sums.y.push_back(static_cast<double>(launch.asked - launch.hits_of(ways)));
    return sums;
}

Sums LevelCurve::bytes_per_ray(const PolicyRow& row, std::size_t at) const {
    Sums sums{{}, rays};
    for (const auto& launch : row.launches)
        sums.y.push_back(static_cast<double>(launch[at].fetched) * rows.front().geometry.sector_bytes);
    return sums;
}

Sums LevelCurve::misses(const PolicyRow& row, std::size_t at) const {
    Sums sums{{}, asked};
    for (const auto& launch : row.launches) sums.y.push_back(static_cast<double>(launch[at].asked - launch[at].hits));
    return sums;
}

EquivalentSize equivalent_size(const LevelCurve& base, const LevelCurve& other, DoesAsWell what) {
    const auto sums = [&](const LevelCurve& of, std::uint64_t ways) {
        const CurveRow& row = of.rows.front();
        return what == DoesAsWell::misses ? of.misses(row, ways) : of.bytes_per_ray(row, ways);
    };
    const CurveRow& row = base.rows.front();
    const std::uint64_t own_ways = other.rows.front().geometry.ways, most = row.most_useful_ways(),
                        least = row.least_ways();
    const Sums goal = sums(other, own_ways);
    /// The other's over the base's with so many ways: grows with them, and is at least 1 where the base does as well.
    const auto ratio = [&](std::uint64_t ways) { return ratio_to_baseline(goal, sums(base, ways)); };
    EquivalentSize found;
    found.of = own_ways * other.rows.front().way_bytes();
    const std::uint64_t ways = first_ways(least, most, [&](std::uint64_t w) { return !(ratio(w).mean < 1); });
    if (ways <= most) found.size = ways * row.way_bytes();
    if (!ratio(std::min(ways, most)).half_width) return found;
    const std::uint64_t low = first_ways(least, most, [&](std::uint64_t w) {
        const Estimate e = ratio(w);
        return !(e.mean + e.half_width.value_or(0) < 1);
    });
    const std::uint64_t above = first_ways(least, most, [&](std::uint64_t w) {
        const Estimate e = ratio(w);
        return e.mean - e.half_width.value_or(0) > 1;
    });
    if (low <= most) found.low = low * row.way_bytes();
    if (above <= most) found.high = std::max(least, above - 1) * row.way_bytes();
    // Sizes come in steps: none may be just as good, but the interval is around the smallest that is.
    if (found.size && found.low) found.low = std::min(*found.low, *found.size);
    if (found.size && found.high) found.high = std::max(*found.high, *found.size);
    return found;
}

Estimate equivalent_bandwidth(const LevelCurve& base, const LevelCurve& other) {
    const CurveRow &b = base.rows.front(), &o = other.rows.front();
    return ratio_to_baseline(base.bytes_per_ray(b, b.geometry.ways), other.bytes_per_ray(o, o.geometry.ways));
}

}  // namespace raycache::cachesim
