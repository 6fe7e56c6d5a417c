// Largest hole, hole-free K and union density: hand-computed sets, brute force, and the figures of docs/sampling.md.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/measures/largest_hole.hpp"
#include "tracer/sampling/measures/union_density.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

constexpr std::uint64_t one = std::uint64_t{1} << 32;
using Points = std::vector<FixedPoint2>;

Points plane(const char* name, std::uint32_t n, std::uint32_t a = 0, std::uint32_t b = 1) {
    const auto sequence = make_sequence(name);
    Points points(n);
    for (std::uint32_t i = 0; i < n; ++i) points[i] = {sequence->sample(i, a), sequence->sample(i, b)};
    return points;
}

double k_of(const char* name, std::uint32_t n, std::uint32_t a = 0, std::uint32_t b = 1) {
    return hole_free_k(largest_hole(plane(name, n, a, b)), n, 2);
}

/// Random points on a lattice of 2^bits x 2^bits.
Points lattice_points(std::uint32_t n, unsigned bits, std::uint32_t seed) {
    Points points;
    for (std::uint32_t i = 0; i < n; ++i) {
        const HashWords words = pcg4d({i, seed, 7, 7});
        points.push_back({words[0] >> (32 - bits) << (32 - bits), words[1] >> (32 - bits) << (32 - bits)});
    }
    return points;
}

/// The largest empty open square with corners on the lattice, tried one by one, in lattice units.
unsigned brute_force_hole(const Points& points, unsigned bits) {
    const unsigned size = 1U << bits;
    for (unsigned side = size; side > 1; --side)
        for (unsigned a = 0; a < size; ++a)
            for (unsigned b = 0; b < size; ++b) {
                const auto inside = [&](const FixedPoint2& p) {
                    const unsigned dx = ((p.x >> (32 - bits)) - a) % size, dy = ((p.y >> (32 - bits)) - b) % size;
                    return dx > 0 && dx < side && dy > 0 && dy < side;
                };
                if (std::none_of(points.begin(), points.end(), inside)) return side;
            }
    return 1;
}

/// Integral of density^2 from the overlaps of all pairs of boxes: sum (w - |dx|)(w - |dy|) / (N w^2)^2, w <= 1/2.
double pairwise_mean_square(const Points& points, double w) {
    double sum = 0;
    const auto overlap = [w](std::uint32_t a, std::uint32_t b) {
        return std::max(0.0, w - std::min(a - b, b - a) * 0x1p-32);
    };
    for (const FixedPoint2& p : points)
        for (const FixedPoint2& q : points) sum += overlap(p.x, q.x) * overlap(p.y, q.y);
    const double n = static_cast<double>(points.size());
    return sum / (n * n * w * w * w * w);
}

StrategySettings micro_jitter(const char* sequence, std::uint32_t n, double k) {
    StrategySettings settings{sequence, "micro-jitter", {}, {}};
    settings.samples.spp = n;
    settings.parameters.set("k", k);
    return settings;
}

}  // namespace

TEST_CASE("measures: the largest hole of sets whose hole is known") {
    CHECK(largest_hole(Points{{5, 77}}) == one);  // the whole torus, cut at the point
    CHECK(largest_hole(Points{{0, 0}, {1U << 31, 0}}) == one);
    CHECK(largest_hole(Points{{0, 0}, {1U << 31, 1U << 31}}) == one);  // (0, 1) x (1/2, 3/2): both on its border
    Points grid;
    for (std::uint32_t y = 0; y < 8; ++y)
        for (std::uint32_t x = 0; x < 8; ++x) grid.push_back({(x << 29) + 12345, (y << 29) + 999});
    CHECK(largest_hole(grid) == one / 8);
    CHECK(hole_free_k(one / 8, 64, 2) == 1.0);
    const std::vector<std::uint32_t> line{100, 1U << 30, 3U << 30};
    CHECK(largest_hole(line) == one / 2);
    CHECK(largest_hole(std::vector<std::uint32_t>{4}) == one);
    CHECK_THROWS_AS(largest_hole(Points{}), UsageError);
    CHECK_THROWS_AS(largest_hole(std::vector<std::uint32_t>{}), UsageError);
}

TEST_CASE("measures: the largest hole equals that of all squares tried one by one") {
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        const std::uint32_t n = 1 + seed * 3;
        const Points points = lattice_points(n, 4, seed);
        INFO("points " << n);
        CHECK(largest_hole(points) == std::uint64_t{brute_force_hole(points, 4)} << 28);
    }
}

TEST_CASE("measures: shifting a set on the torus changes no hole") {
    const Points points = plane("halton", 300);
    Points moved = points;
    for (FixedPoint2& p : moved) p = {p.x + 3'000'000'001U, p.y + 1'234'567'890U};
    CHECK(largest_hole(moved) == largest_hole(points));
}

TEST_CASE("measures: the union density has mean 1 and the mean square of all pairs of boxes") {
    for (const double w : {0.03, 0.11, 0.25, 0.5}) {
        const Points points = plane("halton", 200);
        const auto width = static_cast<std::uint64_t>(w * 0x1p32);
        const UnionDensity density = union_density(points, {width / 2, width});
        double area = 0, mean = 0;
        for (const auto& level : density.levels) {
            area += level.area;
            mean += level.area * level.density;
        }
        INFO("width " << w);
        CHECK(area == Approx(1).epsilon(1e-12));
        CHECK(mean == Approx(1).epsilon(1e-12));
        CHECK(density.mean_square == Approx(pairwise_mean_square(points, w)).epsilon(1e-7));
    }
}

TEST_CASE("measures: jitter leaves holes exactly while its window is narrower than the largest hole") {
    for (const char* name : {"halton", "sobol", "r2"}) {
        const Points points = plane(name, 500);
        const std::uint64_t hole = largest_hole(points);
        INFO(name);
        CHECK(union_density(points, {hole / 2, hole}).min > 0);
        const std::uint64_t narrower = hole - hole / 1000;
        CHECK(union_density(points, {narrower / 2, narrower}).min == 0);
        CHECK(union_density(points, {0, narrower}).holes() > 0);
    }
}

TEST_CASE("measures: the density of a window as wide as everything, and of equal cells, is 1") {
    const UnionDensity everywhere = union_density(plane("halton", 10), {0, one});
    CHECK(everywhere.min == 1);
    CHECK(everywhere.mean_square == 1);
    StrategySettings net{"sobol-owen-4d", "net-micro-jitter", {}, {}};
    net.samples.spp = 256;
    net.parameters.set("share", "sets");
    const auto window = jitter_window(net, 2, 0);
    REQUIRE(window);
    CHECK(window->width < one);
    const UnionDensity density = union_density(plane("sobol-owen-4d", 256), *window);
    CHECK(density.min == 1);
    CHECK(density.max == 1);
    CHECK_THROWS_AS(union_density(plane("halton", 10), {0, 0}), UsageError);
}

TEST_CASE("measures: a strategy's window is where its values lie") {
    for (const char* name : {"micro-jitter", "scrambling-distance", "net-micro-jitter", "uniform-jitter", "coherent"}) {
        StrategySettings settings{"sobol", name, {}, {}};
        settings.samples.spp = 64;
        settings.parameters.set("share", "sets");
        const auto window = jitter_window(settings, 4, 1);
        REQUIRE(window);
        const SamplingStrategy strategy(settings, 4);
        bool inside = true;
        std::uint32_t farthest = 0;
        for (std::uint32_t i = 0; i < 64; ++i) {
            const std::uint32_t x = strategy.base_point(i)[1];
            for (std::uint32_t pixel = 0; pixel < 200; ++pixel) {
                const std::uint32_t start = (x & window->leading_bits) - static_cast<std::uint32_t>(window->left);
                const std::uint32_t from_start = strategy.value(x, pixel, i, 1) - start;
                inside = inside && from_start < std::max<std::uint64_t>(window->width, 1);
                farthest = std::max(farthest, from_start);
            }
        }
        INFO(name);
        CHECK(inside);
        CHECK(farthest >= window->width * 0.98 - 1);
    }
    CHECK_FALSE(jitter_window({"sobol", "interleaved", {}, {}}, 4, 1).has_value());
}

TEST_CASE("measures: at the paper's Figure 2 point K is 2.17 and the holes close at 1.955") {
    const Points points = plane("halton", 128);
    CHECK(std::sqrt(128 * star_discrepancy(points)) == Approx(2.17).margin(0.005));
    CHECK(k_of("halton", 128) == Approx(1.955).margin(0.002));
    for (const double k : {0.97, 1.94, 1.97, 2.17}) {
        const auto window = jitter_window(micro_jitter("halton", 128, k), 2, 0);
        REQUIRE(window);
        CHECK((union_density(points, *window).min == 0) == (k < 1.955));
    }
}

TEST_CASE("measures: hole-free K of the first two dimensions lies where docs/sampling.md says") {
    struct Range {
        const char* sequence;
        double least, greatest;
    };
    for (const Range& r : {Range{"sobol", 1.3, 2.5}, Range{"halton", 1.5, 2.4}, Range{"r2", 1.1, 1.7}})
        for (const std::uint32_t n : {16U, 128U, 1024U, 4096U}) {
            const double k = k_of(r.sequence, n);
            INFO(r.sequence << " N " << n << " K " << k);
            CHECK(k >= r.least);
            CHECK(k <= r.greatest);
        }
}

TEST_CASE("measures: one dimension of Sobol with N = 2^m is even at K = 1, and high pairs of Halton need a large K") {
    const auto sobol = make_sequence("sobol");
    std::vector<std::uint32_t> points(1024);
    for (std::uint32_t i = 0; i < 1024; ++i) points[i] = sobol->sample(i, 1);
    CHECK(hole_free_k(largest_hole(points), 1024, 1) == 1);
    CHECK(k_of("halton", 1024, 30, 31) == Approx(12.96).margin(0.005));  // bases 127 and 131
}
