// The test scenes' integrals, the measures of an error field, and what the tables of docs/sampling.md say.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/measures/jitter_variants.hpp"
#include "tracer/sampling/measures/test_scenes.hpp"

using namespace raycache::tracer;

namespace {

FieldError measure(const char* sequence, const char* decorrelation, std::uint32_t dimensions, std::uint32_t n,
                   double k = 2.5, unsigned s = 2) {
    StrategySettings settings{sequence, decorrelation, {}, {}};
    settings.samples.spp = n;
    settings.samples.seed = 1;
    settings.parameters.set("k", k);
    settings.parameters.set("s", s);
    settings.parameters.set("share", "sets");
    return summarise(measure_scenes(dimensions == 2 ? scenes_2d() : edges_4d(), dimensions, n,
                                    StrategyPoints(settings, dimensions)));
}

}  // namespace

TEST_CASE("measures: white noise has z and R8 about 1, a constant error the greatest values, an alternating one none") {
    std::vector<double> noise(4096), constant(4096, 0.3), alternating(4096);
    double z_square = 0, r8 = 0;
    for (std::uint32_t repetition = 0; repetition < 50; ++repetition) {
        for (std::uint32_t p = 0; p < 4096; ++p) noise[p] = pcg4d({p, repetition, 1, 2})[0] * 0x1p-32 - 0.5;
        const FieldError e = measure_field(noise, 64);
        z_square += e.z * e.z / 50;
        r8 += e.r8 / 50;
        CHECK(e.mse == Approx(1.0 / 12).epsilon(0.1));
    }
    CHECK(std::sqrt(z_square) == Approx(1).margin(0.3));
    CHECK(r8 == Approx(1).margin(0.1));
    const FieldError shared = measure_field(constant, 64);
    CHECK(shared.mse == Approx(0.09));
    CHECK(shared.z == Approx(64));
    CHECK(shared.r8 == Approx(64));
    CHECK(shared.structured() == Approx(1));
    for (std::uint32_t p = 0; p < 4096; ++p) alternating[p] = (p % 64 + p / 64) % 2 ? 1 : -1;
    CHECK(measure_field(alternating, 64).r8 == Approx(0).margin(1e-12));
}

TEST_CASE("measures: every test scene's integral equals a fine quadrature") {
    constexpr std::array<double, 2> places{0.1328125, 0.8203125};
    constexpr std::uint32_t side = 600;
    for (const auto& scene : scenes_2d())
        for (const double u : places) {
            double sum = 0;
            for (std::uint32_t i = 0; i < side; ++i)
                for (std::uint32_t j = 0; j < side; ++j) {
                    const double y[2]{(i + 0.5) / side, (j + 0.5) / side};
                    sum += scene->value(y, u, 1 - u);
                }
            INFO(scene->name() << " u " << u);
            CHECK(sum / (side * side) == Approx(scene->integral(u, 1 - u)).margin(1.5e-3));
        }
    StrategySettings settings{"sobol-owen-4d", "coherent", {}, {}};
    settings.samples.spp = 1U << 18;
    const SamplingStrategy points(settings, 4);
    std::vector<double> sums(edges_4d().size());
    for (std::uint32_t i = 0; i < 1U << 18; ++i) {
        const auto base = points.base_point(i);
        const double y[4]{base[0] * 0x1p-32, base[1] * 0x1p-32, base[2] * 0x1p-32, base[3] * 0x1p-32};
        for (std::size_t s = 0; s < sums.size(); ++s) sums[s] += edges_4d()[s]->value(y, 0.3, 0.9) * 0x1p-18;
    }
    for (std::size_t s = 0; s < sums.size(); ++s) {
        INFO(edges_4d()[s]->name());
        CHECK(sums[s] == Approx(edges_4d()[s]->integral(0.3, 0.9)).margin(4e-4));
    }
}

TEST_CASE("measures: Cranley-Patterson, owen, random and net-micro-jitter pass the bias test, micro-jitter does not") {
    for (const std::uint32_t n : {16U, 64U}) {
        INFO("N " << n);
        CHECK(measure("random", "random", 2, n).z <= 1.4);
        CHECK(measure("sobol", "cranley-patterson", 2, n).z <= 1.4);
        CHECK(measure("sobol", "owen", 2, n).z <= 1.4);
        CHECK(measure("sobol-owen-4d", "net-micro-jitter", 2, n).z <= 1.4);
    }
    CHECK(measure("sobol", "micro-jitter", 2, 16, 1).z > 5);
    CHECK(measure("sobol", "micro-jitter", 2, 64, 1).z > 4);
    CHECK(measure("sobol", "micro-jitter", 2, 64, 1).z > measure("sobol", "micro-jitter", 2, 64, 4).z);
}

TEST_CASE("measures: net-micro-jitter passes the bias test with every sequence that has nets in four dimensions",
          "[slow]") {
    for (const char* sequence : {"sobol", "sobol-owen-4d"})
        for (const std::uint32_t dimensions : {2U, 4U})
            for (const std::uint32_t n : {16U, 64U, 256U}) {
                INFO(sequence << ", " << dimensions << " dimensions, N " << n);
                CHECK(measure(sequence, "net-micro-jitter", dimensions, n).z <= 1.4);
            }
}

TEST_CASE("measures: micro-jitter's mean over pixels is the integral over its union density") {
    // f = 1 where x < a and y < b: the integral of f * density is the mean over points of the share of their boxes in
    // that rectangle, wrapped.
    constexpr std::uint32_t n = 16, pixels = 200'000;
    constexpr double a = 0.62, b = 0.68;
    StrategySettings settings{"sobol", "micro-jitter", {}, {}};
    settings.samples.spp = n;
    settings.parameters.set("k", 1);
    const double mu = *make_decorrelation("micro-jitter", settings.parameters, settings.samples)->mu();
    const SamplingStrategy strategy(settings, 2);
    const auto inside = [mu](double x, double limit) {
        double length = 0;
        for (const double shift : {-1.0, 0.0, 1.0})
            length += std::max(0.0, std::min(x + mu / 2, limit + shift) - std::max(x - mu / 2, shift));
        return length / mu;
    };
    double predicted = 0, mean = 0, squares = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto base = strategy.base_point(i);
        predicted += inside(base[0] * 0x1p-32, a) * inside(base[1] * 0x1p-32, b) / n;
    }
    std::vector<std::vector<std::uint32_t>> base;
    for (std::uint32_t i = 0; i < n; ++i) base.push_back(strategy.base_point(i));
    for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
        double estimate = 0;
        for (std::uint32_t i = 0; i < n; ++i)
            estimate += strategy.value(base[i][0], pixel, i, 0) * 0x1p-32 < a &&
                                strategy.value(base[i][1], pixel, i, 1) * 0x1p-32 < b
                            ? 1.0 / n
                            : 0.0;
        mean += estimate / pixels;
        squares += estimate * estimate / pixels;
    }
    const double deviation = std::sqrt((squares - mean * mean) / pixels);
    CHECK(std::fabs(mean - predicted) < 4 * deviation);
    CHECK(std::fabs(predicted - a * b) > 10 * deviation);  // there is a bias to be predicted
}

TEST_CASE("measures: neighbours share the error of jitter for s = 2 more than that of jitter for all dimensions",
          "[slow]") {
    const double pairs = measure("sobol", "micro-jitter", 4, 256, 1, 2).structured(),
                 full = measure("sobol", "micro-jitter", 4, 256, 1, 4).structured();
    CHECK(pairs > full + 0.2);
    CHECK(std::fabs(measure("sobol", "cranley-patterson", 4, 256).structured()) < 0.02);
    CHECK(measure("sobol", "coherent", 4, 256).structured() > 0.6);
    CHECK(measure("sobol-owen-4d", "net-micro-jitter", 4, 256).r8 < 1.5);
    CHECK(measure("sobol-owen-4d", "net-micro-jitter", 4, 256).z <= 1.4);
}

TEST_CASE("measures: clamping and reflecting at the border, and a new xi for every sample, cost error") {
    const auto sequence = make_sequence("sobol");
    const auto mse = [&](JitterVariant variant) {
        return summarise(measure_scenes(scenes_2d(), 2, 256, JitterVariantPoints(variant, *sequence, 2, 256, 0.125, 1)))
            .mse;
    };
    const double wrap = mse(JitterVariant::wrap);
    CHECK(mse(JitterVariant::clamp) > 2 * wrap);
    CHECK(mse(JitterVariant::reflect) > 1.2 * wrap);
    CHECK(mse(JitterVariant::per_sample) > 2 * wrap);
    // The variant "wrap" is the strategy itself.
    StrategySettings settings{"sobol", "micro-jitter", {}, {}};
    settings.samples.spp = 256;
    settings.samples.seed = 1;
    settings.parameters.set("mu", 0.125);
    std::vector<double> a(512), b(512);
    StrategyPoints(settings, 2).fill(77, a);
    JitterVariantPoints(JitterVariant::wrap, *sequence, 2, 256, 0.125, 1).fill(77, b);
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::fabs(a[i] - b[i]));
    CHECK(largest < 0x1p-31);
}
