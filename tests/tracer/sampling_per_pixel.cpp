// Decorrelations that give each pixel, or each class of pixels, points of its own: what a pixel keeps of the net, and
// what all pixels together cover.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <vector>

#include "tracer/sampling/blue_noise_mask.hpp"
#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/sampling_strategy.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

constexpr std::uint32_t width = 64, pixels = 64 * 64;

SamplingStrategy strategy(const std::string& sequence, const std::string& decorrelation, std::uint64_t spp,
                          const std::function<void(Parameters&)>& change = {}, std::uint32_t dimensions = 8) {
    StrategySettings settings;
    settings.sequence = sequence;
    settings.decorrelation = decorrelation;
    settings.samples.spp = spp;
    settings.samples.seed = 3;
    settings.samples.width = width;
    if (change) change(settings.parameters);
    return {settings, dimensions};
}

/// For net-micro-jitter.
void sets(Parameters& parameters) { parameters.set("share", "sets"); }

std::vector<std::vector<std::uint32_t>> base_points(const SamplingStrategy& s, std::uint32_t n) {
    std::vector<std::vector<std::uint32_t>> points;
    for (std::uint32_t i = 0; i < n; ++i) points.push_back(s.base_point(i));
    return points;
}

std::uint64_t leading(std::uint32_t x, unsigned bits) { return std::uint64_t{x} >> (32 - bits); }

/// Whether the 2^m points of one pixel put one point in each elementary interval of dimensions d, d+1.
bool pixel_has_net(const SamplingStrategy& s, std::uint32_t pixel, unsigned m, std::uint32_t d) {
    const auto base = base_points(s, 1U << m);
    for (unsigned a = 0; a <= m; ++a) {
        std::vector<bool> seen(std::size_t{1} << m);
        for (std::uint32_t i = 0; i < 1U << m; ++i) {
            const auto cell = leading(s.value(base[i][d], pixel, i, d), a) << (m - a) |
                              leading(s.value(base[i][d + 1], pixel, i, d + 1), m - a);
            if (seen[cell]) return false;
            seen[cell] = true;
        }
    }
    return true;
}

/// z of the mean, over all pixels, of f of a pixel's points, against the integral: 1 for an unbiased estimator.
double bias_z(const SamplingStrategy& s, std::uint32_t n, double integral,
              const std::function<double(const std::array<double, 4>&)>& f) {
    const auto base = base_points(s, n);
    double sum = 0, squares = 0;
    for (std::uint32_t p = 0; p < pixels; ++p) {
        double mean = 0;
        for (std::uint32_t i = 0; i < n; ++i) {
            std::array<double, 4> y{};
            for (std::uint32_t d = 0; d < 4; ++d) y[d] = (s.value(base[i][d], p, i, d) + 0.5) * 0x1p-32;
            mean += f(y) / n;
        }
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / pixels, variance = squares / pixels - mean * mean;
    return std::abs(mean - integral) / std::sqrt(variance / pixels);
}

}  // namespace

TEST_CASE("sampling: owen and both net-micro-jitters keep a whole net in every pixel") {
    for (const std::string sequence : {"sobol", "sobol-owen-02", "sobol-owen-4d", "pmj02"})
        for (const std::string decorrelation : {"owen", "net-micro-jitter", "net-micro-jitter-fast"}) {
            for (const unsigned m : {0U, 1U, 4U, 8U}) {
                const auto s = strategy(sequence, decorrelation, std::uint64_t{1} << m);
                for (const std::uint32_t pixel : {0U, 1U, 65U, 4095U}) {
                    INFO(sequence << " " << decorrelation << " m " << m << " pixel " << pixel);
                    REQUIRE(pixel_has_net(s, pixel, m, 0));
                }
            }
        }
}

TEST_CASE(
    "sampling: net-micro-jitter shares the leading k bits with all pixels and is uniform below, without wrapping") {
    const auto s = strategy("sobol-owen-4d", "net-micro-jitter", 4096, sets);
    CHECK(s.parameters() == "share=sets k=3 mu=0.125");
    const auto base = base_points(s, 16);
    for (std::uint32_t d = 0; d < 8; ++d)
        for (std::uint32_t i = 0; i < 16; ++i) {
            std::set<std::uint32_t> rests;
            for (std::uint32_t p = 0; p < 256; ++p) {
                const std::uint32_t y = s.value(base[i][d], p, i, d);
                REQUIRE(leading(y, 3) == leading(base[i][d], 3));
                rests.insert(y << 3);
            }
            CHECK(rests.size() > 250);
        }
}

TEST_CASE("sampling: net-micro-jitter-fast gives pixels of one class the same leading bits, and other classes others") {
    const auto s = strategy("sobol-owen-02", "net-micro-jitter-fast", 256);
    CHECK(s.parameters() == "k=4 mu=0.0625 m=8");
    const auto base = base_points(s, 256);
    std::set<std::vector<std::uint64_t>> nets;
    for (std::uint32_t p = 0; p < pixels; ++p) {
        std::vector<std::uint64_t> net;
        for (std::uint32_t i = 0; i < 16; ++i) net.push_back(leading(s.value(base[i][2], p, i, 2), 4));
        nets.insert(net);
        const std::uint32_t same_class = (p / width % 8) * width + p % 8;
        for (std::uint32_t i = 0; i < 16; ++i)
            if (leading(s.value(base[i][2], same_class, i, 2), 4) != net[i]) FAIL("pixel " << p);
    }
    CHECK(nets.size() > 56);  // of 64, some alike by chance
}

TEST_CASE("sampling: N = 1 leaves net-micro-jitter no bit to share: it is owen, k = 0 and no shift by 32") {
    for (const std::string sequence : {"sobol", "sobol-owen-4d"}) {
        const auto net = strategy(sequence, "net-micro-jitter", 1, sets), owen = strategy(sequence, "owen", 1);
        CHECK(net.parameters() == "share=sets k=0 mu=1");
        for (std::uint32_t p = 0; p < 100; ++p)
            for (std::uint32_t d = 0; d < 8; ++d)
                REQUIRE(net.value(net.base_point(0)[d], p, 0, d) == owen.value(owen.base_point(0)[d], p, 0, d));
    }
}

TEST_CASE("sampling: k of net-micro-jitter falls where native Sobol sets hold unequal cells, and N = 2^31 works") {
    const auto s = strategy("sobol", "net-micro-jitter", 256, sets, 26);
    CHECK_THAT(s.parameters(), Catch::StartsWith("share=sets k=1..2 mu=0.25..0.5"));
    const auto large = strategy("sobol-owen-4d", "net-micro-jitter", std::uint64_t{1} << 31, sets);
    CHECK(large.parameters() == "share=sets k=7 mu=0.0078125");
    CHECK(large.base_point((std::uint64_t{1} << 31) - 1).size() == 8);
    CHECK(strategy("sobol-owen-02", "net-micro-jitter-fast", std::uint64_t{1} << 32).parameters() ==
          "k=16 mu=1.52587890625e-05 m=8");
}

TEST_CASE("sampling: the table of k in docs/sampling.md, smallest and largest over the sets of 22 dimensions") {
    using Range = std::pair<unsigned, unsigned>;
    struct Row {
        std::string sequence;
        unsigned s;
        std::vector<Range> k;  ///< for m = 2, 4, … 16
    };
    const std::vector<Row> table{{"sobol", 2, {{0, 1}, {1, 2}, {1, 3}, {2, 4}, {2, 5}, {5, 6}, {6, 7}, {6, 8}}},
                                 {"sobol", 4, {{0, 0}, {0, 1}, {0, 1}, {1, 2}, {2, 2}, {2, 3}, {2, 3}, {3, 3}}},
                                 {"sobol-owen-02", 2, {{1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}, {6, 6}, {7, 7}, {8, 8}}},
                                 {"sobol-owen-4d", 2, {{0, 1}, {2, 2}, {3, 3}, {3, 4}, {4, 5}, {6, 6}, {7, 7}, {7, 8}}},
                                 {"sobol-owen-4d", 4, {{0, 0}, {1, 1}, {1, 1}, {1, 1}, {2, 2}, {3, 3}, {3, 3}, {3, 3}}},
                                 {"pmj02", 2, {{1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}, {6, 6}, {7, 7}, {8, 8}}}};
    for (const Row& row : table) {
        const auto sequence = make_sequence(row.sequence);
        for (std::size_t column = 0; column < row.k.size(); ++column) {
            Range range{32, 0};
            for (std::uint32_t first = 0; first < 22; first += row.s) {
                const unsigned k = sequence->equal_cell_bits(first, row.s, 2 + 2 * static_cast<unsigned>(column));
                range = {std::min(range.first, k), std::max(range.second, k)};
            }
            INFO(row.sequence << " s " << row.s << " m " << 2 + 2 * column);
            CHECK(range == row.k[column]);
        }
    }
}

TEST_CASE("sampling: owen, net-micro-jitter, Cranley-Patterson and random have no bias over the pixels, coherent has") {
    const auto edge = [](const std::array<double, 4>& y) { return y[0] + y[1] + y[2] + y[3] < 1.7 ? 1.0 : 0.0; };
    const auto smooth = [](const std::array<double, 4>& y) {
        return y[0] * y[0] * y[1] * std::exp(y[2]) * (1 + y[3] * y[1]);
    };
    // Volume of {sum < t} in four dimensions, 1 <= t <= 2: (t^4 - 4 (t-1)^4) / 24.
    const double edge_integral = (std::pow(1.7, 4) - 4 * std::pow(0.7, 4)) / 24;
    const double smooth_integral = (std::exp(1.0) - 1) / 3 * (0.5 + 1.0 / 3 / 2);
    constexpr double limit = 4;  // one in 16,000 unbiased estimators is beyond
    for (const auto& [sequence, decorrelation] : {std::pair{"sobol-owen-4d", "owen"},
                                                  {"sobol", "owen"},
                                                  {"sobol-owen-4d", "net-micro-jitter"},
                                                  {"sobol", "cranley-patterson"},
                                                  {"halton-scrambled", "cranley-patterson"},
                                                  {"r2", "cranley-patterson"},
                                                  {"pmj02", "owen"},
                                                  {"sobol", "random"}}) {
        const auto s = strategy(sequence, decorrelation, 16, sets);
        INFO(sequence << " x " << decorrelation);
        CHECK(bias_z(s, 16, edge_integral, edge) < limit);
        CHECK(bias_z(s, 16, smooth_integral, smooth) < limit);
    }
    const auto light = [](Parameters& parameters) { parameters.set("share", "light0"); };
    for (const std::string sequence : {"sobol", "sobol-owen-02", "sobol-owen-4d", "pmj02"}) {
        const auto s = strategy(sequence, "net-micro-jitter", 16, light);
        INFO(sequence);
        CHECK(bias_z(s, 16, edge_integral, edge) < limit);
        CHECK(bias_z(s, 16, smooth_integral, smooth) < limit);
    }
    CHECK(bias_z(strategy("sobol", "micro-jitter", 16), 16, smooth_integral, smooth) > limit);  // the test has teeth
}

TEST_CASE("sampling: uniform-jitter puts one point in each of the N strata, all at the same place in it") {
    for (const std::string sequence : {"sobol", "sobol-owen-02", "pmj02"}) {
        const auto s = strategy(sequence, "uniform-jitter", 128);
        const auto base = base_points(s, 128);
        for (const std::uint32_t d : {0U, 1U, 7U}) {
            std::set<std::uint64_t> strata, places;
            for (std::uint32_t i = 0; i < 128; ++i) {
                strata.insert(leading(s.value(base[i][d], 9, i, d), 7));
                places.insert(s.value(base[i][d], 9, i, d) << 7);
            }
            CHECK(strata.size() == 128);
            CHECK(places.size() == 1);
        }
    }
    const auto one = strategy("sobol", "uniform-jitter", 1), rotation = strategy("sobol", "cranley-patterson", 1);
    CHECK(one.value(0, 5, 0, 2) == rotation.value(0, 5, 0, 2));
    const auto all = strategy("sobol", "uniform-jitter", std::uint64_t{1} << 32);
    CHECK(all.value(0x12345678U, 5, 0, 2) == 0x12345678U);  // strata of 2^-32: nothing left to move
}

TEST_CASE("sampling: interleaved shares points inside a class and rotates them between classes, whatever m divides") {
    for (const std::uint32_t m : {1U, 3U, 8U, 64U, 256U}) {
        const auto s = strategy("halton", "interleaved", 16, [m](auto& p) { p.set("interleave", m); });
        CHECK(s.parameters() == "m=" + std::to_string(m));
        std::set<std::uint32_t> offsets;
        bool same_in_class = true;
        for (std::uint32_t p = 0; p < pixels; ++p) {
            const std::uint32_t representative = (p / width % m) * width + p % width % m;
            same_in_class = same_in_class && s.value(5, p, 3, 2) == s.value(5, representative, 3, 2) &&
                            s.value(5, p, 3, 2) - 5 == s.value(77, p, 9, 2) - 77;
            offsets.insert(s.value(5, p, 3, 2));
        }
        CHECK(same_in_class);
        CHECK(offsets.size() == std::min<std::size_t>(m, width) * std::min<std::size_t>(m, 64));
    }
}

TEST_CASE("sampling: the blue-noise mask holds each rank once and has far less low frequency than random numbers") {
    const BlueNoiseMask mask = make_blue_noise_mask(1);
    CHECK(std::set<std::uint16_t>(mask.begin(), mask.end()).size() == pixels);
    CHECK(make_blue_noise_mask(2) != mask);
    // Variance of means over 8x8 blocks, relative to independent ranks: 1 for white noise.
    double squares = 0;
    for (std::uint32_t by = 0; by < 8; ++by)
        for (std::uint32_t bx = 0; bx < 8; ++bx) {
            double mean = 0;
            for (std::uint32_t i = 0; i < 64; ++i)
                mean += (mask.at((by * 8 + i / 8) * 64 + bx * 8 + i % 8) + 0.5) / 4096 / 64;
            squares += (mean - 0.5) * (mean - 0.5) / 64;
        }
    const double r8 = squares * 64 * 12;
    CHECK(r8 < 0.1);
}

TEST_CASE("sampling: blue-noise offsets are uniform, the same for every sample, and different in each dimension") {
    const auto s = strategy("sobol", "blue-noise", 16, {}, 26);
    for (const std::uint32_t d : {0U, 1U, 25U}) {
        std::vector<int> count(16);
        bool constant = true;
        for (std::uint32_t p = 0; p < pixels; ++p) {
            ++count[s.value(0, p, 0, d) >> 28];
            constant = constant && s.value(0, p, 0, d) == static_cast<std::uint32_t>(s.value(99, p, 7, d) - 99);
        }
        CHECK(constant);
        CHECK(std::all_of(count.begin(), count.end(), [](int n) { return n == 256; }));
    }
    // Two dimensions: 256 cells of the pixels' offset pairs, as if independent.
    for (const auto& [a, b] : {std::pair{0U, 1U}, {0U, 2U}, {3U, 25U}}) {
        std::vector<double> cells(256);
        for (std::uint32_t p = 0; p < pixels; ++p)
            ++cells[(s.value(0, p, 0, a) >> 28) * 16 + (s.value(0, p, 0, b) >> 28)];
        double sum = 0;
        for (const double c : cells) sum += (c - 16) * (c - 16) / 16;
        CHECK(sum < 255 + 6 * 22.6);
    }
}
