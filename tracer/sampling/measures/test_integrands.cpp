#include "tracer/sampling/measures/test_integrands.hpp"

#include <cmath>
#include <numbers>

namespace raycache::tracer {
namespace {

using Point = std::array<double, test_dimensions>;
constexpr double pi = std::numbers::pi;

/// An edge at an angle through the middle of the square, moved by up to a tenth across the picture.
template <int Degrees>
struct Edge2 {
    static const std::vector<double>& normal() {
        static const std::vector<double> n{std::cos(Degrees * pi / 180), std::sin(Degrees * pi / 180)};
        return n;
    }
    static double offset(double px, double py) {
        const auto& n = normal();
        return 0.5 * (n[0] + n[1]) + 0.1 * (px - 0.5) + 0.05 * (py - 0.5);
    }
    static double value(const Point& u, double px, double py) {
        const auto& n = normal();
        return n[0] * u[0] + n[1] * u[1] < offset(px, py) ? 1 : 0;
    }
    static double mean(double px, double py) { return half_space_volume(normal(), offset(px, py)); }
};

/// Which of three orientations in four dimensions.
template <int Which>
struct Edge4 {
    static const std::vector<double>& normal() {
        static const std::vector<double> of[]{{0.5, 0.5, 0.5, 0.5}, {0.8, -0.3, 0.4, -0.33}, {0.2, 0.75, -0.6, 0.2}};
        return of[Which];
    }
    static double offset(double px, double py) {
        const auto& n = normal();
        return 0.5 * (n[0] + n[1] + n[2] + n[3]) + 0.1 * (px - 0.5) + 0.05 * (py - 0.5);
    }
    static double value(const Point& u, double px, double py) {
        const auto& n = normal();
        return n[0] * u[0] + n[1] * u[1] + n[2] * u[2] + n[3] * u[3] < offset(px, py) ? 1 : 0;
    }
    static double mean(double px, double py) { return half_space_volume(normal(), offset(px, py)); }
};

/// A disc in the square, of a radius in hundredths that grows by a tenth across the picture.
template <int Radius>
struct Disc {
    static double radius(double px, double py) { return Radius / 100.0 * (1 + 0.05 * px + 0.05 * py); }
    static double value(const Point& u, double px, double py) {
        const double r = radius(px, py);
        return (u[0] - 0.5) * (u[0] - 0.5) + (u[1] - 0.5) * (u[1] - 0.5) < r * r ? 1 : 0;
    }
    static double mean(double px, double py) { return pi * radius(px, py) * radius(px, py); }
};

/// Periodic and smooth: the product of 1 + a cos(2 pi (k u + phase)) over the dimensions.
template <unsigned Dimensions>
struct Waves {
    static double value(const Point& u, double px, double py) {
        double product = 1;
        for (unsigned d = 0; d < Dimensions; ++d)
            product *= 1 + 0.5 * std::cos(2 * pi * (u[d] + 0.1 * (d + 1) + 0.1 * px - 0.07 * py));
        return product;
    }
    static double mean(double, double) { return 1; }
};

/// Smooth, not periodic: an exponential in every dimension.
template <unsigned Dimensions>
struct Slope {
    static double rate(unsigned d, double px, double py) { return 1 + 0.3 * d + 0.1 * px + 0.1 * py; }
    static double value(const Point& u, double px, double py) {
        double product = 1;
        for (unsigned d = 0; d < Dimensions; ++d) product *= std::exp(-rate(d, px, py) * u[d]);
        return product;
    }
    static double mean(double px, double py) {
        double product = 1;
        for (unsigned d = 0; d < Dimensions; ++d) product *= (1 - std::exp(-rate(d, px, py))) / rate(d, px, py);
        return product;
    }
};

template <class T>
TestIntegrand make(const char* name, bool edges, unsigned dimensions) {
    return {name, edges, dimensions, T::value, T::mean};
}

}  // namespace

double half_space_volume(std::vector<double> a, double c) {
    double scale = 1;
    for (double& factor : a) {
        if (factor < 0) {  // u -> 1 - u
            c -= factor;
            factor = -factor;
        }
        scale *= factor;
    }
    const auto d = static_cast<unsigned>(a.size());
    double factorial = 1, sum = 0;
    for (unsigned i = 2; i <= d; ++i) factorial *= i;
    for (unsigned subset = 0; subset < 1U << d; ++subset) {
        double left = c, sign = 1;
        for (unsigned i = 0; i < d; ++i) {
            if (((subset >> i) & 1U) == 0) continue;
            left -= a[i];
            sign = -sign;
        }
        if (left > 0) sum += sign * std::pow(left, d);
    }
    return sum / (factorial * scale);
}

const std::vector<TestIntegrand>& test_integrands() {
    static const std::vector<TestIntegrand> all{make<Edge2<9>>("edge 9 degrees", true, 2),
                                                make<Edge2<27>>("edge 27 degrees", true, 2),
                                                make<Edge2<45>>("edge 45 degrees", true, 2),
                                                make<Edge2<118>>("edge 118 degrees", true, 2),
                                                make<Disc<15>>("small disc", true, 2),
                                                make<Disc<40>>("large disc", true, 2),
                                                make<Waves<2>>("waves in 2-D", false, 2),
                                                make<Slope<2>>("slope in 2-D", false, 2),
                                                make<Edge4<0>>("4-D edge, diagonal", true, 4),
                                                make<Edge4<1>>("4-D edge, oblique", true, 4),
                                                make<Edge4<2>>("4-D edge, across pairs", true, 4),
                                                make<Slope<4>>("slope in 4-D", false, 4)};
    return all;
}

}  // namespace raycache::tracer
