#include "tracer/sampling/measures/star_discrepancy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

/// The points left of a growing x, counted by height.
class CountsBelow {
public:
    explicit CountsBelow(std::span<const FixedPoint2> points) : share_(1.0 / static_cast<double>(points.size())) {
        for (const FixedPoint2& p : points) heights_.push_back(p.y);
        std::sort(heights_.begin(), heights_.end());
        heights_.erase(std::unique(heights_.begin(), heights_.end()), heights_.end());
        for (const std::uint32_t y : heights_) edges_.push_back(y * 0x1p-32);
        edges_.push_back(1.0);
        counts_.resize(edges_.size());
    }

    void add(std::uint32_t y) {
        const auto rank = std::lower_bound(heights_.begin(), heights_.end(), y) - heights_.begin();
        for (auto i = static_cast<std::size_t>(rank) + 1; i < counts_.size(); ++i) ++counts_[i];
    }

    /// Largest area minus share of the open boxes [0,x) x [0,edge).
    double worst_open(double x) const {
        double worst = 0;
        for (std::size_t i = 0; i < edges_.size(); ++i) worst = std::max(worst, x * edges_[i] - counts_[i] * share_);
        return worst;
    }
    /// Largest share minus area of the closed boxes [0,x] x [0,height].
    double worst_closed(double x) const {
        double worst = 0;
        for (std::size_t i = 0; i + 1 < edges_.size(); ++i)
            worst = std::max(worst, counts_[i + 1] * share_ - x * edges_[i]);
        return worst;
    }

private:
    double share_;                        ///< 1/N
    std::vector<std::uint32_t> heights_;  ///< of the points, ascending, each once
    std::vector<double> edges_;           ///< the heights as numbers in [0, 1), then 1
    std::vector<std::int32_t> counts_{};  ///< counts_[i] = points added so far strictly below edges_[i]
};

}  // namespace

double star_discrepancy(std::span<const FixedPoint2> points) {
    if (points.empty() || points.size() > max_star_discrepancy_points)
        throw UsageError(
            fmt::format("star discrepancy of {} points; expected 1 to {}, above which the exact one takes "
                        "too long",
                        points.size(), max_star_discrepancy_points));
    std::vector<FixedPoint2> by_x(points.begin(), points.end());
    std::sort(by_x.begin(), by_x.end(), [](const FixedPoint2& a, const FixedPoint2& b) { return a.x < b.x; });
    CountsBelow counts(points);
    double worst = 0;
    for (std::size_t i = 0; i < by_x.size();) {
        const std::uint32_t column = by_x[i].x;
        const double x = column * 0x1p-32;
        worst = std::max(worst, counts.worst_open(x));
        for (; i < by_x.size() && by_x[i].x == column; ++i) counts.add(by_x[i].y);
        worst = std::max(worst, counts.worst_closed(x));
    }
    return std::max(worst, counts.worst_open(1.0));
}

}  // namespace raycache::tracer
