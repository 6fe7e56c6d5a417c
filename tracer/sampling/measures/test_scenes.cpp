#include "tracer/sampling/measures/test_scenes.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <numbers>

namespace raycache::tracer {
namespace {

using std::numbers::pi;

/// Moves with the pixel, slowly: from -1/2 to 1/2 across the picture in a direction of its own.
double drift(double angle, double u, double v) { return std::cos(angle) * (u - 0.5) + std::sin(angle) * (v - 0.5); }

/// Share of the unit cube where a.y < c: sum over the corners below the plane, with alternating signs.
double volume_below(std::vector<double> a, double c) {
    std::erase(a, 0.0);
    double scale = 1;
    for (std::size_t j = 0; j < a.size(); ++j) {
        if (a[j] < 0) {  // y -> 1 - y
            c -= a[j];
            a[j] = -a[j];
        }
        scale *= a[j] * static_cast<double>(j + 1);
    }
    double sum = 0;
    for (unsigned corner = 0; corner < 1U << a.size(); ++corner) {
        double rest = c, sign = 1;
        for (std::size_t j = 0; j < a.size(); ++j)
            if (corner >> j & 1U) {
                rest -= a[j];
                sign = -sign;
            }
        if (rest > 0) sum += sign * std::pow(rest, static_cast<double>(a.size()));
    }
    return std::min(1.0, std::max(0.0, sum / scale));
}

template <std::size_t dimensions>
class Edge final : public TestScene {
public:
    /// The plane passes the cube's centre in the middle of the picture.
    Edge(std::string name, const std::array<double, dimensions>& normal, double direction)
        : TestScene(std::move(name)), normal_(normal), direction_(direction) {
        for (const double a : normal) {
            middle_ += a / 2;
            swing_ += std::fabs(a) * 0.05;
        }
    }
    double value(const double* y, double u, double v) const override {
        double sum = 0;
        for (std::size_t j = 0; j < dimensions; ++j) sum += normal_[j] * y[j];
        return sum < offset(u, v) ? 1 : 0;
    }
    double integral(double u, double v) const override {
        return volume_below(std::vector<double>(normal_.begin(), normal_.end()), offset(u, v));
    }

private:
    double offset(double u, double v) const {
        // The step off the centre keeps points at the centre, such as Sobol's second, off the edge.
        return middle_ + swing_ * (drift(direction_, u, v) + 0.3);
    }
    std::array<double, dimensions> normal_;
    double direction_, middle_ = 0, swing_ = 0;
};

class Disc final : public TestScene {
public:
    Disc(std::string name, double radius) : TestScene(std::move(name)), radius_(radius) {}
    double value(const double* y, double u, double v) const override {
        const double dx = y[0] - 0.47 - 0.1 * (u - 0.5), dy = y[1] - 0.52 - 0.1 * (v - 0.5);
        return dx * dx + dy * dy < radius_ * radius_ ? 1 : 0;
    }
    double integral(double, double) const override { return pi * radius_ * radius_; }

private:
    double radius_;
};

class Corner final : public TestScene {
public:
    Corner() : TestScene("corner") {}
    double value(const double* y, double u, double v) const override {
        return y[0] < width(u) && y[1] < height(v) ? 1 : 0;
    }
    double integral(double u, double v) const override { return width(u) * height(v); }

private:
    static double width(double u) { return 0.57 + 0.05 * u; }
    static double height(double v) { return 0.38 + 0.05 * v; }
};

class Periodic final : public TestScene {
public:
    Periodic() : TestScene("periodic") {}
    double value(const double* y, double u, double) const override {
        return std::exp(std::sin(2 * pi * (y[0] + 2 * y[1] + u)));
    }
    double integral(double, double) const override { return std::cyl_bessel_i(0.0, 1.0); }
};

class Lobe final : public TestScene {
public:
    Lobe() : TestScene("lobe") {}
    double value(const double* y, double u, double v) const override {
        const double dx = y[0] - centre(u), dy = y[1] - centre(v);
        return std::exp(-(dx * dx + dy * dy) / (2 * width * width));
    }
    double integral(double u, double v) const override { return along(centre(u)) * along(centre(v)); }

private:
    static constexpr double width = 0.15;
    static double centre(double u) { return 0.4 + 0.2 * u; }
    static double along(double centre) {
        const double scale = 1 / (width * std::numbers::sqrt2);
        return width * std::sqrt(pi / 2) * (std::erf((1 - centre) * scale) + std::erf(centre * scale));
    }
};

class Ramp final : public TestScene {
public:
    Ramp() : TestScene("ramp") {}
    double value(const double* y, double u, double v) const override { return (y[0] + u) * (y[1] + v) * (y[1] + v); }
    double integral(double u, double v) const override { return (0.5 + u) * (1.0 / 3 + v + v * v); }
};

TestScenes make_scenes_2d() {
    TestScenes scenes;
    for (const int degrees : {0, 9, 27, 45, 71, 90}) {
        const double angle = degrees * pi / 180;
        const std::array<double, 2> normal{degrees == 90 ? 0 : std::cos(angle), degrees == 0 ? 0 : std::sin(angle)};
        scenes.push_back(std::make_unique<Edge<2>>(fmt::format("edge {}", degrees), normal, angle + 0.4));
    }
    scenes.push_back(std::make_unique<Disc>("disc", 0.31));
    scenes.push_back(std::make_unique<Disc>("small disc", 0.12));
    scenes.push_back(std::make_unique<Corner>());
    scenes.push_back(std::make_unique<Periodic>());
    scenes.push_back(std::make_unique<Lobe>());
    scenes.push_back(std::make_unique<Ramp>());
    return scenes;
}

TestScenes make_edges_4d() {
    constexpr std::array<std::array<double, 4>, 12> normals{{{1, 0.8, 0.6, 0.4},
                                                             {0.3, 1, -0.7, 0.5},
                                                             {-0.6, 0.4, 1, 0.9},
                                                             {1, -1, 0.5, -0.4},
                                                             {0.5, 0.6, 0.7, -1},
                                                             {0.9, 0.35, -0.45, 1},
                                                             {-0.4, 1, 0.3, 0.8},
                                                             {1, 0.5, -0.9, -0.6},
                                                             {0.7, -0.9, 1, 0.3},
                                                             {0.6, 0.7, 0.8, 1},
                                                             {-1, 0.3, 0.4, 0.7},
                                                             {0.8, 1, 0.95, -0.5}}};
    TestScenes scenes;
    for (std::size_t i = 0; i < normals.size(); ++i)
        scenes.push_back(
            std::make_unique<Edge<4>>(fmt::format("edge {}", i), normals.at(i), 0.5 * static_cast<double>(i)));
    return scenes;
}

}  // namespace

const TestScenes& scenes_2d() {
    static const TestScenes scenes = make_scenes_2d();
    return scenes;
}

const TestScenes& edges_4d() {
    static const TestScenes scenes = make_edges_4d();
    return scenes;
}

namespace {
StrategySettings on_test_picture(StrategySettings settings) {
    settings.samples.width = test_picture_width;
    return settings;
}
}  // namespace

StrategyPoints::StrategyPoints(StrategySettings settings, std::uint32_t dimensions)
    : strategy_(on_test_picture(std::move(settings)), dimensions) {
    for (std::uint64_t i = 0; i < strategy_.settings().samples.spp; ++i) {
        const std::vector<std::uint32_t> point = strategy_.base_point(i);
        base_.insert(base_.end(), point.begin(), point.end());
    }
}

void StrategyPoints::fill(std::uint32_t pixel, std::span<double> points) const {
    const std::uint32_t dimensions = strategy_.dimensions();
    for (std::uint32_t i = 0, at = 0; at < base_.size(); ++i)
        for (std::uint32_t d = 0; d < dimensions; ++d, ++at)
            points[at] = strategy_.value(base_[at], pixel, i, d) * 0x1p-32;
}

std::vector<FieldError> measure_scenes(const TestScenes& scenes, std::uint32_t dimensions, std::uint32_t n,
                                       const PixelPoints& source) {
    std::vector<std::vector<double>> errors(scenes.size(), std::vector<double>(test_picture_pixels));
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, test_picture_pixels, 64), [&](const auto& range) {
        std::vector<double> points(std::size_t{n} * dimensions);
        for (std::uint32_t pixel = range.begin(); pixel < range.end(); ++pixel) {
            source.fill(pixel, points);
            const std::uint32_t column = pixel % test_picture_width, row = pixel / test_picture_width;
            const double u = (column + 0.5) / test_picture_width, v = (row + 0.5) / test_picture_width;
            for (std::size_t s = 0; s < scenes.size(); ++s) {
                double sum = 0;
                for (std::size_t at = 0; at < points.size(); at += dimensions)
                    sum += scenes[s]->value(&points[at], u, v);
                errors[s][pixel] = sum / n - scenes[s]->integral(u, v);
            }
        }
    });
    std::vector<FieldError> results;
    for (const auto& field : errors) results.push_back(measure_field(field, test_picture_width));
    return results;
}

FieldError summarise(std::span<const FieldError> scenes) {
    constexpr double rounding = 1e-26;  // of a squared error
    FieldError mean;
    double counted = 0;
    for (const FieldError& scene : scenes) {
        mean.mse += scene.mse / static_cast<double>(scenes.size());
        if (!(scene.mse > rounding)) continue;
        counted += 1;
        mean.z += scene.z * scene.z;
        mean.r8 += scene.r8;
    }
    mean.z = std::sqrt(mean.z / counted);
    mean.r8 /= counted;
    return mean;
}

}  // namespace raycache::tracer
