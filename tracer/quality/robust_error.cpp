#include "tracer/quality/robust_error.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

namespace {

/// Pixels in a random order that depends on their number only.
std::vector<std::uint32_t> shuffled(std::size_t count) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    const HashKey key(0, HashPurpose::independent);
    for (std::size_t i = count; i > 1; --i) {
        const HashWords words = key.words(static_cast<std::uint32_t>(i), 0, 0);
        std::swap(order[i - 1], order[(std::uint64_t{words[0]} << 32 | words[1]) % i]);
    }
    return order;
}

/// The `count` largest of the values, in descending order, with their indices.
std::vector<std::pair<double, std::size_t>> largest(const std::function<double(std::size_t)>& value, std::size_t of,
                                                    std::size_t count) {
    std::vector<std::pair<double, std::size_t>> all(of);
    for (std::size_t p = 0; p < of; ++p) all[p] = {value(p), p};
    count = std::min(count, of);
    const auto more = [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second < b.second;
    };
    std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(), more);
    all.resize(count);
    return all;
}

double sum_of(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace

Measured median_of_means(const ErrorSums& sums) {
    Measured m{not_a_number, not_a_number, {}, {}, 0};
    const std::size_t pixels = sums.pixel_square.size();
    if (pixels < robust_groups) return m;
    std::array<double, robust_groups> mean{}, count{};
    const std::vector<std::uint32_t> order = shuffled(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        mean[i % robust_groups] += double{sums.pixel_square[order[i]]};
        count[i % robust_groups] += 1;
    }
    for (std::size_t g = 0; g < robust_groups; ++g) mean[g] /= count[g];
    std::sort(mean.begin(), mean.end());
    const auto root = [](double square) { return std::sqrt(std::max(0.0, square)); };
    const double median = mean[robust_groups / 2], low = mean[7], high = mean[17];
    if (median > 0 && low > 0) {
        m.value = root(median);
        m.half_width = std::max(root(high) - m.value, m.value - root(low));
    } else if (high > 0) {
        m.below = root(high);
    } else if (median == 0) {
        m.value = m.half_width = 0;
    }
    return m;
}

std::size_t handful(std::size_t pixels) {
    return pixels < 1024 ? 1 : std::max<std::size_t>(3, (pixels + 9999) / 10000);
}

std::optional<FewPixels> few_pixels(const ErrorSums& sums) {
    const std::size_t pixels = sums.pixel_square.size();
    const double all = sum_of(sums.pixel_square);
    if (!(all > 0)) return {};
    FewPixels few;
    for (const auto& [square, pixel] :
         largest([&](std::size_t p) { return double{sums.pixel_square[p]}; }, pixels, handful(pixels))) {
        if (few.count == 0) few.largest = pixel;
        ++few.count;
        few.share += square / all;
        if (few.share >= 0.5) return few;
    }
    return {};
}

std::optional<std::size_t> few_pixels_between(const ErrorSums& a, const ErrorSums& b) {
    const std::size_t pixels = a.pixel_square.size();
    const double difference = sum_of(a.pixel_square) - sum_of(b.pixel_square), sign = difference < 0 ? -1 : 1;
    double left = sign * difference;
    std::size_t count = 0;
    for (const auto& top :
         largest([&](std::size_t p) { return sign * (double{a.pixel_square[p]} - double{b.pixel_square[p]}); }, pixels,
                 handful(pixels))) {
        ++count;
        left -= top.first;
        if (left <= 1e-6 * std::fabs(difference)) return count;  // to the digits of a float
    }
    return {};
}

}  // namespace raycache::tracer
