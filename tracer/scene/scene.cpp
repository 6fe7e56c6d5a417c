#include "tracer/scene/scene.hpp"

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

float Scene::offset_scale_of(const Box& bounds) {
    const float extent = max_component(bounds.upper - bounds.lower);
    constexpr float large = 256;
    constexpr int below_large = 5;  // far fewer ulps than a small scene's: positions grow with it
    if (!(extent > 0) || !std::isfinite(extent) || (extent >= 1 && extent < large)) return 1;
    return std::ldexp(1.0F, std::ilogb(extent) - (extent < 1 ? 0 : below_large));
}

}  // namespace raycache::tracer
