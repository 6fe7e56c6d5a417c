#include "tools/jobs/samples_union.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cachesim/report/table.hpp"
#include "tracer/sampling/measures/largest_hole.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

using namespace tracer;

namespace {

constexpr std::size_t histogram_lines = 12;

void check_size(const StrategySettings& strategy, std::uint32_t a, std::uint32_t b, std::uint64_t copies) {
    check_spp(strategy.samples.spp);
    check_parameters(strategy.parameters);
    const std::uint32_t dimensions = make_sequence(strategy.sequence)->dimensions();
    if (std::max(a, b) >= dimensions || a == b)
        throw UsageError(fmt::format("--dimensions {},{}; expected two different ones, 0 to {} for sequence '{}'", a, b,
                                     dimensions - 1, strategy.sequence));
    if (copies == 0) throw UsageError("--copies 0; expected 1 or more: the number of pixels");
    const std::uint64_t n = strategy.samples.spp;
    if (n > max_union_points || copies > max_union_points / n)
        throw UsageError(
            fmt::format("--spp {} with --copies {}; expected at most {} points together: lower one of them", n, copies,
                        max_union_points));
}

void measure_density(SampleUnion& u) {
    const auto window = [&](std::uint32_t d) {
        return jitter_window(u.strategy, std::max(u.first_dimension, u.second_dimension) + 1, d);
    };
    const auto x = window(u.first_dimension), y = window(u.second_dimension);
    if (!x || !y || x->width != y->width) return;
    u.mu = static_cast<double>(x->width) * 0x1p-32;
    if (x->width > 0) u.density = union_density(u.base, *x);
}

std::string histogram(const UnionDensity& density) {
    struct Line {
        double low, high, area = 0;
    };
    std::vector<Line> lines;
    if (density.levels.size() <= histogram_lines) {
        for (const auto& level : density.levels) lines.push_back({level.density, level.density, level.area});
    } else {
        const double width = (density.max - density.min) / histogram_lines;
        for (std::size_t i = 0; i < histogram_lines; ++i)
            lines.push_back(
                {density.min + static_cast<double>(i) * width, density.min + static_cast<double>(i + 1) * width});
        for (const auto& level : density.levels) {
            const auto at = static_cast<std::size_t>((level.density - density.min) / width);
            lines[std::min(at, histogram_lines - 1)].area += level.area;
        }
    }
    double most = 0;
    for (const Line& line : lines) most = std::max(most, line.area);
    std::string text = "\ndensity         % of the area\n";
    for (const Line& line : lines) {
        const std::string range =
            line.low == line.high ? fmt::format("{:.3f}", line.low) : fmt::format("{:.3f}-{:.3f}", line.low, line.high);
        const auto length = static_cast<std::size_t>(std::lround(40 * line.area / most));
        const std::string bar = length == 0 ? std::string() : "  " + std::string(length, '#');
        text += fmt::format("{:<14}  {:>6.2f}{}\n", range, 100 * line.area, bar);
    }
    return text;
}

}  // namespace

std::optional<double> SampleUnion::k_from_discrepancy() const {
    if (!discrepancy) return {};
    return std::sqrt(static_cast<double>(base.size()) * *discrepancy);
}

SampleUnion make_sample_union(StrategySettings settings, std::uint32_t first, std::uint32_t second,
                              std::uint64_t copies) {
    check_size(settings, first, second, copies);
    SampleUnion u;
    u.first_dimension = first;
    u.second_dimension = second;
    u.copies = static_cast<std::uint32_t>(copies);
    settings.samples.width = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(copies))));
    const SamplingStrategy strategy(settings, std::max(first, second) + 1);
    u.strategy = strategy.settings();
    u.parameters = strategy.parameters();
    u.warnings = strategy.warnings();

    const auto n = static_cast<std::uint32_t>(settings.samples.spp);
    const auto sequence = make_sequence(settings.sequence, settings.samples.seed);
    for (std::uint32_t i = 0; i < n; ++i) u.base.push_back({sequence->sample(i, first), sequence->sample(i, second)});
    u.points.reserve(n * copies);
    for (std::uint32_t pixel = 0; pixel < copies; ++pixel)
        for (std::uint32_t i = 0; i < n; ++i)
            u.points.push_back(
                {strategy.value(u.base[i].x, pixel, i, first), strategy.value(u.base[i].y, pixel, i, second)});

    const std::uint64_t side = largest_hole(u.base);
    u.base_hole = static_cast<double>(side) * 0x1p-32;
    u.union_hole = static_cast<double>(largest_hole(u.points)) * 0x1p-32;
    u.hole_free_k = hole_free_k(side, n, 2);
    if (n <= max_star_discrepancy_points) u.discrepancy = star_discrepancy(u.base);
    measure_density(u);
    return u;
}

std::string to_text(const SampleUnion& u) {
    std::string text = fmt::format("{} dimensions {},{}, {}{}{}, N {}, {} copies\n\n", u.strategy.sequence,
                                   u.first_dimension, u.second_dimension, u.strategy.decorrelation,
                                   u.parameters.empty() ? "" : " ", u.parameters, u.base.size(), u.copies);
    const auto add = [&](const char* name, const std::string& value, const char* meaning) {
        text +=
            cachesim::break_lines(fmt::format("{:<28}  {:>9}  {}\n", name, value, meaning), cachesim::text_width, 41);
    };
    const auto number = [](std::optional<double> value) { return value ? fmt::format("{:.5g}", *value) : "-"; };
    add("mu", number(u.mu), "width of the window in which a point moves from pixel to pixel");
    add("largest hole, one pixel", number(u.base_hole), "side of the largest empty square, opposite borders joined");
    add("largest hole, all copies", number(u.union_hole), "of the points of these copies together");
    add("hole-free K", number(u.hole_free_k), "the least K (s=2) at which many copies leave no hole");
    add("star discrepancy", number(u.discrepancy), "D* of the points of the sequence");
    add("K from the discrepancy", number(u.k_from_discrepancy()), "(N * D*)^(1/2)");
    if (!u.density) return text + "no union density: the points of a pixel do not move in a window of their own\n";
    add("density of many copies, min", number(u.density->min), "0: a hole");
    add("  max", number(u.density->max), "1 everywhere: evenly spread, no bias");
    add("  mean square", number(u.density->mean_square), "1: evenly spread");
    add("  area of holes", fmt::format("{:.2f} %", 100 * u.density->holes()), "");
    text.erase(text.find_last_not_of(" \n") + 1);
    return text + "\n" + histogram(*u.density);
}

std::string to_json(const SampleUnion& u) {
    const auto maybe = [](std::optional<double> value) { return value ? nlohmann::ordered_json(*value) : nullptr; };
    nlohmann::ordered_json json{{"sequence", u.strategy.sequence},
                                {"strategy", u.strategy.decorrelation},
                                {"parameters", u.parameters},
                                {"spp", u.base.size()},
                                {"copies", u.copies},
                                {"dimensions", {u.first_dimension, u.second_dimension}},
                                {"mu", maybe(u.mu)},
                                {"largest_hole", u.base_hole},
                                {"largest_hole_of_copies", u.union_hole},
                                {"hole_free_k", u.hole_free_k},
                                {"star_discrepancy", maybe(u.discrepancy)},
                                {"k_from_discrepancy", maybe(u.k_from_discrepancy())},
                                {"density", nullptr}};
    if (u.density) {
        nlohmann::ordered_json levels = nlohmann::ordered_json::array();
        for (const auto& level : u.density->levels)
            levels.push_back({{"boxes", level.covered_by}, {"density", level.density}, {"area", level.area}});
        json["density"] = {{"min", u.density->min},
                           {"max", u.density->max},
                           {"mean_square", u.density->mean_square},
                           {"holes", u.density->holes()},
                           {"levels", levels}};
    }
    return json.dump(2) + "\n";
}

std::string to_csv(const SampleUnion& u) {
    std::string text = "copy,sample,x,y\n";
    for (std::size_t i = 0; i < u.points.size(); ++i)
        text += fmt::format("{},{},{:.10f},{:.10f}\n", i / u.base.size(), i % u.base.size(), u.points[i].x * 0x1p-32,
                            u.points[i].y * 0x1p-32);
    return text;
}

}  // namespace raycache::tools
