#include "tracer/sampling/measures/coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

constexpr std::uint64_t one = std::uint64_t{1} << 32;

/// A window of `side` around a coordinate: [begin, begin + side) modulo 1.
std::uint64_t begin_of(std::uint32_t centre, std::uint64_t side) { return (centre - side / 2) & (one - 1); }

/// Counts on intervals between fixed borders: add to a range, ask for the least. A segment tree.
class LeastCount {
public:
    explicit LeastCount(std::size_t intervals) : size_(intervals), least_(4 * intervals), added_(4 * intervals) {}

    void add(std::size_t first, std::size_t end, int amount) {
        if (first < end) add(1, 0, size_, first, end, amount);
    }
    int least() const { return least_[1]; }

private:
    void add(std::size_t node, std::size_t low, std::size_t high, std::size_t first, std::size_t end, int amount) {
        if (first <= low && high <= end) {
            least_[node] += amount;
            added_[node] += amount;
            return;
        }
        const std::size_t middle = (low + high) / 2;
        if (first < middle) add(2 * node, low, middle, first, end, amount);
        if (end > middle) add(2 * node + 1, middle, high, first, end, amount);
        least_[node] = std::min(least_[2 * node], least_[2 * node + 1]) + added_[node];
    }

    std::size_t size_;
    std::vector<int> least_, added_;
};

/// Walks the square from x = 0 to 1 in strips between which windows begin or end. `Counts` gets add(first, end, ±1) on
/// the intervals between the borders in y; strip(width) comes for every strip, with its counts.
class Sweep {
public:
    Sweep(std::span<const FixedPoint2> points, std::uint64_t side) : side_(side) {
        borders_ = {0, one};
        for (const FixedPoint2& p : points) {
            const std::uint64_t begin = begin_of(p.y, side);
            borders_.push_back(begin);
            borders_.push_back((begin + side) & (one - 1));
        }
        std::sort(borders_.begin(), borders_.end());
        borders_.erase(std::unique(borders_.begin(), borders_.end()), borders_.end());
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            const std::uint64_t begin = begin_of(points[i].x, side), end = begin + side;
            const std::uint64_t y = begin_of(points[i].y, side);
            events_.push_back({begin, y, 1});
            events_.push_back({end & (one - 1), y, -1});
            if (end > one) events_.push_back({0, y, 1});  // open at x = 0
            if (end == one) events_.back().x = one;       // ends with the square
        }
        std::sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) { return a.x < b.x; });
    }

    std::size_t intervals() const { return borders_.size() - 1; }
    std::uint64_t border(std::size_t i) const { return borders_[i]; }

    template <class Counts, class Strip>
    void run(Counts& counts, Strip&& strip) const {
        std::uint64_t at = 0;
        for (std::size_t e = 0; e < events_.size(); ++e) {
            if (events_[e].x > at) {
                if (!strip(events_[e].x - at)) return;
                at = events_[e].x;
            }
            apply(counts, events_[e]);
        }
        if (at < one) strip(one - at);
    }

private:
    struct Event {
        std::uint64_t x, y;
        int amount;
    };

    template <class Counts>
    void apply(Counts& counts, const Event& event) const {
        const std::uint64_t end = event.y + side_;
        if (end <= one) {
            counts.add(index(event.y), index(end), event.amount);
        } else {
            counts.add(index(event.y), intervals(), event.amount);
            counts.add(0, index(end - one), event.amount);
        }
    }
    std::size_t index(std::uint64_t border) const {
        return static_cast<std::size_t>(std::lower_bound(borders_.begin(), borders_.end(), border) - borders_.begin());
    }

    std::uint64_t side_;
    std::vector<std::uint64_t> borders_;
    std::vector<Event> events_;
};

bool covered(std::span<const FixedPoint2> points, std::uint64_t side) {
    const Sweep sweep(points, side);
    LeastCount counts(sweep.intervals());
    bool all = true;
    sweep.run(counts, [&](std::uint64_t) { return all = counts.least() > 0; });
    return all;
}

/// Counts of every interval, one by one.
class EachCount {
public:
    explicit EachCount(std::size_t intervals) : counts_(intervals) {}
    void add(std::size_t first, std::size_t end, int amount) {
        for (; first < end; ++first) counts_[first] += amount;
    }
    int operator[](std::size_t i) const { return counts_[i]; }

private:
    std::vector<int> counts_;
};

void check_some(std::size_t points) {
    if (points == 0) throw UsageError("coverage: expected at least one point, found none; give N = 1 or more");
}

}  // namespace

double largest_empty_square(std::span<const FixedPoint2> points) {
    check_some(points.size());
    std::uint64_t open = 0, closed = one;  // windows that leave a hole, that leave none
    while (closed - open > 1) {
        const std::uint64_t middle = (open + closed) / 2;
        (covered(points, middle) ? closed : open) = middle;
    }
    return static_cast<double>(closed) * 0x1p-32;
}

double largest_gap(std::span<const std::uint32_t> points) {
    check_some(points.size());
    std::vector<std::uint32_t> sorted(points.begin(), points.end());
    std::sort(sorted.begin(), sorted.end());
    std::uint64_t widest = sorted.front() + (one - sorted.back());
    for (std::size_t i = 1; i < sorted.size(); ++i) widest = std::max(widest, std::uint64_t{sorted[i]} - sorted[i - 1]);
    return static_cast<double>(widest) * 0x1p-32;
}

double hole_free_k(double largest_hole, std::uint64_t n, unsigned s) {
    return largest_hole * std::pow(static_cast<double>(n), 1.0 / s);
}

double Coverage::density(std::size_t windows, std::uint64_t n, double mu) const {
    return static_cast<double>(windows) / (static_cast<double>(n) * mu * mu);
}

double Coverage::least(std::uint64_t n, double mu) const {
    const auto some = std::find_if(share.begin(), share.end(), [](double s) { return s > 0; });
    return density(static_cast<std::size_t>(some - share.begin()), n, mu);
}

double Coverage::most(std::uint64_t n, double mu) const { return density(share.size() - 1, n, mu); }

double Coverage::uneven(std::uint64_t n, double mu) const {
    double sum = 0;
    for (std::size_t k = 0; k < share.size(); ++k) sum += share[k] * std::pow(density(k, n, mu) - 1, 2);
    return sum;
}

Coverage coverage(std::span<const FixedPoint2> points, double mu) {
    check_some(points.size());
    if (points.size() > max_coverage_points)
        throw UsageError(fmt::format("coverage: expected at most {} points, found {}; take a smaller N",
                                     max_coverage_points, points.size()));
    const auto side = static_cast<std::uint64_t>(std::llround(mu * static_cast<double>(one)));
    if (side == 0 || side > one)
        throw UsageError(fmt::format("coverage: expected mu from 2^-32 to 1, found {}; give another mu", mu));
    const Sweep sweep(points, side);
    EachCount counts(sweep.intervals());
    std::vector<double> area(points.size() + 1);
    sweep.run(counts, [&](std::uint64_t width) {
        for (std::size_t i = 0; i < sweep.intervals(); ++i)
            area[static_cast<std::size_t>(counts[i])] +=
                static_cast<double>(width) * 0x1p-32 *
                (static_cast<double>(sweep.border(i + 1) - sweep.border(i)) * 0x1p-32);
        return true;
    });
    while (area.size() > 1 && area.back() == 0) area.pop_back();
    return {area};
}

}  // namespace raycache::tracer
