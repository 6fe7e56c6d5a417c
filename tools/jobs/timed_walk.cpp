#include "tools/jobs/timed_walk.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "tools/jobs/machine.hpp"

namespace raycache::tools {
namespace {

/// The lower one of an even number.
double median(std::vector<double> values) {
    if (values.empty()) return std::nan("");
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

bool same_end(float a, float b, const tracer::Ray& ray) {
    if (!std::isfinite(a) || !std::isfinite(b)) return std::isfinite(a) == std::isfinite(b);
    // Two robust walks differ by rounding, of the ray's start as well as of t.
    const tracer::Vec3 o = ray.origin;
    const float size = std::max({std::fabs(o.x), std::fabs(o.y), std::fabs(o.z)});
    return std::fabs(a - b) <= 1e-4F * std::max(a, b) + 1e-5F * size;
}

}  // namespace

void TimedWalk::walk(const tracer::EmbreeWalker& walker, HardwareCounters& counters, bool warm_up) {
    std::vector<float> ends(log_->rays.size());
    counters.start();
    const double start = thread_seconds();
    for (const tracer::RayBatch& batch : log_->batches) {
        const std::span<const tracer::Ray> rays(&log_->rays[batch.first], batch.count);
        if (batch.any_hit())
            walker.occluded(rays, *mode_, &ends[batch.first]);
        else
            walker.closest(rays, *mode_, &ends[batch.first]);
    }
    const double seconds = thread_seconds() - start;
    const std::vector<double> counts = counters.stop();
    if (warm_up) {
        for (std::size_t i = 0; i < ends.size(); ++i)
            if (!same_end(ends[i], log_->ends[i], log_->rays[i])) ++other_ends_;
        return;
    }
    seconds_.push_back(seconds);
    counts_.push_back(counts);
}

double TimedWalk::seconds() const { return median(seconds_); }

double TimedWalk::counter(std::size_t index) const {
    std::vector<double> values;
    for (const std::vector<double>& counts : counts_)
        if (std::isfinite(counts[index])) values.push_back(counts[index]);
    return median(values);
}

}  // namespace raycache::tools
