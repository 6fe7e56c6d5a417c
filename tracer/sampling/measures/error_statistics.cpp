#include "tracer/sampling/measures/error_statistics.hpp"

#include <cmath>

namespace raycache::tracer {

namespace {

constexpr std::uint32_t block = 8;

double unit(std::uint32_t u) { return static_cast<double>(u) * 0x1p-32; }

}  // namespace

ErrorStatistics error_statistics(std::span<const double> errors, std::uint32_t side) {
    ErrorStatistics s;
    const auto n = static_cast<double>(errors.size());
    for (const double e : errors) {
        s.mean += e / n;
        s.mse += e * e / n;
    }
    double squares = 0;
    for (const double e : errors) squares += (e - s.mean) * (e - s.mean);
    s.standard_error = std::sqrt(squares / (n - 1) / n);

    double blocks = 0;
    for (std::uint32_t y = 0; y < side; y += block) {
        for (std::uint32_t x = 0; x < side; x += block) {
            double sum = 0;
            for (std::uint32_t j = 0; j < block; ++j)
                for (std::uint32_t i = 0; i < block; ++i) sum += errors[std::size_t{y + j} * side + x + i];
            const double mean = sum / (block * block);
            blocks += mean * mean;
        }
    }
    const double block_mse = blocks / (n / (block * block));
    if (s.mse > 0) s.r8 = block * block * block_mse / s.mse;
    return s;
}

std::vector<double> errors_of(const SamplingStrategy& strategy, const TestIntegrand& integrand) {
    constexpr std::uint32_t side = test_picture_side;
    const std::uint64_t n = strategy.settings().parameters.spp;
    std::vector<double> errors(std::size_t{side} * side);
    for (std::uint64_t i = 0; i < n; ++i) {
        const std::vector<std::uint32_t> base = strategy.base_point(i);
        for (std::uint32_t pixel = 0; pixel < errors.size(); ++pixel) {
            std::array<double, test_dimensions> u{};
            for (unsigned d = 0; d < integrand.dimensions; ++d)
                u[d] = unit(strategy.value(base[d], pixel, static_cast<std::uint32_t>(i), d));
            errors[pixel] += integrand.value(u, (pixel % side + 0.5) / side, (pixel / side + 0.5) / side);
        }
    }
    for (std::uint32_t pixel = 0; pixel < errors.size(); ++pixel)
        errors[pixel] = errors[pixel] / static_cast<double>(n) -
                        integrand.mean((pixel % side + 0.5) / side, (pixel / side + 0.5) / side);
    return errors;
}

}  // namespace raycache::tracer
