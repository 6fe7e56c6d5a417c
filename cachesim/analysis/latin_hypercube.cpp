#include "cachesim/analysis/latin_hypercube.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>

#include "traces/shuffle.hpp"

namespace raycache::cachesim {

namespace {

/// In [0, 1), of 53 bits. The distributions of the standard library differ from one implementation to the next.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

double number_in(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

std::size_t below(std::mt19937_64& random, std::size_t bound) {
    return static_cast<std::size_t>(uniform(random) * static_cast<double>(bound));
}

}  // namespace

std::vector<std::vector<double>> latin_hypercube(std::size_t points, std::size_t dimensions, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<std::vector<double>> all(points, std::vector<double>(dimensions));
    std::vector<std::size_t> strata(points);
    for (std::size_t d = 0; d < dimensions; ++d) {
        std::iota(strata.begin(), strata.end(), std::size_t{0});
        shuffle_by(strata, [&](std::size_t n) { return below(random, n); });
        for (std::size_t i = 0; i < points; ++i)
            all[i][d] = (static_cast<double>(strata[i]) + uniform(random)) / static_cast<double>(points);
    }
    return all;
}

std::string value_at(const GpuRange& range, double x) {
    if (range.listed) {
        const auto count = static_cast<double>(range.values.size());
        return range.values[std::min(static_cast<std::size_t>(x * count), range.values.size() - 1)];
    }
    const double low = number_in(range.values[0]), high = number_in(range.values[1]);
    const auto is_whole = [](const std::string& text) { return text.find_first_not_of("0123456789") == text.npos; };
    if (is_whole(range.values[0]) && is_whole(range.values[1]))
        return fmt::format("{:.0f}", std::min(high, std::floor(low + x * (high - low + 1))));
    return fmt::format("{:.6g}", low + x * (high - low));
}

}  // namespace raycache::cachesim
