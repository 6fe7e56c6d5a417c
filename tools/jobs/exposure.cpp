#include "tools/jobs/exposure.hpp"

#include <algorithm>
#include <cmath>

namespace raycache::tools {

float automatic_exposure(const tracer::Image& image) {
    constexpr std::uint32_t block = 16;
    constexpr double darkest = 1e-4, middle_grey = 0.18;
    double logs = 0;
    std::uint64_t blocks = 0;
    for (std::uint32_t top = 0; top < image.height; top += block)
        for (std::uint32_t left = 0; left < image.width; left += block) {
            const std::uint32_t bottom = std::min(top + block, image.height),
                                right = std::min(left + block, image.width);
            double sum = 0;
            for (std::uint32_t y = top; y < bottom; ++y)
                for (std::uint32_t x = left; x < right; ++x)
                    sum += double{tracer::luminance(image.pixels[std::size_t{y} * image.width + x])};
            logs += std::log2(std::max(darkest, sum / ((bottom - top) * (right - left))));
            ++blocks;
        }
    return static_cast<float>(std::log2(middle_grey) - logs / static_cast<double>(blocks));
}

}  // namespace raycache::tools
