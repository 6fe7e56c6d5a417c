#include "tracer/scene/scene.hpp"

#include <algorithm>
#include <cmath>

#include "traces/printable.hpp"

namespace raycache::tracer {

void Scene::charge(std::uint64_t bytes, const char* what) const {
    if (memory) memory->charge(bytes, printable_line(name), what);
}

Box Scene::bounds() const {
    Box box;
    for (const Vec3 p : positions) box.add(p);
    return box;
}

float Scene::find_giant_above() const {
    constexpr std::size_t most_samples = 65536;
    constexpr float many_times = 16384;  // with the distance that Surface keeps: a 32nd of the median
    const std::size_t stride = std::max<std::size_t>(1, triangle_count() / most_samples);
    std::vector<float> widths;
    for (std::size_t t = 0; t < triangle_count(); t += stride) {
        Box box;
        for (std::size_t k = 0; k < 3; ++k) box.add(positions[indices[3 * t + k]]);
        if (const float width = max_component(box.upper - box.lower); width > 0) widths.push_back(width);
    }
    if (widths.empty()) return std::numeric_limits<float>::infinity();
    const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::nth_element(widths.begin(), middle, widths.end());
    return *middle * many_times;
}

}  // namespace raycache::tracer
