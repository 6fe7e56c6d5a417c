#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

Box Scene::bounds() const {
    Box box;
    for (const Vec3 p : positions) box.add(p);
    return box;
}

}  // namespace raycache::tracer
