#include "tracer/sampling/measures/union_density.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <string_view>

#include "tracer/sampling/measures/box_cover.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

/// One value of a pixel is uniform in [0, 1) over all pixels, wherever its base point lies.
constexpr std::array<std::string_view, 4> uniform_everywhere{"cranley-patterson", "owen", "random", "blue-noise"};

}  // namespace

std::optional<JitterWindow> jitter_window(const StrategySettings& strategy, std::uint32_t dimensions,
                                          std::uint32_t dimension) {
    const std::string& name = strategy.decorrelation;
    if (name == "coherent") return JitterWindow{0, 0};
    for (const std::string_view other : uniform_everywhere)
        if (name == other) return JitterWindow{0, whole_circle};
    SampleSet samples = strategy.samples;
    samples.dimensions = dimensions;
    const auto sequence = make_sequence(strategy.sequence, samples.seed);
    if (name == "net-micro-jitter") {
        const std::uint32_t shared =
            make_decorrelation(name, strategy.parameters, samples, *sequence)->shared_bits(dimension);
        return JitterWindow{0, std::uint64_t{~shared} + 1, shared};
    }
    if (name == "uniform-jitter") {
        const auto k = static_cast<unsigned>(std::bit_width(samples.spp) - 1);
        return JitterWindow{0, whole_circle >> k, k == 0 ? 0 : ~0U << (32 - k)};
    }
    const bool automatic = name == "scrambling-distance";
    if (name != "micro-jitter" && !automatic) return {};
    const double mu = *make_decorrelation(name, strategy.parameters, samples, *sequence)->mu();
    const auto width = static_cast<std::uint64_t>(mu * 0x1p32 + 0.5);  // as FixedMu
    return JitterWindow{automatic ? 0 : width / 2, width};
}

UnionDensity union_density(std::span<const FixedPoint2> points, const JitterWindow& window) {
    if (points.empty()) throw UsageError("union density of 0 points; expected at least 1");
    if (window.width == 0) throw UsageError("union density without jitter; expected a window wider than 0");
    std::map<std::uint64_t, long double> areas;
    if (window.width == whole_circle) {
        areas[points.size()] = 1;
    } else {
        std::vector<FixedPoint2> moved(points.begin(), points.end());
        for (FixedPoint2& p : moved) p = {p.x & window.leading_bits, p.y & window.leading_bits};
        const BoxCover cover(moved);
        CellBoxes boxes;
        for (std::uint32_t cell = 0; cell < cover.cells(); ++cell) {
            cover.collect(cell, window.left, window.width, false, boxes);
            for_each_piece(boxes, cover.cell_width(), [&](int count, std::uint64_t width, std::uint64_t height) {
                areas[boxes.whole + static_cast<std::uint64_t>(count)] +=
                    static_cast<long double>(width) * static_cast<long double>(height) * 0x1p-64L;
                return true;
            });
        }
    }
    const double mu = static_cast<double>(window.width) * 0x1p-32;
    const double unit = 1 / (static_cast<double>(points.size()) * mu * mu);
    UnionDensity result;
    for (const auto& [count, area] : areas)
        result.levels.push_back({count, static_cast<double>(count) * unit, static_cast<double>(area)});
    result.min = result.levels.front().density;
    result.max = result.levels.back().density;
    for (const auto& level : result.levels) result.mean_square += level.density * level.density * level.area;
    return result;
}

}  // namespace raycache::tracer
