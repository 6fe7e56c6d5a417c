#include "tracer/sampling/measures/field_error.hpp"

#include <cmath>

namespace raycache::tracer {

FieldError measure_field(std::span<const double> errors, std::uint32_t width) {
    constexpr std::size_t block = 8;
    const auto count = static_cast<double>(errors.size());
    double sum = 0, squares = 0, block_squares = 0;
    for (const double e : errors) {
        sum += e;
        squares += e * e;
    }
    const std::size_t height = errors.size() / width;
    for (std::size_t top = 0; top < height; top += block)
        for (std::size_t left = 0; left < width; left += block) {
            double total = 0;
            for (std::size_t y = top; y < top + block; ++y)
                for (std::size_t x = left; x < left + block; ++x) total += errors[y * width + x];
            block_squares += total * total / (block * block);  // 64 pixels times the mean squared, as R8 wants it
        }
    FieldError result;
    result.mse = squares / count;
    result.z = std::fabs(sum) / std::sqrt(squares);
    result.r8 = block * block * block_squares / squares;
    return result;
}

}  // namespace raycache::tracer
